#!/usr/bin/env python3
"""Where the instructions of a picture go: those of the automatic choice by stages of the work.

usage: where.py --build DIR [--bits B] [--csv FILE] TARGET ...   (host, m0plus, m3, m4, m33, rv32imc)

An instruction belongs to the function whose symbol it lies behind, with all that was inlined there, and a
function to the stage that STAGES has for its source file. Of the functions that draw rows, pixel loops are a
stage of their own, but on the host.
"""
import csv
import re
import sys

import count

# Stage: what of. A function's stage is that of the first pattern that `source file:function` matches.
PURPOSES = {
    "scene": "poses, nodes and materials of a baked scene", "vertices": "transform and light of vertices",
    "culling": "corners, culling, clipping, range checks", "placing": "corners to the raster, and what is to be drawn of them",
    "set-up": "planes, the rung", "edges": "edges begun", "rows": "rows and runs", "pixels": "pixel loops; on the host part of rows",
    "products": "products, quotients and reciprocals that are called", "copies": "memory copied and set by calls"}
STAGES = [(re.compile(pattern), stage) for pattern, stage in [
    (r"(^|/)src/scene/|(^|/)tools/cycles/bench\.c:|(^|/)fixed/(matrix|quaternion|vector)\.c:", "scene"),
    (r"(^|/)src/raster/(raster|cost)\.c:", "scene"),
    (r"(^|/)src/geometry/(transform|light)\.c:", "vertices"),
    (r"(^|/)src/geometry/|(^|/)src/raster/triangle\.c:ew_raster_triangle_in_range", "culling"),
    (r"(^|/)src/raster/triangle\.c:", "placing"),
    (r"(^|/)src/raster/setup\.c:", "set-up"),
    (r"(^|/)src/raster/edge\.c:", "edges"),
    (r"(^|/)src/raster/(span|loops|fill|texture|target)\.c:", "rows"),
    (r"(^|/)fixed/(arithmetic|recip)\.c:", "products"),
    # of the compiler's library: products, quotients, shifts, leading zeros
    (r":[._]\w*(mul|div|mod|clz|lsl|lsr|asr|shl|shr)\w*$", "products"),
    (r":(memcpy|memset|memmove|__aeabi_mem(cpy|set|clr|move)[48]?)$", "copies")]]
AUTO, SHOWN = "auto", "0.25"
COLUMNS = ["target", "scene", "method", "tolerance", "stage", "instructions", "instr_per_px"]


def stage_of(file, function):
    for pattern, stage in STAGES:
        if pattern.search(f"{file}:{function}"):
            return stage
    raise count.Failed(f"{function} ({file or 'no source file'}): where.py has no stage for this function")


def stages(counted):
    """{stage: instructions} of a Count, which they add up to: all of PURPOSES, but pixels where they are not known."""
    found = dict.fromkeys(PURPOSES, 0)
    for place, n in counted.places.items():
        stage = stage_of(place.file, place.function)
        found["pixels" if stage == "rows" and place.in_pixels else stage] += n
    if sum(found.values()) != counted.instructions:
        raise count.Failed(f"stages add up to {sum(found.values())} instructions of {counted.instructions}")
    if any(place.in_pixels is None for place in counted.places):
        del found["pixels"]
    return found


def dearest(counted, n):
    """The n functions that most instructions are in: [(function, instructions)]."""
    found = {}
    for place, k in counted.places.items():
        found[place.function] = found.get(place.function, 0) + k
    return sorted(found.items(), key=lambda item: -item[1])[:n]


def rows_of(target, cases, counts):
    """Rows of where.csv for all pictures that the automatic choice drew; counts: those of the target's cases."""
    for case, counted in zip(count.cases_of(target, cases), counts):
        if case.method.startswith(AUTO):
            for stage, n in stages(counted).items():
                yield {**dict(zip(COLUMNS, (target, *case[:3], stage, n))), "instr_per_px": f"{n / case.fragments:.3f}",
                       "fragments": case.fragments}


def write(path, columns, rows):
    with open(path, "w", newline="", encoding="utf-8") as f:
        out = csv.DictWriter(f, columns, extrasaction="ignore", lineterminator="\n")
        out.writeheader()
        out.writerows(rows)


def shown(rows):
    """{(target, scene): {stage: instructions per fragment}} at 1/4 px, with the cost profile that is the same everywhere."""
    pictures = {}
    for row in rows:
        if row["method"] == AUTO and row["tolerance"] == SHOWN:
            pictures.setdefault((row["target"], row["scene"]), {})[row["stage"]] = row["instructions"] / row["fragments"]
    return pictures


def print_table(rows):
    print(f"{f'per fragment, {SHOWN} px':22s}" + "".join(f"{stage:>10s}" for stage in PURPOSES) + f"{'all':>10s}")
    for key, of in shown(rows).items():
        cells = [f"{of[stage]:.2f}" if stage in of else "-" for stage in PURPOSES]
        print(f"{' '.join(key):22s}" + "".join(f"{cell:>10s}" for cell in cells) + f"{sum(of.values()):10.2f}")
    for stage, purpose in PURPOSES.items():
        print(f"{stage}: {purpose}")


def main():
    parser = count.arguments("Attributes instructions to stages of the work.")
    parser.add_argument("--csv")
    args = parser.parse_args()
    cases, rows = count.list_cases(args.build), []
    for target in args.targets:
        rows += rows_of(target, cases, count.count(args.build, args.bits, target, cases))
    if args.csv:
        write(args.csv, COLUMNS, rows)
    print_table(rows)


if __name__ == "__main__":
    try:
        main()
    except (count.Failed, OSError) as e:
        sys.exit(f"where.py: {e}")
