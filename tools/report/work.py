"""Cost against work: what is counted when one thing grows, the straight lines through it, frames of an
animation; and what a configuration takes of flash and stack. Tables and charts."""
import csv
import math
import os

import atlas
import count
import tables

COLUMNS = "target sweep x triangles fragments instructions cycles_low cycles_typical cycles_high notes".split()
FIT_COLUMNS = "target sweep unit from to per_unit constant worst_off exponent".split()
FRAME_COLUMNS = "target scene frames mean_instructions worst_instructions worst_frame mean_cycles worst_cycles worst_over_mean notes".split()
SWEEPS = {"triangles": "triangles of a sheet that fills 240 x 240 px", "pixels": "pixels across and down, 128 triangles",
          "texels": "texels along a texture, 128 triangles, 240 x 240 px"}
COLOURS = {"host": "#1b6ca8", "m0plus": "#c8102e", "m3": "#2a9d4a", "rv32imc": "#d98a00"}


def targets_of(targets):
    return [target for target in targets if target in COLOURS]


def count_target(build, target):
    return count.count_image(build, f"work-{target}", target)


def rows_of(build, counts):
    """Rows of work.csv; counts: {target: [Count]}. Every target has drawn the same pictures, which is checked."""
    lines = [line.split(",") for line in count.run([os.path.join(build, "work-list"), "--list"]).split()]
    rows, pictures = [], None
    for target, of_target in counts.items():
        drawn = [c.picture for c in of_target]
        pictures = pictures or drawn
        if drawn != pictures or len(drawn) != len(lines):
            raise tables.Failed(f"work-{target}: other pictures than on the other targets")
        for (sweep, x, triangles, fragments), c in zip(lines, of_target):
            low, typical, high = c.cycles or ("na",) * 3
            rows.append({"target": target, "sweep": sweep, "x": int(x), "triangles": triangles, "fragments": int(fragments),
                         "instructions": c.instructions, "cycles_low": low, "cycles_typical": typical, "cycles_high": high,
                         "notes": "" if c.cycles else "cycles: no timing table for the host's processor"})
    return rows


def fit(points):
    """(a, b, worst): y = a + b x, the least relative squares; worst: the largest relative deviation."""
    sums = [sum(x ** i / y ** (2 - j) for x, y in points) for i, j in ((0, 0), (1, 0), (2, 0), (0, 1), (1, 1))]
    s, sx, sxx, sy, sxy = sums
    b = (s * sxy - sx * sy) / (s * sxx - sx * sx)
    a = (sy - b * sx) / s
    return a, b, max(abs((a + b * x) / y - 1) for x, y in points)


def fits(rows):
    """A straight line through each sweep: over triangles; over fragments, where pixels grow; over texels, where it
    should be flat up to 2^16 of them, beyond which the fastest loop does not draw. The exponent is that between the two
    largest steps."""
    for target in dict.fromkeys(row["target"] for row in rows):
        for sweep, unit in (("triangles", "triangle"), ("pixels", "fragment"), ("texels", "texel of the side")):
            own = [row for row in rows if row["target"] == target and row["sweep"] == sweep and (sweep != "texels" or row["x"] <= 256)]
            points = [(row["fragments"] if sweep == "pixels" else row["x"], row["instructions"]) for row in own]
            a, b, worst = fit(points)
            (x0, y0), (x1, y1) = points[-2:]
            yield {"target": target, "sweep": sweep, "unit": unit, "from": points[0][0], "to": points[-1][0], "per_unit": f"{b if abs(b) >= 0.0005 else 0:.3f}",
                   "constant": f"{a:.0f}", "worst_off": f"{worst:.3f}", "exponent": f"{math.log(y1 / y0) / math.log(x1 / x0):.3f}"}


def frames(rows):
    for target in dict.fromkeys(row["target"] for row in rows):
        for scene in dict.fromkeys(row["sweep"] for row in rows if row["sweep"] not in SWEEPS):
            own = [row for row in rows if row["target"] == target and row["sweep"] == scene]
            instructions = [row["instructions"] for row in own]
            worst = max(own, key=lambda row: row["instructions"])
            cycles = [row["cycles_typical"] for row in own]
            known = cycles[0] != "na"
            mean = sum(instructions) / len(own)
            yield {"target": target, "scene": scene, "frames": len(own), "mean_instructions": f"{mean:.0f}",
                   "worst_instructions": worst["instructions"], "worst_frame": worst["x"], "mean_cycles": f"{sum(cycles) / len(own):.0f}" if known else "na",
                   "worst_cycles": max(cycles) if known else "na", "worst_over_mean": f"{worst['instructions'] / mean:.3f}", "notes": own[0]["notes"]}


# ---- charts ----

