"""RAM against speed of a picture drawn at once, in bands and line by line: charts of memory.csv, a panel for each
target, a line for each scene."""
import atlas
import count
import work

COLOURS = ["#1b6ca8", "#7b3fa0", "#2a9d4a", "#d98a00", "#c8102e", "#0a9396", "#8d6e63", "#5c6bc0"]
POINTS = {"at-once": 5, "line": 9, "spans": 13}  # a square, a triangle, a diamond; bands are dots
SPEEDS = {"instructions": "million instructions", "cycles_typical": "million modelled cycles"}


def named(rows):
    return [dict(zip(count.MEMORY_COLUMNS, row)) for row in rows]


def series(rows, target, speed):
    """{scene: [(bytes, millions, mode)]}, from the picture at once to lines; without what the target has no figures for."""
    found = {}
    for row in rows:
        if row["target"] == target and row[speed] != "na":
            found.setdefault(row["scene"], []).append((row["ram_bytes"], row[speed] / 1e6, row["mode"]))
    return found


def ticks(values):
    """1, 2 and 5 of each decade that the values reach into."""
    steps = [m * 10 ** e for e in range(-3, 5) for m in (1, 2, 5)]
    return [s for s in steps if min(values) / 2 < s < max(values) * 2]


def panel(script, name, title, speed, scenes):
    points = [point for own in scenes.values() for point in own]
    plots = []
    for i, (scene, own) in enumerate(scenes.items()):
        script += [f"$m{i} << EOD", *(f"{x / 1024:.6g} {y:.6g} {POINTS.get(mode, 7)}" for x, y, mode in own), "EOD"]
        colour = COLOURS[i % len(COLOURS)]
        plots += [f"$m{i} using 1:($3 == {POINTS['spans']} ? 1/0 : $2) with lines lw 2 lc rgb '{colour}' title '{scene}'",
                  f"$m{i} using 1:2:3 with points pt variable ps 0.9 lc rgb '{colour}' notitle"]
    plots += [f"1/0 with points pt {pt} ps 0.9 lc rgb '#555555' title '{mode}'" for mode, pt in (("at once", 5), ("in bands", 7), ("line by line", 9), ("by spans", 13))]
    script += ["reset", "set grid lt 1 lc rgb '#e4e4e4'", "set key below samplen 1.5", "set border 3", "set tics nomirror", "set bmargin 7.5",
               "set logscale xy", f"set title '{title}'", "set xlabel 'RAM beside scene and objects, KiB'", f"set ylabel '{SPEEDS[speed]}'",
               f"set xtics ({', '.join(f'{v:g}' for v in ticks([x / 1024 for x, _, _ in points]))})",
               f"set ytics ({', '.join(f'{v:g}' for v in ticks([y for _, y, _ in points]))})",
               f"set xrange [{min(x for x, _, _ in points) / 1024 / 1.2:.6g}:{max(x for x, _, _ in points) / 1024 * 1.2:.6g}]",
               f"set yrange [{min(y for _, y, _ in points) / 1.2:.6g}:{max(y for _, y, _ in points) * 1.2:.6g}]"]
    work.output(script, name, "plot " + ", ".join(plots), 480, 430)


def draw(folder, rows):
    """(name, text) of the charts, {speed: [...]}."""
    script, names, rows = [], {speed: [] for speed in SPEEDS}, named(rows)
    for target in dict.fromkeys(row["target"] for row in rows):
        for speed, text in SPEEDS.items():
            scenes = series(rows, target, speed)
            if scenes:
                name = f"memory-{target}-{speed.split('_')[0]}"
                panel(script, name, f"RAM against {text.split(' ', 1)[1]}, {target}", speed, scenes)
                names[speed].append((name, f"{target}: one picture in less and less RAM"))
    atlas.plot_script(folder, "memory.gp", script)
    return names
