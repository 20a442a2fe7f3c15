#!/usr/bin/env python3
"""Proves that parts of the raster core and the display's device end have no undefined behaviour, with Frama-C's Eva.

usage: prove.py [--build DIR] [--tests DIR] [--jobs N] [PART ...]

Prints a table: part, width of int, alarms, exceptions, share of the statements reached, seconds. Fails on an
alarm, on an assertion that neither Eva nor a lemma (lemmas.py) proves, on an exception that is no longer
needed, and on a planted fault that is not found. docs/proofs.md says what all of it means.
"""
import argparse
import concurrent.futures
import os
import re
import subprocess
import sys
import time

import lemmas

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
LIMIT_SECONDS = 900  # for one run

MACHINES = {16: "x86_16", 32: "gcc_x86_32"}  # by the bits of int; both have 32-bit long
CONTEXT = "src/raster/raster.c src/raster/loops.c src/raster/target.c src/raster/texture.c src/raster/cost.c fixed/recip.c"

# Functions that are taken at their word where int has 16 bits, by the lemma that proves it.
PROMISES = {"product_of_pieces": "ew_mul_s32_pieces,ew_mul_u32_pieces"}
PRODUCTS = ["product_of_pieces"]


class Part:
    """`driver` calls what is proved with unknown inputs, from its function `prove_NAME`."""

    def __init__(self, name, driver, sources, ints=(16, 32), precision=2, exceptions=(), promises=(),
                 options=()):
        self.name, self.driver, self.sources, self.ints = name, driver, sources.split(), ints
        self.precision, self.exceptions, self.options = precision, set(exceptions), list(options)
        self.promises = set(promises)


def span_part(name, taken, options=()):
    """Of src/raster/span.c, which the driver holds: with the functions `taken` at their word, which other parts prove."""
    return Part(name, "prove_span.c", "fixed/recip.c", ints=(32,), precision=0,
                options=["-eva-split-limit", "300", "-eva-auto-loop-unroll", "4",
                         "-eva-use-spec", "ew_run_near,ew_run_after,ew_run_first" + taken, *options])


SPANS = [
    span_part("span", ",piece_of_texture,piece_of_any", ["-eva-min-loop-unroll", "3"]),
    span_part("span_pieces", ",runs_of_texture,pixels_of_texture",
              ["-eva-slevel-function", "runs_of_texture:30,pixels_of_texture:30"]),
    span_part("span_runs", ""),
    span_part("span_pixels", ""),
    span_part("span_any", ""),
]

PARTS = [
    Part("display", "prove_display.c", "src/display/crc.c src/display/hid_display.c", precision=1),
    Part("entry", "prove_entry.c", CONTEXT + " src/raster/span.c"),
    Part("triangle", "prove_triangle.c", "src/raster/triangle.c src/raster/edge.c fixed/arithmetic.c",
         exceptions=["row_in_edge", "between_corners"], promises=PRODUCTS),
    Part("setup", "prove_setup.c", "src/raster/setup.c fixed/recip.c",
         exceptions=["narrow_basis", "within_bits"], promises=PRODUCTS),
    Part("pixels", "prove_pixels.c", "src/raster/fill.c " + CONTEXT, ints=(32,), precision=0,
         options=["-eva-auto-loop-unroll", "32", "-eva-min-loop-unroll", "3"]),
    # the drivers hold run.h, span.c and texture.c
    Part("runs", "prove_runs.c", "", ints=(32,), precision=0, options=["-eva-split-limit", "300"]),
    *SPANS,
    Part("loops", "prove_loops.c", "src/raster/loops.c src/raster/target.c", ints=(32,), precision=0,
         options=["-eva-auto-loop-unroll", "16", "-eva-min-loop-unroll", "11"]),
    Part("texture", "prove_texture.c", "src/raster/target.c", ints=(32,), precision=0,
         exceptions=["remainder_of_period"],
         options=["-eva-interprocedural-splits", "-eva-slevel-function",
                  "axis_start:100,within_period:10,axis_of:40,find_level:20,ew_texture_start:20"]),
    Part("draw2d", "prove_draw2d.c", "src/raster/draw2d.c src/raster/fill.c " + CONTEXT, ints=(32,), precision=0,
         options=["-eva-auto-loop-unroll", "32", "-eva-min-loop-unroll", "9", "-eva-slevel-function",
                  "ew_draw_sprite:40,ew_draw_rect:40,draw_glyph:40"]),
    # with 16 bits ew_q16_16_mul's sum of 2^62 and a half is not proved
    Part("fixed", "prove_fixed.c", "fixed/arithmetic.c fixed/recip.c", ints=(32,)),
]

# One-argument functions over all of their arguments: tests that `make test` runs, too.
EXHAUSTIVE = ["test_recip", "test_fixed"]

