#!/usr/bin/env python3
"""Holds instruction counts against stored ones.

usage: baseline.py check|update --build DIR --bits B --baseline FILE.csv TARGET ...

check: exit status 1 when a count has grown by more than 1 %, naming its line; fewer instructions
and cases that are new or gone are only said. Counts of a target whose compiler, assembler or
libraries have another version than the baseline's are compared, but only warned of.
update: writes the file anew.
"""
import csv
import os
import sys

import count

GROWTH = 0.01
PACKAGES = {  # what decides the instructions that a target executes, and who counts them
    "host": ["gcc", "binutils", "libc6-dev", "valgrind"],
    "m0plus": ["gcc-arm-none-eabi", "binutils-arm-none-eabi", "qemu-system-arm"],
    "rv32imc": ["gcc-riscv64-unknown-elf", "binutils-riscv64-unknown-elf", "qemu-system-misc"],
}
for core in ("m3", "m4", "m33"):
    PACKAGES[core] = PACKAGES["m0plus"]


def versions(target):
    """'compiler; package version; ...'; a package that is not installed stands there as 'none'."""
    compiler = "cc" if target == "host" else count.tools_prefix(target) + "gcc"
    words = [count.run([compiler, "--version"]).splitlines()[0]]
    for package in PACKAGES[target]:
        try:
            words.append(f"{package} {count.run(['dpkg-query', '-W', '-f', '${Version}', package])}")
        except (count.Failed, OSError):
            words.append(f"{package} none")
    return "; ".join(words)


def measure(args):
    """{target: versions}, {(target, scene, method, tolerance): instructions}"""
    cases, counts = count.list_cases(args.build), {}
    for target in args.targets:
        for case, c in zip(count.cases_of(target, cases), count.count(args.build, args.bits, target, cases)):
            counts[target, case.scene, case.method, case.tolerance] = c.instructions
    return {target: versions(target) for target in args.targets}, counts


def write(path, bits, made_with, counts):
    with open(path + ".new", "w", newline="", encoding="utf-8") as f:
        f.write("# Executed instructions, a picture each: make check-counts compares, make update-counts rewrites.\n"
                f"# reciprocal table: {bits} bits\n")
        for target, text in made_with.items():
            f.write(f"# {target}: {text}\n")
        out = csv.writer(f, lineterminator="\n")
        out.writerow(["target", "scene", "method", "tolerance_px", "instructions"])
        out.writerows([*key, n] for key, n in counts.items())
    os.replace(path + ".new", path)


def read(path):
    with open(path, encoding="utf-8") as f:
        lines = f.read().splitlines()
    made_with = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# ") and ": " in line)
    rows = list(csv.reader(line for line in lines if not line.startswith("#")))[1:]
    return made_with, {tuple(row[:4]): int(row[4]) for row in rows}


def compare(path, made_with, counts):
    """Prints what differs; the number of failures."""
    old_made_with, old = read(path)
    failures = changed = 0
    for target, text in made_with.items():
        if old_made_with.get(target) != text:
            print(f"warning: {target}: made with '{text}', the baseline with '{old_made_with.get(target, 'nothing')}': "
                  "growth only warns")
    for key, now in counts.items():
        line = " ".join(key)
        if key not in old:
            print(f"new: {line}: {now}")
            continue
        was = old[key]
        if was == now:
            continue
        changed += 1
        grown = now > was * (1 + GROWTH)
        binding = old_made_with.get(key[0]) == made_with[key[0]]
        word = "FAIL" if grown and binding else "warning" if grown else "changed"
        failures += word == "FAIL"
        print(f"{word}: {line}: {was} instructions, now {now} ({100 * (now / was - 1):+.2f} %)")
    for key in old:
        if key[0] in made_with and key not in counts:
            print(f"gone: {' '.join(key)}")
    print(f"{len(counts)} counts, {changed} changed, {failures} grown by more than {100 * GROWTH:g} %")
    return failures


def main():
    parser = count.arguments("Holds instruction counts against stored ones.")
    parser.add_argument("--baseline", required=True)
    if len(sys.argv) < 2 or sys.argv[1] not in ("check", "update"):
        parser.error("the first word is check or update")
    verb = sys.argv.pop(1)
    args = parser.parse_args()
    made_with, counts = measure(args)
    if verb == "update":
        write(args.baseline, args.bits, made_with, counts)
        print(f"{args.baseline}: {len(counts)} counts")
        return 0
    return 1 if compare(args.baseline, made_with, counts) else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (count.Failed, OSError, ValueError, IndexError) as e:
        print(f"baseline.py: {e}", file=sys.stderr)
        sys.exit(2)
