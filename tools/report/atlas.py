#!/usr/bin/env python3
"""The stability atlas: runs the walks, writes stability.csv, draws a chart for each axis, and holds
the measured limits against the predicted ones.

usage: atlas.py --out DIR PROGRAM ...     (the first walks all axes, the others the table's)

A limit is measured as the last step that was ok before the first that was not; it has to lie
within a factor of 1.5 of the predicted one. Exit status 1 when one does not.
"""
import argparse
import csv
import os
import subprocess
import sys

COLUMNS = "axis method x err_px err_lsb wrong_px predicted_limit state".split()
FACTOR = 1.5
COLOURS = ["#1b6ca8", "#7b3fa0", "#2a9d4a", "#d98a00", "#c8102e", "#0a9396", "#8d6e63", "#5c6bc0"]


class Failed(Exception):
    pass


def walk(programs):
    rows = []
    for i, program in enumerate(programs):
        if sys.stderr.isatty():
            print(f"\r\033[K[{i}/{len(programs)}] {program}", end="", file=sys.stderr, flush=True)
        done = subprocess.run([program, *(["--axes", "recip"] if i else [])], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            raise Failed(f"{program}: status {done.returncode}: {done.stderr.strip()[-400:]}")
        rows += csv.DictReader(done.stdout.splitlines(), COLUMNS) if i else csv.DictReader(done.stdout.splitlines())
    if sys.stderr.isatty():
        print(file=sys.stderr)
    return rows


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


def draw(folder, rows):
    """Charts of err_px (wrong pixels for separations of depth) against x; their names."""
    os.makedirs(folder, exist_ok=True)
    script, names, axes = ["set grid lc rgb '#e4e4e4'", "set key below samplen 1.5 font ',10'", "set bmargin 6.5", "set logscale xy",
                           "set format '%g'", "set border 3", "set tics nomirror"], [], {}
    for (axis, method), own in groups(rows).items():
        axes.setdefault(axis, {})[method] = own
    for axis, methods in axes.items():
        depth = axis.startswith("depth16")
        plots, predicted = [], []
        for i, (method, own) in enumerate(methods.items()):
            script.append(f"$d{len(names)}_{i} << EOD")
            for row in own:
                y = max(float(row["wrong_px"]), 0.1) if depth else max(float(row["err_px"]), 1 / 4096)
                if float(row["x"]) > 0:
                    script.append(f"{row['x']} {y:.6g} {({'ok': 7, 'degraded': 6, 'refused': 2})[row['state']]}")
            script.append("EOD")
            plots.append(f"$d{len(names)}_{i} using 1:2 with lines lc rgb '{COLOURS[i % len(COLOURS)]}' title '{method}', "
                         f"$d{len(names)}_{i} using 1:2:3 with points pt variable ps 0.7 lc rgb '{COLOURS[i % len(COLOURS)]}' notitle")
            if own[0]["predicted_limit"] != "na":
                predicted.append((float(own[0]["predicted_limit"]), COLOURS[i % len(COLOURS)]))
        name = f"stability-{axis}"
        script.append("unset arrow")
        script += [f"set arrow from {x:.6g}, graph 0 to {x:.6g}, graph 1 nohead dt 2 lc rgb '{colour}'" for x, colour in predicted]
        script += [f"set title '{axis.replace('_', ' ')}'", "set xlabel 'x'",
                   f"set ylabel '{'pixels lost (0.1: none)' if depth else 'worst displacement, px (below 1/4096 at it)'}'"]
        for terminal, suffix in (("svg size 480,400 dynamic noenhanced font 'sans,12' background '#ffffff'", "svg"),
                                 ("pngcairo size 480,400 noenhanced font 'DejaVu Sans,10'", "png")):
            script += [f"set terminal {terminal}", f"set output '{name}.{suffix}'", "plot " + ", ".join(plots)]
        names.append(name)
    with open(os.path.join(folder, "stability.gp"), "w", encoding="utf-8") as f:
        f.write("\n".join(script) + "\n")
    done = subprocess.run(["gnuplot", "stability.gp"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        raise Failed(f"gnuplot: {done.stdout.strip()[-400:]}")
    return names


def read(path):
    with open(path, encoding="utf-8") as f:
        return list(csv.DictReader(f))


def main():
    parser = argparse.ArgumentParser(description="Walks the axes along which methods fail.")
    parser.add_argument("--out", required=True)
    parser.add_argument("programs", nargs="+")
    args = parser.parse_args()
    rows = walk(args.programs)
    path = os.path.join(args.out, "stability.csv")
    with open(path, "w", newline="", encoding="utf-8") as f:
        out = csv.DictWriter(f, COLUMNS, lineterminator="\n")
        out.writeheader()
        out.writerows(rows)
    draw(os.path.join(args.out, "charts"), rows)
    wrong = 0
    for axis, method, predicted, measured, verdict in limits(rows):
        if verdict:
            print(f"{axis:34s} {method:10s} predicted {predicted:>10s} measured {'-' if measured is None else f'{measured:g}':>10s} {verdict}")
        wrong += verdict == "DISAGREES"
    states = [row["state"] for row in rows]
    print(f"stability: {path}: {len(rows)} steps, " + ", ".join(f"{states.count(s)} {s}" for s in ("ok", "degraded", "refused")) +
          f"; {wrong} limits disagree")
    return 1 if wrong else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Failed, OSError) as e:
        print(f"atlas.py: {e}", file=sys.stderr)
        sys.exit(2)