# Faults that have to be found: part, int, file, what stands there, what is put in its place.
PLANTS = [
    ("overflow", "triangle", 32, "src/raster/triangle.c", "corners->steps = bottom - top + right - left;",
     "corners->steps = (bottom - top) * (right - left);"),
    ("unchecked corner", "triangle", 32, "src/raster/triangle.c", "v->x >= -guard && v->x <= guard && ", "v->x >= -guard && "),
    ("division by zero", "entry", 32, "src/raster/raster.c", "if (range <= 0 ||", "if (range < 0 ||"),
    ("out of bounds", "display", 32, "src/display/hid_display.c", "length > EW_STREAM_PAYLOAD_BYTES ||",
     "length > EW_STREAM_PAYLOAD_BYTES + 1 ||"),
    ("endless run", "runs", 32, "src/raster/run.h", "    if (n > limit->longest) n = limit->longest;\n", ""),
    ("run too long", "span_runs", 32, "src/raster/span.c", "        m = smaller(m, span->left);\n        //@ split m;\n        if (t->rung",
     "        m = smaller(m, span->left + 1);\n        //@ split m;\n        if (t->rung"),
    ("loop too long", "loops", 32, "src/raster/loops.c", "*const end = z + n;", "*const end = z + n + 1;"),
    ("texel out of bounds", "texture", 32, "src/raster/texture.c", "    if (i == a->period) i = 0;\n", ""),
    ("pixel out of bounds", "draw2d", 32, "src/raster/draw2d.c", "x1 = smaller(x + width, s->x1)", "x1 = smaller(x + width, s->x1 + 1)"),
]


class Result:
    def __init__(self, text, seconds):
        self.seconds = seconds
        summary = re.search(r"^\s*(\d+) alarms? generated by the analysis", text, re.M)
        reached = re.search(r"statements reached \(out of \d+\): (\d+)% coverage", " ".join(text.split()))
        self.ended = summary is not None
        self.alarms = int(summary.group(1)) if summary else 0
        self.reached = int(reached.group(1)) if reached else 0
        self.unproved = set()
        self.where = []
        # a function that is neither there nor promised would be taken to do anything that Eva sees fit
        self.unknown = sorted(set(re.findall(r"Neither code nor specification for\s+function\s+(\w+)", text)))
        for place, what in re.findall(r"^\[eva:alarm\] ([^\n]*?): (?:Warning:)?\s*((?:\n?  .*)+)", text, re.M):
            what = " ".join(what.split())
            claim = re.search(r"(?:assertion|precondition|postcondition|invariant) '?(\w+)'?.*"
                              r" got status (?:unknown|invalid)", what)
            if claim:
                self.unproved.add(claim.group(1))
            else:
                self.where.append(f"{place}: {what}")


def analyse(part, bits, root, log, define=""):
    """Eva over one part, its sources taken from `root`; there, too, or drivers would include those of here."""
    command = ["frama-c", "-machdep", MACHINES[bits],
               f"-cpp-extra-args=-U__GNUC__ -DEW_PORTABLE {define} -include {HERE}/copy.h -I{root}/include -I{HERE} -I{root}",
               os.path.join(HERE, part.driver), *(os.path.join(root, s) for s in part.sources),
               "-eva", "-eva-no-print", "-main", f"prove_{part.name}", "-eva-precision", str(part.precision),
               "-eva-split-return", "full", *part.options]
    if bits == 16:
        for promise in part.promises:
            command += ["-eva-use-spec", PROMISES[promise]]
    start = time.time()
    try:
        done = subprocess.run(command, cwd=root, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=LIMIT_SECONDS, text=True, errors="replace")
        text = done.stdout
    except subprocess.TimeoutExpired as late:
        text = (late.stdout or b"").decode(errors="replace") + f"\nstopped after {LIMIT_SECONDS} s\n"
    with open(log, "w", encoding="utf-8") as f:
        f.write(text)
    return Result(text, time.time() - start)


def planted_tree(build, name, path, old, new):
    """A copy of the sources with one fault in it."""
    tree = os.path.join(build, "planted", name.replace(" ", "-"))
    subprocess.run(["rm", "-rf", tree], check=True)
    for folder in ("include", "src", "fixed"):
        os.makedirs(tree, exist_ok=True)
        subprocess.run(["cp", "-r", os.path.join(ROOT, folder), tree], check=True)
    target = os.path.join(tree, path)
    with open(target, encoding="utf-8") as f:
        text = f.read()
    if text.count(old) != 1:
        return None
    with open(target, "w", encoding="utf-8") as f:
        f.write(text.replace(old, new))
    return tree


