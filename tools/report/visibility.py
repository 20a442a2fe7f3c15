#!/usr/bin/env python3
"""Three ways to find what is seen - a depth buffer, one row of depth, spans - against the size of triangles and
depth complexity: counts, where they cross, charts, and the page's section.

usage: visibility.py --build DIR --out DIR   (m3)
"""
import argparse
import math
import os
import sys

import atlas
import count
import tables
import work

TARGETS = ["m3"]
COLUMNS = "target way edge_px complexity instr_per_px cycles_per_px instructions active notes".split()
CROSSING_COLUMNS = "target against along at spans_are_cheaper_from unit".split()
COLOURS = {"full z": "#1b6ca8", "1-D z": "#d98a00", "spans": "#2a9d4a"}
SHOWN = (1, 2, 4, 16)  # layers of which there is a chart


def rows_of(build, target):
    """Rows of visibility.csv."""
    cases = [line.split(",") for line in count.run([os.path.join(build, "visibility-list"), "--list"]).splitlines()]
    counts = count.count_image(build, f"visibility-{target}", target)
    if len(cases) != len(counts):
        raise tables.Failed(f"visibility-{target}: {len(counts)} counts for {len(cases)} cases")
    for (way, edge, complexity, pixels, active), c in zip(cases, counts):
        per_px = [n / int(pixels) for n in (c.instructions, c.cycles[1])]
        yield {"target": target, "way": way, "edge_px": int(edge), "complexity": int(complexity), "instr_per_px": f"{per_px[0]:.3f}",
               "cycles_per_px": f"{per_px[1]:.3f}", "instructions": c.instructions, "active": int(active), "notes": ""}


def measure(build, out, targets):
    """Writes visibility.csv and visibility_crossings.csv, and the charts. Returns the crossings."""
    rows = [row for target in TARGETS if target in targets for row in rows_of(build, target)]
    found = list(crossings(rows))
    tables.write(os.path.join(out, "visibility.csv"), COLUMNS, rows)
    tables.write(os.path.join(out, "visibility_crossings.csv"), CROSSING_COLUMNS, found)
    if rows:
        draw(os.path.join(out, "charts"), rows, found)
    return found


# ---- crossings ----

def crossing(points):
    """Where spans become cheaper: points are (x, cost of spans / cost of the other), x growing. Between two points
    the logarithm of the ratio is a straight line over that of x. 'always', 'never' within what was counted, or
    the last place from where on they stay cheaper."""
    if points[-1][1] >= 1:
        return "never"
    for (x0, y0), (x1, y1) in reversed(list(zip(points, points[1:]))):
        if y0 >= 1:
            part = math.log(y0) / (math.log(y0) - math.log(y1))
            return math.exp(math.log(x0) + part * math.log(x1 / x0))
    return "always"


def crossings(rows):
    """From which depth complexity on spans are cheaper, for each size; from which size on, for each complexity."""
    for target in dict.fromkeys(row["target"] for row in rows):
        cost = {(row["way"], row["edge_px"], row["complexity"]): row["instructions"] for row in rows if row["target"] == target}
        edges, layers = (sorted({key[i] for key in cost}) for i in (1, 2))
        for against in ("1-D z", "full z"):
            for along, fixed, moving in (("complexity", edges, layers), ("edge", layers, edges)):
                for at in fixed:
                    key = (lambda x, at=at: (at, x)) if along == "complexity" else (lambda x, at=at: (x, at))
                    where = crossing([(x, cost[("spans", *key(x))] / cost[(against, *key(x))]) for x in moving])
                    yield {"target": target, "against": against, "along": along, "at": at,
                           "spans_are_cheaper_from": where if isinstance(where, str) else f"{where:.2f}",
                           "unit": "layers, triangles of `at` px" if along == "complexity" else "px, `at` layers"}


# ---- charts ----

