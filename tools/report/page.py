"""The report's page: one HTML file beside its charts and pictures, no script."""
import html
import os

import aims
import atlas
import charts
import memory
import model
import tables
import visibility

SHOWN_TOLERANCE = "0.25"
PICTURES = [("reference", "what the referee draws in double precision"), ("ours", "what the library draws"),
            ("difference", "the difference, channel by channel: black is equal"),
            ("displacement", "displacement in pixels: 0 to 1/4"), ("texels", "error of u or v in texels: 0 to 1")]
SCENES = {
    "A": "A floor that recedes to the horizon: 1/z is constant along every scanline.",
    "B": "A sphere of 1,984 small triangles.",
    "C": "A floor that crosses the near plane and the sides of the screen.",
    "D": "The floor of A rolled by 60 degrees: 1/z changes along the scanline, the hardest case for runs.",
    "E": "A floor of 80 by 65 units that crosses the near plane.",
    "courtyard": "The sample scene, baked from glTF; its frame at 1 s.",
}
TARGETS = {
    "host": "the host's own processor", "m0plus": "Cortex-M0+", "m3": "Cortex-M3", "m4": "Cortex-M4, no floating point used",
    "m33": "Cortex-M33, no floating point used, its cycles an estimate", "rv32imc": "RV32IMC",
}
STYLE = """
:root { --ink: #1c2430; --soft: #5b6775; --line: #d9dee5; --accent: #c8102e; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1400px; padding: 0 16px 64px; color: var(--ink); background: #fff;
       font: 16px/1.55 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 32px 0 8px; } h2 { margin: 48px 0 8px; } h3 { margin: 28px 0 4px; }
p, li { max-width: 75ch; } .soft, figcaption { color: var(--soft); font-size: 0.9rem; } code { font-size: 0.9em; }
nav { margin-bottom: 16px; } nav a { margin-right: 14px; white-space: nowrap; }
.grid { display: grid; gap: 12px; grid-template-columns: repeat(auto-fill, minmax(min(100%, 400px), 1fr)); }
.single { max-width: 760px; }
.pictures { grid-template-columns: repeat(auto-fill, minmax(min(100%, 240px), 1fr)); }
figure { margin: 0; } img { width: 100%; height: auto; display: block; border: 1px solid var(--line); background: #fff; }
.pictures img { image-rendering: pixelated; }
.table { overflow-x: auto; margin: 8px 0 16px; } table { border-collapse: separate; border-spacing: 0; font-size: 0.9rem; }
th, td { padding: 3px 10px; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; position: sticky; left: 0; background: #fff; } thead th { border-bottom: 2px solid var(--ink); }
.over { color: var(--accent); font-weight: 600; } details { margin: 8px 0; } summary { cursor: pointer; color: #1b5e9c; }
.scale { height: 14px; max-width: 480px; border: 1px solid var(--line);
         background: linear-gradient(90deg, #0d0d4d, #0073b3 25%, #33bf4d 50%, #ffd91a 75%, #d91a1a); }
.scale-ends { display: flex; justify-content: space-between; max-width: 480px; }
pre { overflow-x: auto; background: #f4f6f8; padding: 10px; }
"""


def table(head, rows):
    def cells(row, tag):
        return "".join(c if c.startswith("<td") else f"<{tag}>{c}</{tag}>" for c in row)
    body = "\n".join(f"<tr>{cells(row, 'td')}</tr>" for row in rows)
    return f'<div class="table"><table><thead><tr>{cells(head, "th")}</tr></thead>\n<tbody>{body}</tbody></table></div>\n'


def short(value, digits=3):
    number = tables.number(value)
    return value if number != number else "0" if number == 0 else f"{number:.{digits}g}"


def first_auto(rows):
    """The rows of the automatic choice, of its first profile."""
    names = [row["method"] for row in rows if tables.is_auto(row)]
    return [row for row in rows if names and row["method"] == names[0]]


def first_sight(scenes, names):
    """A picture and what it costs, before any table."""
    scene = scenes[-1]
    shown = [(target, name) for target, name in names.get((scene, "instr", "worst"), []) if target in ("m0plus", "m3")]
    figures = "".join(f"<figure>{image(f'charts/{name}.svg', f'scene {scene}, {target}', lazy=False)}<figcaption>{TARGETS[target]}</figcaption></figure>" for target, name in shown)
    return f"""<div class="grid"><figure>{image(f'pictures/{scene}-ours.png', f'scene {scene}', lazy=False)}<figcaption>The sample scene as the library draws
it, told that a texel may be 1/4 pixel off.</figcaption></figure>{figures}</div>
<p class="soft">Each mark is a way to draw the scene: further down is faster, further left is more exact. The thick red line is the automatic
choice, told 0 to 2 pixels.</p>"""


