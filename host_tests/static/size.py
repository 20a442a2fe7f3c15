#!/usr/bin/env python3
"""Sizes and stacks of the core, cross-built: what a firmware pays.

usage: size.py --build DIR [--base REVISION] [--report DIR]

Writes REPORT/size.csv (bytes of each configuration as linked from its public functions, and of each
object) and REPORT/stack.csv (the deepest calls from each public function), and prints the
configurations. `change` is against REVISION, or na where that cannot be had or is `none`.
"""
import argparse
import csv
import os
import subprocess
import sys

import cross


def measure(root, out):
    """({(target, level, kind, name): (text, data, bss, helpers)}, {(target, level, configuration, function): (bytes, chain)})"""
    sizes, stacks = {}, {}
    for target, (prefix, _) in cross.TARGETS.items():
        if cross.missing(target):
            continue
        for level in cross.LEVELS:
            for name, (headers, layers, defines) in cross.CONFIGURATIONS.items():
                objects = cross.build(target, level, layers, defines, out, root)
                roots = cross.public_functions(headers, root)
                sizes[target, level, "configuration", name] = cross.linked_size(target, objects, roots, out)
                graph = cross.Stacks(objects)
                for function in roots:
                    stacks[target, level, name, function] = graph.depth(function)
                for path in () if defines else objects:
                    sizes[target, level, "object", os.path.basename(path)] = (*cross.object_size(path, prefix), "na")
    return sizes, stacks


def checked_out(revision, out):
    """The sources of a revision in a folder of their own, or None with a word about why."""
    try:
        name = cross.run(["git", "rev-parse", "--short", revision], cwd=cross.ROOT, stderr=subprocess.PIPE).strip()
        folder = os.path.join(out, "base-" + name)
        if not os.path.isdir(folder):
            os.makedirs(folder + ".new", exist_ok=True)
            archive = subprocess.run(["git", "archive", revision, "include", "fixed", "src"], cwd=cross.ROOT, check=True,
                                     stdout=subprocess.PIPE, stderr=subprocess.PIPE).stdout
            subprocess.run(["tar", "-x", "-C", folder + ".new"], input=archive, check=True)
            os.rename(folder + ".new", folder)
        return folder
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"size.py: {revision}: no sources to compare with: {error}", file=sys.stderr)
        return None


def change(new, old):
    return "na" if old is None else f"{new - old:+d}"


def main():
    parser = argparse.ArgumentParser(description="Sizes and stacks of the core, cross-built.")
    parser.add_argument("--build", required=True)
    parser.add_argument("--base", default="HEAD")
    parser.add_argument("--report", default="build/report")
    args = parser.parse_args()
    for target in cross.TARGETS:
        if cross.missing(target):
            print(f"size.py: {target} left out: {cross.missing(target)}", file=sys.stderr)
    out = os.path.abspath(args.build)
    os.makedirs(args.report, exist_ok=True)
    sizes, stacks = measure(cross.ROOT, os.path.join(out, "now"))
    if not sizes:
        return 1
    folder, old_sizes, old_stacks = None if args.base == "none" else checked_out(args.base, out), {}, {}
    if folder:
        try:
            old_sizes, old_stacks = measure(folder, os.path.join(folder, "objects"))
        except (cross.StackError, subprocess.CalledProcessError) as error:
            print(f"size.py: {args.base}: cannot be measured: {error}", file=sys.stderr)

    with open(os.path.join(args.report, "size.csv"), "w", newline="", encoding="utf-8") as f:
        rows = csv.writer(f)
        rows.writerow(["target", "level", "kind", "name", "text", "data", "bss", "of_text_compiler_helpers", "change_text"])
        for key, size in sizes.items():
            rows.writerow([*key, *size, change(size[0], old_sizes[key][0] if key in old_sizes else None)])
    with open(os.path.join(args.report, "stack.csv"), "w", newline="", encoding="utf-8") as f:
        rows = csv.writer(f)
        rows.writerow(["target", "level", "configuration", "function", "bytes", "change", "deepest"])
        for key, (deep, chain) in sorted(stacks.items()):
            rows.writerow([*key, deep, change(deep, old_stacks[key][0] if key in old_stacks else None), " > ".join(chain)])

    print(f"{'bytes of text (compiler helpers, change)':44s}" + "".join(f"{t + l:>24s}" for t, l in dict.fromkeys(k[:2] for k in sizes)))
    for name in cross.CONFIGURATIONS:
        line = ""
        for key, size in sizes.items():
            if key[2:] == ("configuration", name):
                delta = change(size[0], old_sizes[key][0] if key in old_sizes else None)
                line += f"{f'{size[0]} ({size[3]}, {delta})':>24s}"
        print(f"{name:44s}{line}")
    (target, level, name, function), (deep, chain) = max(stacks.items(), key=lambda item: item[1][0])
    print(f"deepest stack: {deep} bytes, {function} ({name}) on {target} at {level}: {' > '.join(chain)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
