#!/usr/bin/env python3
"""The stability atlas: runs the walks, writes stability.csv and maps.csv, draws a chart for each axis and
a heat map for each pair, and holds the measured limits against the predicted ones.

usage: atlas.py --out DIR PROGRAM ...     (the first walks all axes, the others the table's)

A limit is measured as the last step that was ok before the first that was not; it has to lie
within a factor of 1.5 of the predicted one. Exit status 3 when one does not.
"""
import argparse
import concurrent.futures
import csv
import math
import os
import subprocess
import sys

COLUMNS = "axis method x err_px err_lsb wrong_px predicted_limit state".split()
MAP_COLUMNS = "map x y value limit_y".split()
FACTOR = 1.5
# Heat maps: what x, y and the colour are, the value where the predicted line should lie, the scale's ends
MAPS = {
    "depth_ratio_and_run_length": ("length of an affine run, px", "farthest over nearest z, less 1", "displacement, px", 0.25, (1e-3, 100)),
    "recip_bits_and_uv_range": ("entries of the reciprocal table, 2^bits", "texels from side to side", "error of u or v, texels, table rung",
                                1 / 64, (1e-4, 10)),
    "distance_and_separation": ("distance of a wall / near", "distance to the wall before it / near", "pixels lost to it, %", 1, (0.1, 100)),
    "slerp_angle_and_key_bits": ("angle between two keys, rad", "fraction bits of a key", "error as a part of the angle", 1, (1e-6, 1e3)),
    "slerp_half_turn_and_key_bits": ("what the angle lacks to half a turn, rad", "fraction bits of a key", "displacement at 160 px, px", None,
                                     (1e-7, 100)),
}
COLOURS = ["#1b6ca8", "#7b3fa0", "#2a9d4a", "#d98a00", "#c8102e", "#0a9396", "#8d6e63", "#5c6bc0"]


class Failed(Exception):
    pass