class Report:
    def __init__(self):
        self.problems = []

    def problem(self, text):
        self.problems.append(text)

    def row(self, part, bits, result):
        taken = sorted(result.unproved & part.exceptions)
        print(f"{part.name:<12} {bits:>3} {result.alarms:>7} {len(taken):>10} {result.reached:>7}% {result.seconds:>8.0f}  "
              f"{', '.join(taken)}", flush=True)
        name = f"{part.name} ({bits}-bit int)"
        if not result.ended:
            self.problem(f"{name}: the analysis did not end")
        for function in result.unknown:
            self.problem(f"{name}: {function}: its source is not among the part's")
        for alarm in result.where[:10]:
            self.problem(f"{name}: {alarm}")
        if result.alarms and not result.where:
            self.problem(f"{name}: {result.alarms} alarms")
        for label in sorted(result.unproved - part.exceptions):
            self.problem(f"{name}: assertion {label} is not proved")
        if result.ended:
            for label in sorted(part.exceptions - result.unproved):
                self.problem(f"{name}: exception {label} is no longer needed: take it off the list")

    def planted(self, name, path, part, result):
        claims = sorted(result.unproved - part.exceptions)
        found = result.where[0] if result.where else ", ".join(claims)
        print(f"planted      {name} in {path}: {'found: ' + found if found else 'NOT FOUND'}", flush=True)
        if not found:
            self.problem(f"planted {name}: not found")


def close(label):
    """Proves the lemma of an exception or a promise: what is wrong, and seconds."""
    start = time.time()
    wrong = lemmas.prove(label) if label in lemmas.LEMMAS else f"there is no lemma {label}"
    return wrong, time.time() - start


def exhaust(folder, test):
    """Whether a test passes, and seconds."""
    start = time.time()
    done = subprocess.run([os.path.join(folder, test)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return done.returncode == 0, time.time() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--build", default=os.path.join(ROOT, "build", "prove"))
    parser.add_argument("--tests", default=os.path.join(ROOT, "build", "release", "tests"),
                        help="where the exhaustive tests are")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("parts", nargs="*", metavar="PART",
                        help="only these parts, without exhaustive tests and plants")
    options = parser.parse_args()
    by_name = {part.name: part for part in PARTS}
    unknown = [name for name in options.parts if name not in by_name]
    if unknown:
        print(f"prove: {unknown[0]}: no such part: {' '.join(by_name)}", file=sys.stderr)
        return 2
    options.build = os.path.abspath(options.build)
    os.makedirs(options.build, exist_ok=True)
    chosen = [by_name[name] for name in options.parts] or PARTS
    needed = sorted(set().union(*(part.exceptions for part in chosen)))
    promised = sorted(set().union(*(part.promises for part in chosen)))
    start, report = time.time(), Report()
    print(f"{'part':<12} {'int':>3} {'alarms':>7} {'exceptions':>10} {'reached':>8} {'seconds':>8}")
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        longest_first = sorted(chosen, key=lambda part: part.name not in ("setup", "texture", "draw2d", "triangle", "span", "span_pieces"))
        runs = []
        for part, bits in ((part, bits) for part in longest_first for bits in part.ints):
            log = os.path.join(options.build, f"{part.name}-{bits}.log")
            runs.append((part, bits, pool.submit(analyse, part, bits, ROOT, log)))
        found = []
        for name, part, bits, path, old, new in [] if options.parts else PLANTS:
            tree = planted_tree(options.build, name, path, old, new)
            if tree is None:
                report.problem(f"planted {name}: {path}: what it replaces does not stand there once")
                continue
            log = os.path.join(options.build, f"planted-{name.replace(' ', '-')}.log")
            found.append((name, path, by_name[part], pool.submit(analyse, by_name[part], bits, tree, log, "-DEW_PROVE_SHORT")))
        tests = [(test, pool.submit(exhaust, options.tests, test)) for test in ([] if options.parts else EXHAUSTIVE)]
        proofs = [(label, pool.submit(close, label)) for label in needed + promised]
        for part, bits, run in runs:
            report.row(part, bits, run.result())
        for name, path, part, run in found:
            report.planted(name, path, part, run.result())
        for label, proof in proofs:
            wrong, seconds = proof.result()
            print(f"lemma        {label}: {wrong or 'proved'}, {seconds:.0f} s", flush=True)
            if wrong:
                report.problem(wrong)
        for test, run in tests:
            passed, seconds = run.result()
            print(f"exhaustive   {test}: {'passed' if passed else 'FAILED'}, {seconds:.0f} s", flush=True)
            if not passed:
                report.problem(f"{test} failed")
    for text in report.problems:
        print(f"prove: {text}", file=sys.stderr)
    print(f"prove: {'FAILED' if report.problems else 'proved'}, {len(needed)} exceptions, {len(promised)} promises, {time.time() - start:.0f} s")
    return 1 if report.problems else 0


if __name__ == "__main__":
    sys.exit(main())
