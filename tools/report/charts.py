"""Charts by gnuplot, as SVG and PNG: speed against accuracy, a panel for each scene, target, speed
and error."""
import csv
import math
import os
import subprocess

import tables

SPEEDS = {"instr": ("instr_per_px", "instructions per fragment"), "cycles": ("cycles_per_px", "modelled cycles per fragment")}
ERRORS = {"worst": ("disp_max_px", "worst displacement, px"), "rms": ("disp_rms_px", "rms displacement, px"),
          "texels": ("texels", "rms error of u or v, texels")}
FLOOR = {"worst": 1 / 512, "rms": 1 / 8192, "texels": 1 / 8192}  # what is below stands here: a logarithmic axis has no 0
COLOURS = ["#1b6ca8", "#7b3fa0", "#2a9d4a", "#d98a00", "#0a9396", "#8d6e63", "#5c6bc0", "#9e9d24"]
AUTO_COLOUR, FRONTIER_COLOUR, REFERENCE_COLOUR, PEER_COLOUR = "#c8102e", "#b0b0b0", "#555555", "#d81b9a"
WIDTH, HEIGHT = 480, 450


def texels(row):
    return str(max(tables.number(row["u_rms"]), tables.number(row["v_rms"])))


def references(path):
    with open(path, encoding="utf-8") as f:
        rows = list(csv.DictReader(line for line in f if not line.startswith("#")))
    for row in rows:
        row["texels"] = texels(row)
    return rows


def error_of(row, error):
    value = tables.number(row[ERRORS[error][0]])
    return value if math.isnan(value) else max(value, FLOOR[error])


def points(rows, speed, error):
    found = [(error_of(row, error), tables.number(row[SPEEDS[speed][0]])) for row in rows]
    return [p for p in found if not any(map(math.isnan, p))]


def frontier(of):
    """The points than which none is both cheaper and more exact, as a staircase."""
    best, stairs = math.inf, []
    for x, y in sorted(of):
        if y < best:
            if stairs:
                stairs.append((x, best))
            stairs.append((x, y))
            best = y
    return stairs


def series(rows, bits):
    """Method by method: those with a tolerance joined over the tolerances at the default table, the
    others over the sizes of the table."""
    methods = {}
    for row in rows:
        if row["tolerance_px"] == "na" or row["recip_bits"] == bits:
            methods.setdefault(row["method"], []).append(row)
    return methods


class Script:
    """gnuplot commands with their data inline; one file to run, and to read."""

    def __init__(self):
        self.lines, self.blocks = [], 0

    def block(self, of):
        self.blocks += 1
        self.lines += [f"$d{self.blocks} << EOD", *(" ".join(f"{v:.6g}" if isinstance(v, float) else str(v) for v in p) for p in of), "EOD"]
        return f"$d{self.blocks}"


def axes(shown, floor):
    """Ranges a little wider than the points; the left end says what it stands for."""
    xs, ys = zip(*shown)
    tics = [f"'<= 1/{round(1 / floor)}' {floor:.6g}"] + [f"'{10.0 ** e:g}' 1e{e}" for e in range(-4, 5) if 10.0 ** e > 4 * floor]
    values = [m * 10 ** e for e in range(0, 5) for m in (1, 2, 3, 5, 7)]
    return [f"set xrange [{floor / 1.4:.6g}:{max(max(xs), 4 * floor) * 1.5:.6g}]", f"set xtics ({', '.join(tics)})",
            f"set yrange [{min(ys) / 1.2:.6g}:{max(ys) * 1.2:.6g}]", f"set ytics ({', '.join(map(str, values))})"]


def panel(script, name, title, rows, marks, speed, error, bits):
    plots = []
    of = points([row for row in rows if row["recip_bits"] == bits], speed, error)
    if not of:
        return False
    shown = points(rows, speed, error) + points(marks, speed, error)
    plots.append(f"{script.block(frontier(of))} with lines lw 5 lc rgb '{FRONTIER_COLOUR}' title 'frontier'")
    colours = iter(COLOURS * 2)
    ordered = sorted(series(rows, bits).items(), key=lambda item: item[0].startswith(tables.AUTO))
    for method, own in ordered:
        auto = method.startswith(tables.AUTO)
        style = f"lw {3 if method == tables.AUTO else '1.5 dt 2'} pt 7 ps {1.1 if method == tables.AUTO else 0.7} lc rgb '{AUTO_COLOUR}'" if auto else f"lw 1.5 pt 6 ps 0.8 lc rgb '{next(colours)}'"
        plots.append(f"{script.block(points(own, speed, error))} with linespoints {style} title '{method}'")
    for source, pt, colour in (("prototype", 2, REFERENCE_COLOUR), ("peers", 3, PEER_COLOUR)):
        own = [mark for mark in marks if (mark["source"] == "prototype") == (source == "prototype")]
        own = sorted((x, y, mark["source"]) for mark in own for x, y in points([mark], speed, error))
        if own:
            data = script.block(own)
            plots.append(f"{data} using 1:2 with points pt {pt} ps 0.8 lc rgb '{colour}' title '{source}'")
            for first, offset in ((0, "0.7,0.5"), (1, "0.7,-0.5")) if source == "peers" else ():  # neighbours part
                plots.append(f"{data} every 2::{first} using 1:2:3 with labels left offset {offset} font ',9' tc rgb '{colour}' notitle")
    script.lines += [f"set title '{title}'", f"set xlabel '{ERRORS[error][1]}'", f"set ylabel '{SPEEDS[speed][1]}'",
                     *axes(shown, FLOOR[error])]
    for terminal, suffix in ((f"svg size {WIDTH},{HEIGHT} dynamic noenhanced font 'sans,12' background '#ffffff'", "svg"),
                             (f"pngcairo size {WIDTH},{HEIGHT} noenhanced font 'DejaVu Sans,10'", "png")):
        script.lines += [f"set terminal {terminal}", f"set output '{name}.{suffix}'", "plot " + ", ".join(plots)]
    return True


HEAD = ["set logscale xy", "set grid lt 1 lc rgb '#e4e4e4'", "set format x '%g'", "set format y '%g'",
        "set key below maxcols 4 samplen 1.5 font ',11'", "set bmargin 9.5", "set border 3", "set tics nomirror"]


def draw(folder, rows, reference_file, bits, report_progress):
    """Writes all charts; their names (without suffix) as {(scene, speed, error): [(target, name)]}."""
    os.makedirs(folder, exist_ok=True)
    marks, script, names = references(reference_file), Script(), {}
    script.lines += HEAD
    for row in rows:
        row["texels"] = texels(row)
    for scene in dict.fromkeys(row["scene"] for row in rows):
        for target in dict.fromkeys(row["target"] for row in rows):
            own = [row for row in rows if row["scene"] == scene and row["target"] == target]
            own_marks = [mark for mark in marks if mark["scene"] == scene and mark["target"] == target]
            for speed in SPEEDS:
                for error in ERRORS:
                    name = f"{scene}-{target}-{speed}-{error}"
                    here = own_marks if speed == "instr" else []
                    if panel(script, name, f"scene {scene}, {target}", own, here, speed, error, bits):
                        names.setdefault((scene, speed, error), []).append((target, name))
    path = os.path.join(folder, "charts.gp")
    with open(path, "w", encoding="utf-8") as f:
        f.write("\n".join(script.lines) + "\n")
    report_progress("charts")
    done = subprocess.run(["gnuplot", "charts.gp"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        raise tables.Failed(f"gnuplot: {done.stdout.strip()[-400:]}")
    return names