def chart(script, name, title, x_text, y_text, series, logarithmic=True, ranges=()):
    """series: [(label, colour, [(x, y)])]; ranges: commands of gnuplot's"""
    plots = []
    for i, (_, _, points) in enumerate(series):
        script += [f"$s{i} << EOD", *(f"{x} {y}" for x, y in points), "EOD"]
    plots = [f"$s{i} using 1:2 with linespoints pt 7 ps 0.6 lw 2 lc rgb '{colour}' title '{label}'" for i, (label, colour, _) in enumerate(series)]
    script += ["reset", "set grid lt 1 lc rgb '#e4e4e4'", "set key below samplen 1.5", "set border 3", "set tics nomirror", "set bmargin 6.5",
               "set format '%g'", "set logscale xy" if logarithmic else "set yrange [0:*]", f"set title '{title}'", f"set xlabel '{x_text}'",
               f"set ylabel '{y_text}'", *ranges]
    output(script, name, "plot " + ", ".join(plots))


def output(script, name, plot, width=480, height=400):
    """Letters grow with the width: on the page all charts are equally wide."""
    for terminal, suffix in ((f"svg size {width},{height} dynamic noenhanced font 'sans,{width // 40}' background '#ffffff'", "svg"),
                             (f"pngcairo size {width},{height} noenhanced font 'DejaVu Sans,10'", "png")):
        script += [f"set terminal {terminal}", f"set output '{name}.{suffix}'", plot]


def draw(folder, rows, sizes, stacks):
    """Names of the charts of work, and of sizes."""
    script, names = [], []
    targets = list(dict.fromkeys(row["target"] for row in rows))
    for sweep, text in SWEEPS.items() if targets else ():
        series = [(target, COLOURS[target], [(row["x"], row["instructions"]) for row in rows if (row["target"], row["sweep"]) == (target, sweep)])
                  for target in targets]
        names.append((f"work-{sweep}", text))
        chart(script, f"work-{sweep}", f"instructions against {sweep}", text, "instructions per frame", series)
    for scene in dict.fromkeys(row["sweep"] for row in rows if row["sweep"] not in SWEEPS):
        series = [(target, COLOURS[target], [(row["x"], row["instructions"] / 1e6) for row in rows if (row["target"], row["sweep"]) == (target, scene)])
                  for target in targets]
        names.append((f"work-{scene}", f"frames of the animation of {scene}"))
        chart(script, f"work-{scene}", f"{scene}, frame by frame", "frame", "million instructions", series, logarithmic=False)
    size_names = []
    for name, title, unit, cells in (("size-text", "flash of a configuration", "bytes of text", sizes), ("size-stack", "deepest stack of a configuration", "bytes", stacks)):
        script += ["reset", "$b << EOD"]
        configurations = list(dict.fromkeys(configuration for _, configuration in cells))
        builds = list(dict.fromkeys(build for build, _ in cells))
        for configuration in configurations:
            script.append(f'"{configuration}" ' + " ".join(str(cells[build, configuration]) for build in builds))
        script += ["EOD", "set style data histograms", "set style fill solid", "set boxwidth 0.9", "set grid y lt 1 lc rgb '#e4e4e4'", "set border 3",
                   "set key above", "set xtics rotate by -28 nomirror", "set ytics nomirror", "set bmargin 10", "set rmargin 12", "set yrange [0:*]",
                   f"set title '{title}'", f"set ylabel '{unit}'"]
        if name == "size-stack":
            script.append("set arrow from graph 0, first 512 to graph 1, first 512 nohead dt 2 lc rgb '#c8102e' front")
        shades = ["#f2a3ad", "#c8102e", "#9ad3aa", "#2a9d4a", "#f3cf99", "#d98a00"]
        plots = [f"$b using {i + 2}:xtic(1) lc rgb '{shades[i % len(shades)]}' title '{build}'" for i, build in enumerate(builds)]
        output(script, name, "plot " + ", ".join(plots), 640, 560)
        size_names.append((name, title))
    atlas.plot_script(folder, "work.gp", script)
    return names, size_names


def read_sizes(out):
    """{(build, configuration): bytes of text}, {(build, configuration): bytes of the deepest stack} of size.csv and stack.csv."""
    sizes, stacks = {}, {}
    with open(os.path.join(out, "size.csv"), encoding="utf-8") as f:
        for row in csv.DictReader(f):
            if row["kind"] == "configuration":
                sizes[f"{row['target']} {row['level']}", row["name"]] = int(row["text"])
    with open(os.path.join(out, "stack.csv"), encoding="utf-8") as f:
        for row in csv.DictReader(f):
            key = f"{row['target']} {row['level']}", row["configuration"]
            stacks[key] = max(stacks.get(key, 0), int(row["bytes"]))
    return sizes, {key: stacks[key] for key in sizes}