def summary(rows, bits):
    own = [row for row in first_auto(rows) if row["recip_bits"] == bits and row["tolerance_px"] == SHOWN_TOLERANCE]
    scenes = list(dict.fromkeys(row["scene"] for row in own))
    lines = []
    for target in dict.fromkeys(row["target"] for row in own):
        of = {row["scene"]: row for row in own if row["target"] == target}
        lines.append([target] + [f"{float(of[s]['instr_per_px']):.1f}" + (
            "" if of[s]["cycles_per_px"] == "na" else f" <span class='soft'>({float(of[s]['cycles_per_px']):.1f})</span>") for s in scenes])
    return table(["target", *scenes], lines)


def accuracy(rows, bits):
    target = rows[0]["target"]
    own = [row for row in rows if row["target"] == target and row["recip_bits"] == bits and
           (row["tolerance_px"] in ("na", SHOWN_TOLERANCE))]
    head = ["scene, method", "wrong pixels", "hit twice", "worst displacement px", "rms px", "needed e only",
            "u rms texels", "v rms texels", "worst depth units"]
    return table(head, [[f"{row['scene']}, {tables.label(row)}", row["wrong_px"], row["double_hits"], short(row["disp_max_px"]),
                         short(row["disp_rms_px"]), f"{100 * row['within_e']:.1f} %", short(row["u_rms"]), short(row["v_rms"]),
                         short(row["depth_max_lsb"])] for row in own])


def auto_tables(auto, bits):
    counted = {}
    for row in auto:
        states = counted.setdefault((row["target"], row["method"], row["metric"]), [0, 0, 0])
        states[2 if row["cheapest_by_bound"] == "na" else row["state"] == "over"] += 1
    text = table(["target, cost profile, counted by", "as cheap", "dearer", "nothing promised (table under 6 bits)"],
                 [[f"{target}, {'generic' if method == tables.AUTO else 'its own'}, {metric}", str(ok), f"<td class='over'>{over}</td>" if over else "0", str(none)]
                  for (target, method, metric), (ok, over, none) in counted.items()])
    over = [row for row in auto if row["state"] == "over" and row["recip_bits"] == bits]
    lines = [[f"{row['target']}, {row['scene']}, {row['method']} {row['tolerance_px']}, {row['metric']}", f"{float(row['auto_per_px']):.1f}",
              row["cheapest_by_bound"], short(row["by_bound_per_px"], 4), percent(row["over_by_bound"]), row["cheapest_measured"],
              short(row["measured_per_px"], 4), percent(row["over_measured"])] for row in over]
    head = ["target, scene, tolerance, counted by", "auto", "cheapest by its bound", "costs", "auto dearer by", "cheapest that measures so",
            "costs", "auto dearer by"]
    return text + f"<details><summary>Dearer at {bits} bits: {len(over)}</summary>{table(head, lines)}</details>"


def percent(text):
    return text if text == "na" else f"{100 * float(text):.1f} %"


def image(name, alt, lazy=True):
    return f'<img src="{name}" alt="{html.escape(alt)}"' + (' loading="lazy"' if lazy else "") + ">"


def panels(scene, names, speed, error):
    figures = "".join(
        f"<figure><a href='charts/{name}.svg'>{image(f'charts/{name}.svg', f'{speed} against {error}, scene {scene}, {target}')}</a>"
        f"<figcaption>{TARGETS.get(target, target)} <a href='charts/{name}.png'>PNG</a></figcaption></figure>" for target, name in names.get((scene, speed, error), []))
    return f'<div class="grid">{figures}</div>'


