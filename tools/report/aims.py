"""What is aimed at and what is reached, and a chart of where the instructions go: a bar for each target and scene, with
a part for each stage."""
import atlas
import goals
import where
import work

COLOURS = {"scene": "#8d6e63", "vertices": "#7b3fa0", "culling": "#5c6bc0", "placing": "#1b6ca8", "set-up": "#0a9396",
           "edges": "#9e9d24", "rows": "#d98a00", "pixels": "#2a9d4a", "products": "#c8102e", "copies": "#555555"}
BAR, AROUND = 22, 230  # px of the chart's height
CHART = "aims-stages"


def parts(of):
    """[(stage, from, to)] of a bar."""
    at = 0.0
    for stage, n in of.items():
        yield stage, at, at + n
        at += n


def places(pictures):
    """{(target, scene): where its bar is}, from the top, a gap behind each target."""
    found, at, before = {}, 0.0, None
    for target, scene in pictures:
        at += 1.0 if before in (None, target) else 1.6
        found[target, scene] = at
        before = target
    return found


def draw(folder, rows):
    """The chart of rows of where.csv. Its [(name, text)]."""
    pictures = where.shown(rows)
    at, script, plots = places(pictures), [], []
    for i, stage in enumerate(where.PURPOSES):
        own = [(x0, x1, at[key]) for key, of in pictures.items() for s, x0, x1 in parts(of) if s == stage]
        if any(x1 > x0 for x0, x1, _ in own):
            script += [f"$a{i} << EOD", *(f"{x0:.6g} {x1:.6g} {y:.6g}" for x0, x1, y in own), "EOD"]
            plots.append(f"$a{i} using 1:3:1:2:($3 - 0.4):($3 + 0.4) with boxxyerror fs solid 1 noborder lc rgb '{COLOURS[stage]}' title '{stage}'")
    script += ["$sums << EOD", *(f"{sum(of.values()):.6g} {at[key]:.6g} {sum(of.values()):.1f}" for key, of in pictures.items()), "EOD"]
    plots.append("$sums using 1:2:3 with labels left offset 0.4,0 notitle")
    script += ["set grid x lt 1 lc rgb '#e4e4e4'", "set key below samplen 1.5", "set border 3", "set tics nomirror", "set bmargin 9",
               f"set yrange [{max(at.values()) + 1:.6g}:0]", f"set xrange [0:{1.1 * max(sum(of.values()) for of in pictures.values()):.6g}]",
               "set ytics ({})".format(", ".join(f"'{' '.join(key)}' {y:.6g}" for key, y in at.items())),
               f"set title 'where the instructions go, {where.SHOWN} px'", "set xlabel 'instructions per fragment'"]
    work.output(script, CHART, "plot " + ", ".join(plots), 640, int(AROUND + BAR * max(at.values())))
    atlas.plot_script(folder, "aims.gp", script)
    return [(CHART, "Instructions per fragment by stage. On the host pixels are part of rows.")]


def short(row, column):
    if row[column] == "na":
        return "na"
    return f"{float(row[column]):,.0f} bytes" if row["unit"] == goals.BYTES else f"{float(row[column]):.4g}"


def name(row):
    at = "" if row["tolerance"] == "na" else f" {row['tolerance']} px"
    return " ".join(row[c] for c in ("target", "scene", "figure") if row[c] != "na") + at


def section(rows, names, table, charts_of):
    """The page's section; rows: of goals.csv."""
    lines = []
    for row in rows:
        met = {"met": "<td>met</td>", "missed": "<td class='over'>missed</td>", "na": "<td>na</td>"}[row["state"]]
        most = ", ".join(f"{stage} {n:.1f}" for stage, n, _ in goals.shares(row)[:3]) if row["picture"] else ""
        lines.append([name(row), short(row, "goal"), short(row, "reached"), met, most, row["notes"]])
    stages = "; ".join(f"<b>{stage}</b>: {purpose}" for stage, purpose in where.PURPOSES.items())
    return f"""<p>What this project has set itself, and how far it is: instructions per fragment, with the three stages of the work that
take most of them, and bytes of text at -O2. All stages are in <a href="where.csv">where.csv</a>, the aims in <a href="goals.csv">goals.csv</a>.</p>
{table(["", "aim", "reached", "", "most in", "notes"], lines)}
<div class="single">{charts_of(names)}</div>
<p class="soft">{stages}. A function belongs to a stage with all that the compiler put into it; pixel loops are told from the rest of
their function by the machine code.</p>"""
