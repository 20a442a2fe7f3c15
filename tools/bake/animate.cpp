/* Animation curves, sampled at a uniform interval and rounded to keys. */
#include <algorithm>

#include "bake.hpp"

namespace bake
{

namespace
{

constexpr double degrees = 57.29577951308232;

Vec3 vec3_at(const std::vector<double> &values, size_t group)
{
    return {values[3 * group], values[3 * group + 1], values[3 * group + 2]};
}

Quat quat_at(const std::vector<double> &values, size_t group)
{
    return {values[4 * group], values[4 * group + 1], values[4 * group + 2], values[4 * group + 3]};
}

Vec3 mix(Vec3 a, double ka, Vec3 b, double kb) { return ka * a + kb * b; }
Quat mix(Quat a, double ka, Quat b, double kb)
{
    return {ka * a.x + kb * b.x, ka * a.y + kb * b.y, ka * a.z + kb * b.z, ka * a.w + kb * b.w};
}

/* Shortest path: of b and -b the one nearer to a. Where the angle is so small that its
 * sine is lost in rounding, the straight line is as good as the arc. */
Quat slerp(Quat a, Quat b, double s)
{
    double c = dot(a, b);
    if (c < 0) b = scaled(b, -1), c = -c;
    if (c > 1 - 1e-9) return normalised(mix(a, 1 - s, b, s));
    double angle = std::acos(c);
    return mix(a, std::sin((1 - s) * angle) / std::sin(angle), b, std::sin(s * angle) / std::sin(angle));
}

Vec3 linear(Vec3 a, Vec3 b, double s) { return mix(a, 1 - s, b, s); }
Quat linear(Quat a, Quat b, double s) { return slerp(a, b, s); }

Vec3 finish(Vec3 a, Vec3) { return a; }
Quat finish(Quat a, Quat dflt) { return dot(a, a) > 1e-12 ? normalised(a) : dflt; }

/* The curve at `seconds`; `get` fetches group number n of its values. */
template <class Get> auto evaluate(const Channel &channel, double seconds, Get get)
{
    const std::vector<double> &times = channel.times;
    bool cubic = channel.interpolation == Interpolation::cubic;
    auto value = [&](size_t key) { return get(channel.values, cubic ? 3 * key + 1 : key); };
    /* The last key that is not later; of equal times the last one counts. */
    size_t next = static_cast<size_t>(std::upper_bound(times.begin(), times.end(), seconds) - times.begin());
    if (next == 0) return value(0);
    if (next == times.size() || channel.interpolation == Interpolation::step) return value(next - 1);
    double span = times[next] - times[next - 1], s = (seconds - times[next - 1]) / span;
    if (!cubic) return linear(value(next - 1), value(next), s);
    /* Hermite: glTF 2.0, appendix C. */
    auto leave = get(channel.values, 3 * (next - 1) + 2), arrive = get(channel.values, 3 * next);
    double ss = s * s, sss = ss * s;
    auto points = mix(value(next - 1), 2 * sss - 3 * ss + 1, value(next), 3 * ss - 2 * sss);
    auto slopes = mix(leave, span * (sss - 2 * ss + s), arrive, span * (sss - ss));
    return finish(mix(points, 1, slopes, 1), value(next - 1));
}

/* Common exponent that brings the largest of all values into [2^29, 2^30]. */
int16_t common_exponent(double largest, const std::string &what)
{
    return make_row({largest, 0, 0, 0}, what).e;
}

void round_block(Vec3 value, int e, int32_t out[3])
{
    double unit = std::ldexp(1.0, 30 - e), limit = 1 << 30;
    out[0] = round_within(value.x * unit, -limit, limit);
    out[1] = round_within(value.y * unit, -limit, limit);
    out[2] = round_within(value.z * unit, -limit, limit);
}

Quat rotation_of(const BakedKey &key)
{
    return {key.rotation[0] / 16384.0, key.rotation[1] / 16384.0, key.rotation[2] / 16384.0,
            key.rotation[3] / 16384.0};
}

BakedKey round_key(const Pose &pose, const BakedTrack &track, const BakedKey *before)
{
    BakedKey key;
    round_block(pose.translation, track.translation_e, key.translation);
    round_block(pose.scale, track.scale_e, key.scale);
    Quat q = pose.rotation;
    if (before ? dot(q, rotation_of(*before)) < 0 : q.w < 0) q = scaled(q, -1);
    double parts[4] = {q.x, q.y, q.z, q.w};
    for (int i = 0; i < 4; i++)
        key.rotation[i] = static_cast<int16_t>(round_within(parts[i] * 16384, -16384, 16384));
    return key;
}

double largest_part(Vec3 a) { return std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)}); }