def scene_section(scene, names, differing):
    pictures = "".join(f"<figure>{image(f'pictures/{scene}-{kind}.png', f'scene {scene}: {kind}')}<figcaption>{text}</figcaption></figure>"
                       for kind, text in PICTURES)
    off, pixels = differing[scene]
    parts = [f"<h3 id='scene-{scene}'>Scene {scene}</h3><p>{SCENES.get(scene, 'A sample scene.')} Automatic choice with a tolerance of "
             f"1/4 pixel: {off:,} of {pixels:,} pixels show another texel than the exact one.</p><div class='grid pictures'>{pictures}</div>",
             "<h4>Instructions against the worst displacement</h4>", panels(scene, names, "instr", "worst")]
    for speed, (_, speed_text) in charts.SPEEDS.items():
        for error, (_, error_text) in charts.ERRORS.items():
            if (speed, error) != ("instr", "worst"):
                parts.append(f"<details><summary>{speed_text} against {error_text}</summary>{panels(scene, names, speed, error)}</details>")
    return "\n".join(parts)


AXES = {
    "depth_ratio_less_1": "farthest over nearest z along 240 pixels, less 1",
    "far_horizon_near_over_z": "near/z of a wall whose far end is twice as far; beyond the line it has one depth value, its texture is still right",
    "sliver_height_px": "height of slivers across the screen", "tiny_triangle_side_px": "side of the cells of a net of triangles",
    "span_px": "length of a span along which 1/z falls to 60 %", "uv_range_texels": "texels from corner to corner",
    "guard_half_width_px": "half the width of a triangle that stands over the screen",
    "column_px": "height of a column along which 1/z falls to 60 %", "fan_spokes": "triangles of a fan around one point",
    "uv_offset_texels": "how far from 0 the texture coordinates are", "texture_side_texels": "texels along a texture's side, odd ones too",
    "grazing_degrees_nearest_level": "angle between a floor and the line of sight; mip levels by which the drawn one is off",
    "grazing_degrees_trilinear": "the same, two levels blended",
    "t_junction_edge_px": "length of an edge with another triangle's corner on its middle; holes and double hits of 4,000 such edges",
    "picture_side_px": "pixels across and down, drawn whole and in bands: they must agree",
    "coplanar_units_per_px": "slope in depth of a triangle drawn twice from other corners: pixels that the second one takes",
    "crossing_units_per_px": "depth units per pixel at which two walls cross: pixels that show the farther one",
    "floor_half_size_over_near": "size of a floor around the eye, over the near distance",
    "slerp_angle_rad": "angle between two rotation keys", "slerp_short_of_half_turn_rad": "what that angle lacks to half a turn",
    "slerp_key_length": "length of a key that is not normalised", "chain_length": "matrices in a chain",
    "chain_of_10_to_4_length": "matrices in a chain that each scale by 10,000",
    "sliver_width_px": "the same from top to bottom",
    "line_active_triangles": "triangles active on every row, drawn line by line with room for fewer: the same picture, slower",
    "line_memory_bytes": "bytes for 200 active triangles, line by line: set up once down to the first line, drawn down to the second",
    "link_reports_lost": "part of the display's reports that are lost; 27 to a key frame; what is shown is never torn",
    "near_plane_z_over_near": "z of a floor's near corners over the near distance: at the eye and behind it too",
}


def axis_text(axis):
    for start, text in (("uv_range_at_", "texels from corner to corner, with a reciprocal table of so many bits"),
                        ("depth16_", "depth units between two walls that far away: pixels of the nearer one that are lost")):
        if axis.startswith(start):
            return text
    return AXES[axis]


def charts_of(names):
    return "".join(f"<figure><a href='charts/{name}.svg'>{image(f'charts/{name}.svg', text)}</a><figcaption>{text} "
                   f"<a href='charts/{name}.png'>PNG</a></figcaption></figure>" for name, text in names)


def work_section(fitted, frames, names):
    lines = [[f"{row['target']}, per {row['unit']}", row["per_unit"], f"{int(row['constant']):,}", f"{row['from']:,} to {row['to']:,}",
              percent(row["worst_off"]), row["exponent"]] for row in fitted]
    worst = [[f"{row['target']}, {row['scene']}", str(row["frames"]), f"{int(row['mean_instructions']):,}", f"{int(row['worst_instructions']):,}",
              str(row["worst_frame"]), "na" if row["mean_cycles"] == "na" else f"{int(row['mean_cycles']):,}",
              "na" if row["worst_cycles"] == "na" else f"{int(row['worst_cycles']):,}", row["worst_over_mean"]] for row in frames]
    return f"""<p>One thing grows, the rest stays; automatic choice at 1/4 pixel. A straight line is laid through each sweep, with the least
relative squares: what one more costs, what is there without any, and how far the line is off at worst. The exponent is the slope on
logarithmic axes between the two largest steps: 1 is proportional, 0 free. Textures of more than 256 x 256 texels leave the fastest
loop, so the lines over texels end there; the chart shows the step. <a href="work.csv">work.csv</a>,
<a href="work_slopes.csv">work_slopes.csv</a></p>
{table(["instructions, target", "for one more", "at none", "from, to", "line off by", "exponent"], lines)}
<p>Frames of the sample scenes over one round of their animation, as <code>ew_scene_draw</code> draws them, with the materials as baked: a
display's rate hangs on the worst frame, not on the mean. <a href="frames.csv">frames.csv</a></p>
{table(["target, scene", "frames", "mean instructions", "worst", "frame", "mean cycles", "worst", "worst / mean"], worst)}
<div class="grid">{charts_of(names)}</div>"""