def draw(folder, rows, found):
    os.makedirs(folder, exist_ok=True)
    script = []
    for target in dict.fromkeys(row["target"] for row in rows):
        own = [row for row in rows if row["target"] == target]
        edges = sorted({row["edge_px"] for row in own})
        layers_counted = sorted({row["complexity"] for row in own})
        powers = [f"set xrange [{edges[0]}:{edges[-1]}]", f"set xtics ({', '.join(map(str, edges))})"]
        for layers in SHOWN:
            series = [(way, colour, [(row["edge_px"], row["instr_per_px"]) for row in own if (row["way"], row["complexity"]) == (way, layers)])
                      for way, colour in COLOURS.items()]
            work.chart(script, f"visibility-{target}-{layers}", f"{target}: {layers} layer{'s' if layers > 1 else ''}", "edge of a triangle, px",
                       "instructions per pixel of the picture", series, ranges=powers)
        series = []
        for against, colour in (("1-D z", COLOURS["1-D z"]), ("full z", COLOURS["full z"])):
            points = [(row["at"], row["spans_are_cheaper_from"]) if row["along"] == "complexity" else (row["spans_are_cheaper_from"], row["at"])
                      for row in found if (row["target"], row["against"]) == (target, against)]
            known = sorted((float(x), float(y)) for x, y in points if not {x, y} & {"never", "always"})
            if known:
                series.append((f"above: spans cheaper than {against}", colour, known))
        if series:
            work.chart(script, f"visibility-{target}-crossings", f"{target}: where spans become cheaper", "edge of a triangle, px",
                       "depth complexity, layers", series,
                       ranges=[*powers, f"set yrange [1:{layers_counted[-1]}]", f"set ytics ({', '.join(map(str, layers_counted))})"])
    atlas.plot_script(folder, "visibility.gp", script)


# ---- the page ----

def section(out, table, charts_of):
    """The page's section, of what `measure` wrote."""
    found, rows = (atlas.read(os.path.join(out, name)) for name in ("visibility_crossings.csv", "visibility.csv"))
    if not rows:
        return "<p>Not counted: it is done on m3 alone.</p>"
    text = ["""<p>What hides what can be found by a depth buffer of the picture (full z, the picture at once), by one row of depth that is used again
on each line (1-D z, line by line), or by comparing spans where they begin and end (spans, line by line: every pixel is drawn once). Sheets of
equal right-angled triangles, one behind the other in no order, each of which fills 256 x 128 pixels; textured, 1/4 pixel. Everything is counted: the
clear, transform, sorting, set-up. <a href="visibility.csv">visibility.csv</a>, <a href="visibility_crossings.csv">visibility_crossings.csv</a></p>"""]
    for target in dict.fromkeys(row["target"] for row in rows):
        own = [row for row in found if row["target"] == target]
        for along, what, unit in (("complexity", "edge of a triangle", "px"), ("edge", "depth complexity", "layers")):
            at = list(dict.fromkeys(int(row["at"]) for row in own if row["along"] == along))
            cells = {(row["against"], int(row["at"])): row["spans_are_cheaper_from"] for row in own if row["along"] == along}
            lines = [[f"spans cheaper than {against} from ({'layers' if along == 'complexity' else 'px'})", *(cells[against, x] for x in at)]
                     for against in dict.fromkeys(against for against, _ in cells)]
            text.append(table([f"{target}: {what}, {unit}", *map(str, at)], lines))
        names = [(f"visibility-{target}-{layers}", f"{layers} layer{'s' if layers > 1 else ''}") for layers in SHOWN]
        crossings_name = f"visibility-{target}-crossings"
        if os.path.exists(os.path.join(out, "charts", crossings_name + ".svg")):
            names.append((crossings_name, "depth complexity from which spans are cheaper"))
        text.append(f'<div class="grid">{charts_of(names)}</div>')
    return "\n".join(text)


def main():
    parser = argparse.ArgumentParser(description="Counts three ways to find what is seen.")
    parser.add_argument("--build", required=True)
    parser.add_argument("--out", required=True)
    args = parser.parse_args()
    for row in measure(args.build, args.out, TARGETS):
        where = row["spans_are_cheaper_from"]
        where = where if where in ("always", "never") else f"from {where} on"
        print(f"{row['target']}: spans cheaper than {row['against']}: {where} ({row['unit'].replace('`at`', str(row['at']))})")


if __name__ == "__main__":
    try:
        main()
    except (atlas.Failed, count.Failed, tables.Failed, OSError) as e:
        sys.exit(f"visibility.py: {e}")
