"""The report's tables: what was counted and what was judged, put together."""
import csv
import math
import os

import count

COLUMNS = ("target scene method tolerance_px recip_bits instr_per_px cycles_per_px wrong_px double_hits disp_max_px "
           "disp_rms_px u_max u_rms v_max v_rms depth_max_lsb depth_rms_lsb notes").split()
JUDGED = "wrong_px double_hits disp_max_px disp_rms_px u_max u_rms v_max v_rms depth_max_lsb depth_rms_lsb".split()
AUTO = "auto"  # methods whose name begins so choose their rung; the others are single rungs
SNAP = 1 / 256  # px by which the disc of the promise is wider than the tolerance: docs/error-bound.md
WITHIN_BOUND, WITHIN_MEASURED = 1.05, 1.10
LEAST_PROMISED = 6  # bits of the reciprocal table: docs/error-bound.md


class Failed(Exception):
    pass


def is_auto(row):
    return row["method"].startswith(AUTO)


def number(text):
    return math.nan if text == "na" else float(text)


def speed_accuracy(bits, judged, cases, counts):
    """Rows of one size of the table: `judged` of the host holds on each target, because the pictures
    are the same bit for bit, which is checked here. counts: {target: [Count]}."""
    rows, methods, by_case = [], {j["method"] for j in judged}, {(j["scene"], j["method"], j["tolerance_px"]): j for j in judged}
    several = {case.method for case in cases if case.tolerance != "0"}
    for target, of_target in counts.items():
        for case, counted in zip(count.cases_of(target, cases), of_target):
            j = by_case.get(case[:3])
            name = f"{target}, {bits} bits, scene {case.scene}, {case.method} {case.tolerance}"
            if case.method not in methods:
                continue  # fills and ways to save memory, which are counted only
            if j is None:
                raise Failed(f"{name}: was not judged")
            if counted.picture != j["picture"]:
                raise Failed(f"{name}: picture {counted.picture}, but {j['picture']} was judged on the host")
            row = {"target": target, "scene": case.scene, "method": case.method, "recip_bits": bits,
                   "instr_per_px": f"{counted.instructions / case.fragments:.3f}", "tolerance_px": case.tolerance,
                   "cycles_per_px": "na", "notes": []}
            row.update((column, j[column]) for column in JUDGED)
            if case.method not in several:
                row["tolerance_px"] = "na"
                row["notes"].append("tolerance: the method takes none")
            if counted.cycles:
                row["cycles_per_px"] = f"{counted.cycles[1] / case.fragments:.3f}"
            else:
                row["notes"].append("cycles: no timing table for the host's processor")
            for column in JUDGED:
                if not math.isfinite(float(row[column])):
                    row[column] = "na"
                    row["notes"].append(f"{column}: the value drawn occurs nowhere on the triangle's plane")
            row["beyond"] = beyond(j)
            if row["beyond"]:
                row["notes"].append(f"the worst displacement is beyond the bound, {j['bound_px']} px")
            row["notes"] = "; ".join(row["notes"])
            row.update(bound_px=float(j["bound_px"]), counted=counted, fragments=case.fragments,
                       within_e=int(j["within_e"]) / max(1, int(j["textured"])))
            rows.append(row)
    return rows


def beyond(judged):
    """Whether a picture's displacement is more than is promised of it."""
    return not number(judged["disp_max_px"]) <= float(judged["bound_px"]) + SNAP


def write(path, columns, rows):
    with open(path + ".new", "w", newline="", encoding="utf-8") as f:
        out = csv.DictWriter(f, columns, extrasaction="ignore", lineterminator="\n")
        out.writeheader()
        for row in rows:
            empty = [c for c in columns if row[c] == "" and c != "notes"]
            if empty:
                raise Failed(f"{path}: empty cell in column {empty[0]}: {row}")
            out.writerow(row)
    os.replace(path + ".new", path)


def cycle_rows(rows):
    for row in rows:
        if row["counted"].cycles:
            low, typical, high = (f"{c / row['fragments']:.3f}" for c in row["counted"].cycles)
            yield {**row, "cycles_low": low, "cycles_typical": typical, "cycles_high": high}


CYCLE_COLUMNS = "target scene method tolerance_px recip_bits cycles_low cycles_typical cycles_high".split()

# ---- auto against the cheapest ----

AUTO_COLUMNS = ("target scene method tolerance_px recip_bits metric auto_per_px cheapest_by_bound by_bound_per_px "
                "over_by_bound cheapest_measured measured_per_px over_measured state notes").split()


def label(row):
    return row["method"] if row["tolerance_px"] == "na" else f"{row['method']} {row['tolerance_px']}"


def cheapest(rows, metric, fits):
    return min((row for row in rows if fits(row)), key=lambda row: float(row[metric]), default=None)


def auto_row(auto, rungs, metric):
    tolerance = float(auto["tolerance_px"])
    own, notes = float(auto[metric]), []
    out = {key: auto[key] for key in ("target", "scene", "method", "tolerance_px", "recip_bits")}
    out.update(metric=metric.split("_")[0], auto_per_px=auto[metric])
    over = False
    for what, column, limit, fits in (
            ("by_bound", "cheapest_by_bound", WITHIN_BOUND, lambda row: row["bound_px"] <= tolerance),
            ("measured", "cheapest_measured", WITHIN_MEASURED, lambda row: number(row["disp_max_px"]) <= tolerance + SNAP)):
        best = cheapest(rungs, metric, fits)
        if best is None:
            out.update({column: "na", f"{what}_per_px": "na", f"over_{what}": "na"})
            notes.append(f"{what}: no rung's bound holds" if what == "by_bound" else f"{what}: no rung measures so")
            continue
        ratio = own / float(best[metric])
        out.update({column: label(best), f"{what}_per_px": best[metric], f"over_{what}": f"{ratio - 1:.4f}"})
        over = over or ratio > limit
    if over and auto["recip_bits"] < LEAST_PROMISED:
        notes.append("nothing is promised with so small a table: auto does not rely on it where it happens to do")
        over = False
    out.update(state="over" if over else "ok", notes="; ".join(notes))
    return out


def auto_rows(rows):
    """For each picture that auto drew, and instructions and cycles each: what the cheapest single rung
    for the whole scene would have cost. `over_...` is by how much auto is dearer, as a fraction."""
    groups = {}
    for row in rows:
        groups.setdefault((row["target"], row["scene"], row["recip_bits"]), []).append(row)
    for group in groups.values():
        rungs = [row for row in group if not is_auto(row)]
        for auto in filter(is_auto, group):
            for metric in ("instr_per_px", "cycles_per_px"):
                if auto[metric] != "na":
                    yield auto_row(auto, rungs, metric)