def memory_section(rows, names):
    shown = [row for row in memory.named(rows) if row["target"] == (MEMORY_TARGET if any(r[0] == MEMORY_TARGET for r in rows) else rows[0][0])]
    lines = [[f"{row['scene']}, {row['mode']}", f"{row['ram_bytes']:,}", "-" if row["goal_bytes"] == "na" else f"{row['goal_bytes']:,}",
              f"{row['instructions']:,}", f"{row['of_at_once']}", str(row["active"]), str(row["set_up_again"])] for row in shown]
    more = "".join(f"<details><summary>{text} against RAM</summary><div class='grid'>{charts_of(of_speed)}</div></details>"
                   for text, of_speed in list(zip(memory.SPEEDS.values(), names.values()))[:1] if names["cycles_typical"])
    return f"""<p>One picture of 320 x 240 pixels, drawn at once, in bands of 32, 16, 8 and 4 rows, and line by line: the same bit for bit; and by spans, without a depth buffer.
RAM is what it takes beside the scene and its objects, colour and depth buffers included; with less of it, triangles that reach over
several bands are kept or set up again. Automatic choice at 1/4 pixel; the clear is counted. Each line is a scene, its right end the
picture at once, its left end line by line. <a href="memory.csv">memory.csv</a></p>
<div class="grid">{charts_of(names["cycles_typical"] or names["instructions"])}</div>{more}
<details><summary>The figures of {shown[0]["target"]}</summary>{table(["scene, mode", "RAM, bytes", "goal", "instructions", "of at once",
 "active at most", "set up again"], lines)}</details>"""


MEMORY_TARGET = "m3"


def size_section(sizes, stacks, names):
    builds = list(dict.fromkeys(build for build, _ in sizes))
    lines = [[configuration] + [f"{sizes[build, configuration]:,} <span class='soft'>({stacks[build, configuration]:,})</span>" for build in builds]
             for configuration in dict.fromkeys(configuration for _, configuration in sizes)]
    return f"""<p>Bytes of code and tables as linked from a configuration's public functions, compiler helpers included, and in brackets
the deepest stack that any of them reaches, from the compiler's call graphs. The dashed line is the limit of 512 bytes.
<a href="size.csv">size.csv</a>, <a href="stack.csv">stack.csv</a></p>{table(["", *builds], lines)}<div class="grid">{charts_of(names)}</div>"""


MAPS = {
    "depth_ratio_and_run_length": "An affine run: its length, and how much farther away its far end is.",
    "recip_bits_and_uv_range": "The reciprocal table's size against the texels that a triangle spans.",
    "distance_and_separation": "Two walls, one before the other: how far apart 16-bit depth needs them to be.",
    "slerp_angle_and_key_bits": "Rotation keys: the angle between two, and their bits. Below the line keys cannot tell the angle from none.",
    "slerp_half_turn_and_key_bits": "Keys nearly half a turn apart: below the line rounding decides which way is the shorter.",
}


def worst_triangles(out):
    with open(os.path.join(out, "worst.txt"), encoding="utf-8") as f:
        found = f.read()
    lines = [[row.split('"')[1], row.rsplit("/*", 1)[1].strip(" */\n")] for row in found.splitlines() if row.startswith("{")]
    lines = [[way, f"<td class='over'>{used}</td>" if float(used) > 1 else used] for way, used in lines]
    return f"""<h3>The worst triangle for each method</h3><p>A seeded random search, climbing from the worst of some triangles to worse ones.
How much of its promise the worst fragment uses: up to 0 it lies within the disc of the tolerance, from there on it is the part of
e = 1/64 texel that is needed besides; above 1 the promise is broken. Depth: units off, of the 1 that is allowed.</p>
{table(["method", "uses"], lines)}<details><summary>The triangles, as rows of the list that a test replays</summary><pre>{html.escape(found)}</pre></details>"""


