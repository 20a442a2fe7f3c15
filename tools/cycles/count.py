#!/usr/bin/env python3
"""Instructions per fragment of the standard scenes, counted: host by callgrind, Cortex-M by
QEMU with the plugin beside this file. Clearing is not counted; transform, culling and
set-up are.

usage: count.py --build DIR [--csv FILE] TARGET ...     (host, m0plus, m3, m4, m33)

Counts repeat exactly for the same compiler. They are instructions, not cycles.
"""
import argparse
import csv
import os
import re
import subprocess
import sys

BOARDS = {"m0plus": "mps2-an385", "m3": "mps2-an385", "m4": "mps2-an386", "m33": "mps2-an505"}


def run(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(f"count.py: {command[0]}: failed with status {done.returncode}: {done.stdout.strip()[-400:]}")
    return done.stdout


def count_host(build, cases):
    for i in range(len(cases)):
        out = os.path.join(build, "callgrind.out")
        run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", "--toggle-collect=bench_draw",
             os.path.join(build, "bench-host"), str(i)])
        with open(out, encoding="utf-8") as f:
            yield int(re.search(r"^(?:summary|totals): (\d+)", f.read(), re.M).group(1))


def count_board(build, target):
    image = os.path.join(build, f"bench-{target}.elf")
    names = {line.split()[2]: int(line.split()[0], 16)
             for line in run(["arm-none-eabi-nm", image]).splitlines() if len(line.split()) == 3}
    out = os.path.join(build, f"count-{target}.txt")
    run(["qemu-system-arm", "-M", BOARDS[target], "-display", "none", "-monitor", "none", "-serial", "none",
         "-semihosting-config", "enable=on,target=native", "-kernel", image, "-plugin",
         f"{os.path.join(build, 'count.so')},begin={names['bench_draw']:#x},end={names['bench_end']:#x},out={out}"])
    with open(out, encoding="utf-8") as f:
        return [int(line) for line in f]


def main():
    parser = argparse.ArgumentParser(description="Counts instructions per fragment.")
    parser.add_argument("--build", required=True)
    parser.add_argument("--csv")
    parser.add_argument("targets", nargs="+", choices=["host", *BOARDS])
    args = parser.parse_args()
    cases = [line.split(",") for line in run([os.path.join(args.build, "bench-host"), "--list"]).split()]
    rows = []
    for target in args.targets:
        counts = list(count_host(args.build, cases) if target == "host" else count_board(args.build, target))
        if len(counts) != len(cases):
            sys.exit(f"count.py: {target}: {len(counts)} counts for {len(cases)} cases")
        rows += [(target, *case, n) for case, n in zip(cases, counts)]
    if args.csv:
        with open(args.csv, "w", newline="", encoding="utf-8") as f:
            out = csv.writer(f)
            out.writerow(["target", "scene", "method", "tolerance_px", "fragments", "instructions", "instr_per_px"])
            out.writerows([*row, f"{row[5] / int(row[4]):.2f}"] for row in rows)
    scenes = sorted({row[1] for row in rows})
    print(f"{'instructions per fragment':28s}" + "".join(f"{scene:>8s}" for scene in scenes))
    for target in args.targets:
        for method, tolerance in dict.fromkeys((row[2], row[3]) for row in rows):
            line = {row[1]: row[5] / int(row[4]) for row in rows if row[0] == target and row[2:4] == (method, tolerance)}
            name = f"{target} {method}" + (f" {tolerance} px" if method == "auto" else "")
            print(f"{name:28s}" + "".join(f"{line[scene]:8.1f}" for scene in scenes))


if __name__ == "__main__":
    main()
