/* Vectors, quaternions and affine matrices in double precision, as glTF means them. */
#ifndef BAKE_MATHS_HPP
#define BAKE_MATHS_HPP

#include <cmath>

namespace bake
{

struct Vec2 {
    double x = 0, y = 0;
};

struct Vec3 {
    double x = 0, y = 0, z = 0;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double k, Vec3 a) { return {k * a.x, k * a.y, k * a.z}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 cross(Vec3 a, Vec3 b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct Quat {
    double x = 0, y = 0, z = 0, w = 1;
};

inline double dot(Quat a, Quat b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
inline Quat scaled(Quat q, double k) { return {k * q.x, k * q.y, k * q.z, k * q.w}; }
inline Quat normalised(Quat q) { return scaled(q, 1 / std::sqrt(dot(q, q))); }

/* Three rows of a 4 x 4 matrix whose last row is 0 0 0 1; transforms column vectors. */
struct Mat34 {
    double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
};

inline Vec3 transform(const Mat34 &a, Vec3 p)
{
    return {a.m[0][0] * p.x + a.m[0][1] * p.y + a.m[0][2] * p.z + a.m[0][3],
            a.m[1][0] * p.x + a.m[1][1] * p.y + a.m[1][2] * p.z + a.m[1][3],
            a.m[2][0] * p.x + a.m[2][1] * p.y + a.m[2][2] * p.z + a.m[2][3]};
}

inline Mat34 operator*(const Mat34 &a, const Mat34 &b)
{
    Mat34 c;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++) {
            c.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
        }
        c.m[i][3] += a.m[i][3];
    }
    return c;
}

inline Vec3 column(const Mat34 &a, int j) { return {a.m[0][j], a.m[1][j], a.m[2][j]}; }

inline double determinant(const Mat34 &a) { return dot(column(a, 0), cross(column(a, 1), column(a, 2))); }

/* translation * rotation * scale; r has length 1. */
inline Mat34 compose(Vec3 t, Quat r, Vec3 s)
{
    double xx = r.x * r.x, yy = r.y * r.y, zz = r.z * r.z;
    double xy = r.x * r.y, xz = r.x * r.z, yz = r.y * r.z;
    double wx = r.w * r.x, wy = r.w * r.y, wz = r.w * r.z;
    Mat34 a;
    a.m[0][0] = s.x * (1 - 2 * (yy + zz)), a.m[0][1] = s.y * 2 * (xy - wz), a.m[0][2] = s.z * 2 * (xz + wy);
    a.m[1][0] = s.x * 2 * (xy + wz), a.m[1][1] = s.y * (1 - 2 * (xx + zz)), a.m[1][2] = s.z * 2 * (yz - wx);
    a.m[2][0] = s.x * 2 * (xz - wy), a.m[2][1] = s.y * 2 * (yz + wx), a.m[2][2] = s.z * (1 - 2 * (xx + yy));
    a.m[0][3] = t.x, a.m[1][3] = t.y, a.m[2][3] = t.z;
    return a;
}

} // namespace bake

#endif