def stability(out):
    """The section on where methods fail, of stability.csv."""
    rows = atlas.read(os.path.join(out, "stability.csv"))
    lines = [[f"{axis}, {method}", f"{float(predicted):g}", "-" if measured is None else f"{measured:g}",
              verdict if verdict != "DISAGREES" else "<td class='over'>disagrees</td>"]
             for axis, method, predicted, measured, verdict in atlas.limits(rows) if verdict]
    figures = "".join(f"<figure><a href='charts/stability-{axis}.svg'>{image(f'charts/stability-{axis}.svg', axis)}</a><figcaption>"
                      f"{axis_text(axis)} <a href='charts/stability-{axis}.png'>PNG</a></figcaption></figure>"
                      for axis in dict.fromkeys(row["axis"] for row in rows))
    states = [row["state"] for row in rows]
    return f"""<p>Each axis is walked from safe to broken, under the address and undefined behaviour sanitizers and with a margin around
the picture that must stay as it is. {len(rows):,} steps: {states.count("ok"):,} ok, {states.count("degraded"):,} degraded (the error grew
beyond the promise, or beyond 1/4 pixel for the affine method and fixed runs), {states.count("refused"):,} refused with an error code. Filled marks are ok,
circles degraded, crosses refused; a dashed line is where a formula predicts the limit. <a href="stability.csv">stability.csv</a></p>
<p>Predicted limits beside measured ones; they agree within a factor of {atlas.FACTOR:g}:</p>
{table(["axis, method", "predicted", "measured", ""], lines)}
<div class="grid">{figures}</div>
<h3>Two at a time</h3><p>Each cell is measured; the black line is where the formula puts the limit. <a href="maps.csv">maps.csv</a></p>
<div class="grid">{charts_of([(f"map-{name}", text) for name, text in MAPS.items()])}</div>
{worst_triangles(out)}"""


HOW = """
<p>A <b>fragment</b> is a pixel of a triangle that is drawn, before the depth test. Clearing is not counted; transform, culling,
clipping and triangle set-up are, and in the sample scene the posing of its nodes.</p>
<ul>
<li><b>Instructions</b> are executed ones, counted, not timed: on the host by callgrind (libc left out), on Cortex-M and RISC-V by
a QEMU plugin that sees every block of instructions the emulated processor runs. Two runs give the same figures.</li>
<li><b>Cycles</b> are modelled: the same blocks, priced by published instruction timings with memory that answers at once. Flash wait
states, caches and DMA are not in them. <code>cycles.csv</code> has a low, a typical and a high figure for each; charts show the typical one.</li>
<li><b>Displacement</b> says how far from its pixel's centre, in pixels, the drawn texture coordinates belong: the distance to the line
on the screen where the exact attribute has the drawn value, u and v judged apart and the farther taken. Up to e = 1/64 texel is the
share of number formats and is removed first; pixels that need no more have displacement 0. No pixel is left out.</li>
<li>Coordinates come back modulo the texture's size, so an error of more than half a texture is seen as a smaller one: the affine
method's figures on the floors are too good.</li>
<li>The <b>referee</b> works in double precision from the written conventions and shares no code with the library. Accuracy is measured
once, on the host: each target's pictures carry the same hash over colour and depth as those that were judged, checked for every row.</li>
<li>Charts have logarithmic axes; what is below the axis stands at its left end. Methods without a tolerance are joined over the
sizes of the reciprocal table (4 to 9 bits), the others over tolerances 0 to 2 pixels at the default table.</li>
<li><b>Prototype</b> marks are this project's first throw-away version; <b>peers</b> are other rasterizers, built with the same
compilers and counted on the same scenes in 2026-11 (their floating point: hardware on m4). Both stand in
<code>tools/report/references.csv</code>.</li>
</ul>"""


def sources():
    return "<ul>" + "".join(f"<li><b>{target}</b>: {html.escape(text)}</li>" for target, text in model.SOURCES.items()) + "</ul>"


def check_images(out, text):
    for part in text.split('src="')[1:]:
        path = os.path.join(out, part.split('"', 1)[0])
        if not os.path.exists(path) or os.path.getsize(path) == 0:
            raise tables.Failed(f"{path}: the page shows it, and it is not there")


