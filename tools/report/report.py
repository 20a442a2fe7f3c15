#!/usr/bin/env python3
"""Writes the report: tables, charts, pictures and a page that shows them.

usage: report.py --build DIR --out DIR --goals GOALS.csv --bits "4 5 ..." --scenes "NAME=FILE.ewb ..." TARGET ...

DIR of the build holds, for each size of the reciprocal table, the images that tools/cycles counts
and the program that judges them. Two jobs run side by side.
"""
import argparse
import concurrent.futures
import csv
import os
import sys
import time

import aims
import atlas
import baseline
import charts
import count
import goals
import memory
import page
import tables
import visibility
import where
import work


class Progress:
    """One line on a terminal; nothing elsewhere."""

    def __init__(self, steps):
        self.steps, self.done, self.began = steps, 0, time.monotonic()

    def say(self, what):
        if sys.stderr.isatty():
            print(f"\r\033[K[{self.done}/{self.steps}] {time.monotonic() - self.began:.0f} s: {what}", end="", file=sys.stderr, flush=True)

    def step(self, what):
        self.done += 1
        self.say(what)

    def end(self):
        if sys.stderr.isatty():
            print(file=sys.stderr)


def judge(build, bits, scenes):
    return list(csv.DictReader(count.run([os.path.join(build, str(bits), "judge"), *scenes]).splitlines()))


def measure(args, default, progress):
    """Rows of speed_accuracy for every size of the table, {size: what was judged}, rows of memory for the first, rows of work,
    and of where.csv and goals.csv for the default."""
    cases, references, rows, judged, modes = count.list_cases(args.build), count.list_references(args.build), [], {}, []
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        names, jobs = {}, {}
        for bits in args.bits:
            jobs[bits, "judged"] = pool.submit(judge, args.build, bits, args.scenes)
            for target in args.targets:
                jobs[bits, target] = pool.submit(count.count, args.build, bits, target, cases)
        for target in work.targets_of(args.targets):
            jobs["work", target] = pool.submit(work.count_target, args.build, target)
        names = {job: key for key, job in jobs.items()}
        try:
            for job in concurrent.futures.as_completed(names):
                job.result()
                progress.step(" ".join(map(str, names[job])))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
        for bits in args.bits:
            counts = {target: jobs[bits, target].result() for target in args.targets}
            judged[bits] = jobs[bits, "judged"].result()
            rows += tables.speed_accuracy(bits, judged[bits], cases, counts)
            modes = modes or count.memory_rows(cases, counts, references)
            if bits == default:
                stages = [row for target, of in counts.items() for row in where.rows_of(target, cases, of)]
                aimed = list(goals.rows_of(args.goals, cases, counts, goals.read_sizes(os.path.join(args.out, "size.csv"))))
    worked = work.rows_of(args.build, {target: jobs["work", target].result() for target in work.targets_of(args.targets)})
    return rows, judged, modes, worked, stages, aimed


def draw_pictures(args, bits):
    """{scene: (differing, pixels)}"""
    folder = os.path.join(args.out, "pictures")
    os.makedirs(folder, exist_ok=True)
    lines = count.run([os.path.join(args.build, str(bits), "judge"), "--pictures", folder, *args.scenes]).split()
    return {scene: (int(differing), int(pixels)) for scene, differing, pixels in (line.split(",") for line in lines)}


def main():
    parser = argparse.ArgumentParser(description="Writes the report.")
    parser.add_argument("--build", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--bits", required=True, type=lambda text: [int(b) for b in text.split()])
    parser.add_argument("--goals", required=True)
    parser.add_argument("--scenes", required=True, type=str.split)
    parser.add_argument("targets", nargs="+", choices=count.TARGETS)
    args = parser.parse_args()
    default = count.DEFAULT_BITS if count.DEFAULT_BITS in args.bits else args.bits[-1]
    progress = Progress(len(args.bits) * (len(args.targets) + 1) + len(work.targets_of(args.targets)) + 2)
    goals.read(args.goals)  # what is wrong with it is said before the images run
    rows, judged, modes, worked, stages, aimed = measure(args, default, progress)
    auto = list(tables.auto_rows(rows))
    tables.write(os.path.join(args.out, "speed_accuracy.csv"), tables.COLUMNS, rows)
    tables.write(os.path.join(args.out, "cycles.csv"), tables.CYCLE_COLUMNS, tables.cycle_rows(rows))
    count.write_memory(os.path.join(args.out, "memory.csv"), modes)
    tables.write(os.path.join(args.out, "auto.csv"), tables.AUTO_COLUMNS, auto)
    tables.write(os.path.join(args.out, "where.csv"), where.COLUMNS, stages)
    tables.write(os.path.join(args.out, "goals.csv"), goals.COLUMNS, aimed)
    fitted, frames, sizes = list(work.fits(worked)), list(work.frames(worked)), work.read_sizes(args.out)
    tables.write(os.path.join(args.out, "work.csv"), work.COLUMNS, worked)
    tables.write(os.path.join(args.out, "work_slopes.csv"), work.FIT_COLUMNS, fitted)
    tables.write(os.path.join(args.out, "frames.csv"), work.FRAME_COLUMNS, frames)
    here = os.path.dirname(os.path.abspath(__file__))
    names = charts.draw(os.path.join(args.out, "charts"), rows, os.path.join(here, "references.csv"), default, progress.say)
    visibility.measure(args.build, args.out, args.targets)
    work_names = work.draw(os.path.join(args.out, "charts"), worked, *sizes)
    memory_names = memory.draw(os.path.join(args.out, "charts"), modes)
    aim_names = aims.draw(os.path.join(args.out, "charts"), stages)
    progress.step("pictures")
    differing = draw_pictures(args, default)
    page.write(args.out, rows, auto, names, differing, default, (fitted, frames, *sizes, *work_names), (modes, memory_names),
               (aimed, aim_names), {target: baseline.versions(target) for target in args.targets})
    progress.step("page")
    progress.end()
    say(args.out, rows, judged, auto, aimed)


def say(out, rows, judged, auto, aimed):
    """What was promised and is not so, a line each, and a summary."""
    over = [row for row in auto if row["state"] == "over"]
    for bits, of_size in judged.items():
        for j in filter(tables.beyond, of_size):
            print(f"report: beyond its bound: table of {bits} bits, scene {j['scene']}, {j['method']} {j['tolerance_px']}: "
                  f"{j['disp_max_px']} px, bound {j['bound_px']} px")
    for row in over:
        print(f"report: auto is dearer: {row['target']}, table of {row['recip_bits']} bits, scene {row['scene']}, {row['method']} "
              f"{row['tolerance_px']}: {row['auto_per_px']} {row['metric']}; {row['cheapest_by_bound']} {row['by_bound_per_px']} "
              f"(by bound, {row['over_by_bound']}), {row['cheapest_measured']} {row['measured_per_px']} (measured, {row['over_measured']})")
    for name in dict.fromkeys(row["method"] for row in auto):
        own = [row for row in auto if row["method"] == name]
        print(f"report: {name}: {sum(row['state'] == 'ok' for row in own)} of {len(own)} as cheap as the cheapest rung, within 5 % of "
              "what the bound allows and 10 % of what measures so")
    states = [row["state"] for row in aimed]
    print(f"report: aims: {states.count('met')} met, {states.count('missed')} missed: {out}/goals.csv")
    print(f"report: {out}/index.html; {len(rows)} rows of speed_accuracy.csv")


if __name__ == "__main__":
    try:
        main()
    except (atlas.Failed, count.Failed, tables.Failed, OSError) as e:
        sys.exit(f"report.py: {e}")