def walk(programs):
    """Rows of stability.csv and of maps.csv."""
    jobs = [(programs[0], [], COLUMNS), (programs[0], ["--only", "maps"], MAP_COLUMNS)]
    jobs += [(program, ["--only", "recip"], COLUMNS) for program in programs[1:]]
    jobs += [(program, ["--only", "recip-map"], MAP_COLUMNS) for program in programs]

    def run(program, options, columns):
        done = subprocess.run([program, *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            raise Failed(f"{program} {' '.join(options)}: status {done.returncode}: {done.stderr.strip()[-400:]}")
        lines = done.stdout.splitlines()
        return columns, list(csv.DictReader(lines if options else lines[1:], columns))

    found = {id(COLUMNS): [], id(MAP_COLUMNS): []}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for i, job in enumerate([pool.submit(run, *job) for job in jobs]):
            columns, rows = job.result()
            found[id(columns)] += rows
            if sys.stderr.isatty():
                print(f"\r\033[K[{i + 1}/{len(jobs)}] walks", end="", file=sys.stderr, flush=True)
    if sys.stderr.isatty():
        print(file=sys.stderr)
    return found[id(COLUMNS)], found[id(MAP_COLUMNS)]


def groups(rows):
    found = {}
    for row in rows:
        found.setdefault((row["axis"], row["method"]), []).append(row)
    return found


def limits(rows):
    """[axis, method, predicted, measured, verdict]; measured is None where no step fails, or none is ok."""
    found = []
    for (axis, method), own in groups(rows).items():
        predicted = own[0]["predicted_limit"]
        states = [row["state"] == "ok" for row in own]
        # walks go from safe to broken, but for those of a separation, which go the other way
        change = next((i for i in range(1, len(own)) if states[i] != states[0]), None)
        measured = None if change is None else float(own[change - 1 if states[0] else change]["x"])
        if predicted == "na" or measured is None:
            verdict = "" if predicted == "na" else "never reached" if states[0] else "never ok"
        else:
            ratio = measured / float(predicted)
            verdict = "agrees" if 1 / FACTOR <= ratio <= FACTOR else "DISAGREES"
        found.append([axis, method, predicted, measured, verdict])
    return found


# Axes on which wrong_px tells more than err_px
COUNTED = {"t_junction_edge_px": "cracks at 4,000 junctions (0.1: none)", "coplanar_units_per_px": "pixels of the second (0.1: none)",
           "crossing_units_per_px": "wrong pixels (0.1: none)",
           "picture_side_px": "rows that differ (0.1: none)"}
# ... and on which err_px is something else than a displacement
ERRORS = {"depth16": "pixels lost (0.1: none)", "grazing": "mip levels off", "line_": "set-ups beyond the first, per triangle",
          "link": "part of the frames that is not shown"}


def label(axis):
    for start, text in ERRORS.items():
        if axis.startswith(start):
            return text
    return COUNTED.get(axis, "displacement, px (1/4096: none)")


def draw(folder, rows):
    """Charts of err_px (wrong pixels for separations of depth) against x; their names."""
    os.makedirs(folder, exist_ok=True)
    script, names, axes = ["set grid lt 1 lc rgb '#e4e4e4'", "set key below maxcols 4 samplen 1.5 font ',11'", "set bmargin 7.5", "set logscale xy",
                           "set format '%g'", "set border 3", "set tics nomirror"], [], {}
    for (axis, method), own in groups(rows).items():
        axes.setdefault(axis, {})[method] = own
    for axis, methods in axes.items():
        depth = axis in COUNTED or axis.startswith("depth16")
        plots, predicted = [], []
        for i, (method, own) in enumerate(methods.items()):
            script.append(f"$d{len(names)}_{i} << EOD")
            for before, row in zip([own[0], *own], own):
                if row["state"] != before["state"] and "refused" in (row["state"], before["state"]):
                    script.append("")  # no line from what was drawn to what was refused
                y = max(float(row["wrong_px"]), 0.1) if depth else max(float(row["err_px"]), 1 / 4096)
                script.append(f"{row['x']} {y:.6g} {({'ok': 7, 'degraded': 6, 'refused': 2})[row['state']]}")
            script.append("EOD")
            plots.append(f"$d{len(names)}_{i} using 1:2 with lines lc rgb '{COLOURS[i % len(COLOURS)]}' title '{method}', "
                         f"$d{len(names)}_{i} using 1:2:3 with points pt variable ps 0.7 lc rgb '{COLOURS[i % len(COLOURS)]}' notitle")
            if own[0]["predicted_limit"] != "na":
                predicted.append((float(own[0]["predicted_limit"]), COLOURS[i % len(COLOURS)]))
        name = f"stability-{axis}"
        positive = all(float(row["x"]) > 0 for own in methods.values() for row in own)
        script += ["unset arrow", "set logscale xy" if positive else "unset logscale x"]
        script += [f"set arrow from {x:.6g}, graph 0 to {x:.6g}, graph 1 nohead dt 2 lc rgb '{colour}'" for x, colour in predicted]
        script += [f"set xlabel '{axis.replace('_', ' ')}'", f"set ylabel '{label(axis)}'"]
        for terminal, suffix in (("svg size 480,400 dynamic noenhanced font 'sans,12' background '#ffffff'", "svg"),
                                 ("pngcairo size 480,400 noenhanced font 'DejaVu Sans,10'", "png")):
            script += [f"set terminal {terminal}", f"set output '{name}.{suffix}'", "plot " + ", ".join(plots)]
        names.append(name)
    plot_script(folder, "stability.gp", script)
    return names


def edges(values):
    """Between the values of an axis, and half a step beyond its ends, in log10 (bits as they are)."""
    if len(values) == 1:
        return [values[0] - 0.5, values[0] + 0.5]
    steps = [(b - a) / 2 for a, b in zip(values, values[1:])]
    return [values[0] - steps[0], *(a + s for a, s in zip(values, steps)), values[-1] + steps[-1]]


def draw_maps(folder, rows):
    """A heat map for each pair, with the predicted limit drawn on top; their names."""
    script, names = ["set border 3", "set tics nomirror out", "set bmargin 4.5", "set rmargin 14", "set logscale cb", "set format cb '%g'",
                     "set palette defined (0 '#0d0d4d', 1 '#0073b3', 2 '#33bf4d', 3 '#ffd91a', 4 '#d91a1a')"], []
    for name, (x_text, y_text, value_text, line, (low, high)) in MAPS.items():
        own = [row for row in rows if row["map"] == name]
        bits = [text.endswith("bits") or text.startswith("fraction bits") for text in (x_text, y_text)]
        at = [[float(row[c]) if b else math.log10(float(row[c])) for row in own] for c, b in zip("xy", bits)]
        script.append(f"$m{len(names)} << EOD")
        sides = [dict(zip(sorted(set(a)), zip(edges(sorted(set(a))), edges(sorted(set(a)))[1:]))) for a in at]
        for row, x, y in zip(own, *at):
            value = min(max(float(row["value"]), low), high)
            script.append(f"{x:.5f} {y:.5f} {sides[0][x][0]:.5f} {sides[0][x][1]:.5f} {sides[1][y][0]:.5f} {sides[1][y][1]:.5f} {value:.5g}")
        script += ["EOD", f"$l{len(names)} << EOD"]
        for x, limit in sorted({(x, float(row["limit_y"])) for row, x in zip(own, at[0])}):
            if bits[1] or limit > 0:
                script.append(f"{x:.5f} {limit if bits[1] else math.log10(limit):.5f}")
        script.append("EOD")
        ranges = [(min(a for a, _ in s.values()), max(b for _, b in s.values())) for s in sides]
        for axis, text, bit, ends in zip("xy", (x_text, y_text), bits, ranges):
            tics = "autofreq 2" if bit else "(" + ", ".join(f"'1e{e}' {e}" for e in range(math.ceil(ends[0]), math.floor(ends[1]) + 1, 1 + (ends[1] - ends[0] > 7))) + ")"
            script += [f"set {axis}label '{text}'", f"set {axis}tics {tics}", f"set {axis}range [{ends[0]:.5f}:{ends[1]:.5f}]"]
        script += [f"set title '{name.replace('_', ' ')}'", f"set cblabel '{value_text}'", f"set cbrange [{low}:{high}]"]
        plot = (f"plot $m{len(names)} using 1:2:3:4:5:6:7 with boxxyerror fs solid noborder fc palette notitle, "
                f"$l{len(names)} using 1:2 with linespoints pt 7 ps 0.3 lw 3 lc rgb '#ffffff' notitle, "
                f"$l{len(names)} using 1:2 with lines lw 1.5 lc rgb '#000000' title 'predicted{'' if line is None else f': {line:g}'}'")
        for terminal, suffix in (("svg size 520,420 dynamic noenhanced font 'sans,12' background '#ffffff'", "svg"),
                                 ("pngcairo size 520,420 noenhanced font 'DejaVu Sans,10'", "png")):
            script += [f"set terminal {terminal}", f"set output 'map-{name}.{suffix}'", "set key above", plot]
        names.append(f"map-{name}")
    plot_script(folder, "maps.gp", script)
    return names


def plot_script(folder, name, lines):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as f:
        f.write("\n".join(lines) + "\n")
    done = subprocess.run(["gnuplot", name], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        raise Failed(f"gnuplot: {done.stdout.strip()[-400:]}")


def write(path, columns, rows):
    with open(path, "w", newline="", encoding="utf-8") as f:
        out = csv.DictWriter(f, columns, lineterminator="\n")
        out.writeheader()
        out.writerows(rows)


def read(path):
    with open(path, encoding="utf-8") as f:
        return list(csv.DictReader(f))


def main():
    parser = argparse.ArgumentParser(description="Walks the axes along which methods fail.")
    parser.add_argument("--out", required=True)
    parser.add_argument("programs", nargs="+")
    args = parser.parse_args()
    rows, cells = walk(args.programs)
    path = os.path.join(args.out, "stability.csv")
    write(path, COLUMNS, rows)
    write(os.path.join(args.out, "maps.csv"), MAP_COLUMNS, cells)
    draw(os.path.join(args.out, "charts"), rows)
    draw_maps(os.path.join(args.out, "charts"), cells)
    wrong = 0
    for axis, method, predicted, measured, verdict in limits(rows):
        if verdict:
            print(f"{axis:34s} {method:10s} predicted {predicted:>10s} measured {'-' if measured is None else f'{measured:g}':>10s} {verdict}")
        wrong += verdict == "DISAGREES"
    states = [row["state"] for row in rows]
    print(f"stability: {path}: {len(rows)} steps, " + ", ".join(f"{states.count(s)} {s}" for s in ("ok", "degraded", "refused")) +
          f"; {wrong} limits disagree")
    return 3 if wrong else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Failed, OSError) as e:
        print(f"atlas.py: {e}", file=sys.stderr)
        sys.exit(2)