def write(out, rows, auto, names, differing, bits, worked, in_memory, aimed, versions):
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    text = f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>edgewalk: speed against accuracy</title><link rel="icon" href="data:,"><style>{STYLE}</style></head><body>
<h1>edgewalk: speed against accuracy</h1>
<p>edgewalk is a fixed-point 3D rasterizer for microcontrollers that is told how much error a scene can bear and does no more work
than that. This page shows what each way of drawing a texture costs on six processors, how far from the truth it is, and what a picture costs in <a href="#memory">less and less RAM</a>.</p>
<nav><a href="#cost">Cost</a> <a href="#aims">Aims</a> <a href="#accuracy">Accuracy</a> <a href="#auto">The automatic choice</a> <a href="#work">Cost against work</a>
<a href="#visibility">What hides what</a> <a href="#size">Flash and stack</a> <a href="#stability">Where methods fail</a>
{" ".join(f'<a href="#scene-{scene}">Scene {scene}</a>' for scene in scenes)} <a href="#how">How it was measured</a></nav>

{first_sight(scenes, names)}

<h2 id="cost">What a picture costs</h2>
<p>Executed instructions per fragment, and in brackets modelled cycles, of the automatic choice with a tolerance of 1/4 pixel and a
reciprocal table of {bits} bits (the default). 320 x 240 pixels, RGB565, 16-bit depth, nearest texel.</p>
{summary(rows, bits)}
<p class="soft">{"; ".join(f"{name}: {text}" for name, text in TARGETS.items())}. All rows:
<a href="speed_accuracy.csv">speed_accuracy.csv</a>, <a href="cycles.csv">cycles.csv</a>, with low and high cycles too.</p>
<p class="soft">Scenes: {" ".join(f'<a href="#scene-{scene}">{scene}</a>: {SCENES.get(scene, "a sample scene.")}' for scene in scenes)}</p>

<h2 id="aims">Aims</h2>
{aims.section(*aimed, table, charts_of)}

<h2 id="accuracy">How far from the truth</h2>
<p>Against the referee, the same on every target. Methods: one linear map over the whole triangle (affine) or over runs of 8, 16 or 32
pixels, runs as long as the bound allows (runs), a reciprocal for each pixel from the table (table) or refined (exact), and the automatic choice by the generic costs (auto) or by those
of the processor at hand (auto host and its like).</p>
{accuracy(rows, bits)}

<h2 id="auto">The automatic choice against the cheapest</h2>
<p>The automatic choice should cost no more than 5 % above the cheapest single method whose bound holds the tolerance for the
whole scene, and no more than 10 % above the cheapest that only turned out to keep it. It goes by a cost profile, data that says
what a run and a pixel cost: the generic one is the same everywhere, and each target has one of its own beside it. Counted over all scenes, tolerances and
table sizes; <a href="auto.csv">auto.csv</a> names both for every case.</p>
{auto_tables(auto, bits)}

<h2 id="memory">RAM against speed</h2>
{memory_section(*in_memory)}

<h2 id="work">Cost against work</h2>
{work_section(worked[0], worked[1], worked[4])}

<h2 id="visibility">What hides what</h2>
{visibility.section(out, table, charts_of)}

<h2 id="size">Flash and stack</h2>
{size_section(worked[2], worked[3], worked[5])}

<h2>Scenes</h2>
<p>The error maps' colours: grey is a pixel without a texture to judge.</p>
<div class="scale"></div><div class="scale-ends soft"><span>0</span><span>the scale's end, and beyond</span></div>
{"".join(scene_section(scene, names, differing) for scene in scenes)}

<h2 id="stability">Where methods fail</h2>
{stability(out)}

<h2 id="how">How it was measured, and how to repeat it</h2>
{HOW}
<p>Where the timings are from:</p>{sources()}
<p>Made with:</p><pre>{html.escape(chr(10).join(f"{target}: {text}" for target, text in versions.items()))}</pre>
<pre>make report            # this page, its tables and charts
make stability         # where methods fail
make worst             # the search for the worst triangles, longer
make goals             # what is aimed at against what is reached
make count             # the counts of the default table on a terminal
make check-counts      # fails where a count has grown by more than 1 %</pre>
</body></html>
"""
    check_images(out, text)
    with open(os.path.join(out, "index.html"), "w", encoding="utf-8") as f:
        f.write(text)