/* What a player makes of two keys. */
Pose between(const BakedKey &a, const BakedKey &b, const BakedTrack &track, double s)
{
    auto block = [](const int32_t m[3], int e) {
        double unit = std::ldexp(1.0, e - 30);
        return Vec3{m[0] * unit, m[1] * unit, m[2] * unit};
    };
    return {
        mix(block(a.translation, track.translation_e), 1 - s, block(b.translation, track.translation_e), s),
        slerp(normalised(rotation_of(a)), normalised(rotation_of(b)), s),
        mix(block(a.scale, track.scale_e), 1 - s, block(b.scale, track.scale_e), s)};
}

/* Holds the keys against the curve at the quarters of every interval. */
void measure(Summary &summary, const Motion &motion, const BakedTrack &track, const BakedKey *keys,
             double seconds, int interval)
{
    for (int i = 0; i + 1 < track.key_count; i++) {
        for (int quarter = 0; quarter < 4; quarter++) {
            double s = quarter / 4.0, time = (i + s) * interval / 1000;
            if (time > seconds) return;
            Pose exact = motion.at(time), drawn = between(keys[i], keys[i + 1], track, s);
            auto raise = [](double &worst, double error) { worst = std::max(worst, error); };
            raise(summary.translation_error, length(exact.translation - drawn.translation));
            raise(summary.scale_error, largest_part(exact.scale - drawn.scale));
            /* Angle by the chord, which stays exact where the cosine does not. */
            Quat to = dot(exact.rotation, drawn.rotation) < 0 ? scaled(drawn.rotation, -1) : drawn.rotation;
            Quat chord = mix(exact.rotation, 1, to, -1);
            raise(summary.rotation_error,
                  4 * std::asin(std::min(1.0, std::sqrt(dot(chord, chord)) / 2)) * degrees);
        }
    }
}

} // namespace

bool BakedKey::operator==(const BakedKey &o) const
{
    return std::equal(translation, translation + 3, o.translation) &&
           std::equal(rotation, rotation + 4, o.rotation) && std::equal(scale, scale + 3, o.scale);
}

double Motion::seconds() const
{
    double last = 0;
    for (const Channel *channel : channels_) last = std::max(last, channel->times.back());
    return last;
}

Pose Motion::at(double seconds) const
{
    Pose pose = rest_;
    for (const Channel *channel : channels_) {
        if (channel->path == Path::translation) pose.translation = evaluate(*channel, seconds, vec3_at);
        else if (channel->path == Path::scale) pose.scale = evaluate(*channel, seconds, vec3_at);
        else pose.rotation = evaluate(*channel, seconds, quat_at);
    }
    return pose;
}

int bake_track(Baked &baked, const Motion &motion, double seconds, const std::string &what)
{
    double intervals = std::ceil(seconds * 1000 / baked.key_interval - 1e-4);
    if (intervals > 65534) {
        throw Error(what, "its animation of " + std::to_string(seconds) +
                              " s needs more than 65535 keys, try a longer "
                              "--key-interval");
    }
    std::vector<Pose> poses;
    double largest_translation = 0, largest_scale = 0;
    for (int i = 0; i <= intervals; i++) {
        poses.push_back(motion.at(std::min(seconds, i * baked.key_interval / 1000.0)));
        largest_translation = std::max(largest_translation, largest_part(poses.back().translation));
        largest_scale = std::max(largest_scale, largest_part(poses.back().scale));
    }
    BakedTrack track;
    track.first_key = static_cast<uint32_t>(baked.keys.size());
    track.key_count = static_cast<uint16_t>(poses.size());
    track.translation_e = common_exponent(largest_translation, what);
    track.scale_e = common_exponent(largest_scale, what);
    std::vector<BakedKey> keys;
    for (const Pose &pose : poses)
        keys.push_back(round_key(pose, track, keys.empty() ? nullptr : &keys.back()));
    if (std::all_of(keys.begin(), keys.end(), [&](const BakedKey &key) { return key == keys[0]; })) return -1;
    measure(baked.summary, motion, track, keys.data(), seconds, baked.key_interval);
    baked.keys.insert(baked.keys.end(), keys.begin(), keys.end());
    baked.tracks.push_back(track);
    return static_cast<int>(baked.tracks.size()) - 1;
}

} // namespace bake
