#!/usr/bin/env python3
"""Instructions, and modelled cycles, per fragment of the scenes of a bench: host by callgrind,
Cortex-M and RISC-V by QEMU with the plugin beside this file. Clearing is not counted;
transform, culling and set-up are, and posing of a baked scene's nodes.

usage: count.py --build DIR [--bits B] [--csv FILE] TARGET ...   (host, m0plus, m3, m4, m33, rv32imc)

Counts repeat exactly for the same compiler. Host counts leave libc out and have no cycles.
"""
import argparse
import bisect
import csv
import functools
import glob
import os
import re
import subprocess
import sys
from collections import namedtuple

import model
import pixels

ARM = ["qemu-system-arm", "-M"]
RISCV = ["qemu-system-riscv32", "-M", "virt", "-m", "32M", "-bios", "none"]
EMULATORS = {"m0plus": [*ARM, "mps2-an385"], "m3": [*ARM, "mps2-an385"], "m4": [*ARM, "mps2-an386"],
             "m33": [*ARM, "mps2-an505"], "rv32imc": RISCV}
TARGETS = ["host", *EMULATORS]
DEFAULT_BITS = 8
# The cost profile that is drawn beside the generic one: tools/cycles/dir.mk builds it in
PROFILES = {"host": "host", "m0plus": "m0plus", "m3": "m3", "m4": "m3", "m33": "m3"}

# One picture: what was drawn and by which method (tolerance in px, a string), the fragments of the scene.
Case = namedtuple("Case", "scene method tolerance fragments")
# What was counted of it: instructions, (low, typical, high) cycles or None, the picture's hash, and of
# pictures in bands a Memory; and {Place: instructions}.
Count = namedtuple("Count", "instructions cycles picture memory places")
# Where an instruction lies: in a function of the linker's, whatever is inlined there, with its source file or ''; and
# whether in a pixel loop (pixels.py), None on the host.
Place = namedtuple("Place", "file function in_pixels")
Memory = namedtuple("Memory", "bytes objects_bytes active set_up again transformed triangles vertices")
MODES = {"at-once": 240, "bands-32": 32, "bands-16": 16, "bands-8": 8, "bands-4": 4, "line": 1, "spans": 1}  # rows of a band


class Failed(Exception):
    pass


def run(command, stderr=subprocess.PIPE):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=stderr, text=True, stdin=subprocess.DEVNULL, check=False)
    if done.returncode != 0:
        raise Failed(f"{command[0]}: failed with status {done.returncode}: {(done.stderr or done.stdout).strip()[-400:]}")
    return done.stdout


def tools_prefix(target):
    return "riscv64-unknown-elf-" if target == "rv32imc" else "arm-none-eabi-"


def list_cases(build):
    lines = run([os.path.join(build, "list"), "--list"]).splitlines()
    return [Case(scene, method, tolerance, int(n)) for scene, method, tolerance, n in (line.split(",") for line in lines)]


def list_references(build):
    """{scene: in how many bands of 8 rows there is something of a triangle, over all triangles}"""
    lines = run([os.path.join(build, "list"), "--references"]).splitlines()
    return {scene: int(n) for scene, n in (line.split(",") for line in lines)}


def printed(text):
    """(hash, Memory or None) of each picture that an image prints."""
    lines = re.findall(r"^([0-9a-f]{8})\n(?:memory((?: \d+)+)\n)?", text, re.M)
    return [(picture, Memory(*map(int, figures.split())) if figures else None) for picture, figures in lines]


def cases_of(target, cases):
    """Those that the target's image draws: of the cost profiles only its own."""
    return [case for case in cases if not case.method.startswith("auto ") or case.method == f"auto {PROFILES.get(target)}"]


def text_symbols(nm, image):
    """[(address, source file or '', function)] by address."""
    found = []
    for line in run([nm, "-n", "-l", image]).splitlines():
        symbol, _, place = line.partition("\t")
        words = symbol.split()
        if len(words) == 3 and words[1] in "tTwW":
            found.append((int(words[0], 16), place.rpartition(":")[0], words[2]))
    return found


# ---- host ----

def outside_libc(path):
    """{(source file, function): instructions} of a callgrind file, without libc's: cost lines by what they stand under."""
    found, skip, names, here = {}, False, {}, {"fl": ""}
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            named = re.match(r"(c?)(ob|fl|fi|fe|fn)=\((\d+)\)(?: (.*))?", line)
            if named:
                called, kind, number, name = named.groups()
                kind = "fl" if kind in ("fi", "fe") else kind  # the files share their numbers
                if name:
                    names[kind, number] = name
                if not called:
                    here[kind] = names[kind, number]
                if line.startswith("fn="):  # what is inlined from other files belongs to it, too
                    function = here["fl"], here["fn"]
            elif line.startswith("calls="):
                skip = True  # the next line repeats what the called function costs
            elif re.match(r"[+\-*\d]", line):
                if not skip and "libc.so" not in here["ob"]:
                    found[function] = found.get(function, 0) + int(line.split()[1])
                skip = False
    return found


def in_their_files(functions, symbols):
    """{Place: instructions}, by the files that functions are defined in: callgrind goes by their first line, which may
    be inlined from elsewhere."""
    files, found = {}, {}
    for _, file, name in symbols:
        files.setdefault(name, set()).add(file)
    for (file, name), n in functions.items():
        known = files.get(name, {file})
        place = Place(next(iter(known)) if len(known) == 1 else file, name, None)
        found[place] = found.get(place, 0) + n
    return found


def count_host(image):
    out = image + ".callgrind"
    for old in glob.glob(out + ".*"):
        os.unlink(old)
    pictures = printed(run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", "--toggle-collect=bench_draw",
                            "--dump-after=bench_draw", image]))
    dumps = sorted(glob.glob(out + ".*"), key=lambda name: int(name.rsplit(".", 1)[1]))
    counts, symbols = [], text_symbols("nm", image)
    for dump, picture in zip(dumps, pictures):
        places = in_their_files(outside_libc(dump), symbols)
        counts.append(Count(sum(places.values()), None, *picture, places))
    for dump in [*dumps, out]:
        if os.path.exists(dump):
            os.unlink(dump)
    return counts


# ---- emulated cores ----

def regions(path):
    """Of each region: instructions, blocks, edges."""
    found = []
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            kind, *rest = line.split()
            if kind == "R":
                found.append((int(rest[0]), {}, {}))
            else:
                key = tuple(int(a, 16) for a in rest[:-1])
                found[-1][1 if kind == "B" else 2][key] = int(rest[-1])
    return found


class Places:
    """The Place of every instruction of an image."""

    def __init__(self, symbols, code):
        self.code, self.symbols, self.starts = code, symbols, [address for address, _, _ in symbols]
        self.addresses = sorted(code)
        self.block = functools.lru_cache(None)(self._block)
        self.pixel_loops = functools.lru_cache(None)(self._pixel_loops)

    def _pixel_loops(self, number):
        """Addresses in the pixel loops of a function."""
        ends = [bisect.bisect_left(self.addresses, start) for start in [*self.starts, self.addresses[-1] + 1][number:number + 2]]
        return pixels.of_function([self.code[at] for at in self.addresses[slice(*ends)]])[0]

    def _block(self, first, last):
        """{Place: instructions} of a block."""
        found, at = {}, first
        while at <= last:
            number = bisect.bisect_right(self.starts, at) - 1
            place = Place(*self.symbols[number][1:], at in self.pixel_loops(number))
            found[place] = found.get(place, 0) + 1
            at += self.code[at].size
        return found

    def of(self, blocks):
        """The same of a region; blocks: {(first, last): times}."""
        found = {}
        for key, times in blocks.items():
            for place, n in self.block(*key).items():
                found[place] = found.get(place, 0) + n * times
        return found


def count_emulated(image, target, plugin):
    out = image + ".regions"
    symbols = dict(reversed(line.split()[::2]) for line in run([tools_prefix(target) + "nm", image]).splitlines()
                   if len(line.split()) == 3)
    begin, end = (int(symbols[name], 16) for name in ("bench_draw", "bench_end"))
    # semihosting writes to stderr
    done = subprocess.run([*EMULATORS[target], "-display", "none", "-monitor", "none", "-serial", "none",
                           "-semihosting-config", "enable=on,target=native", "-kernel", image, "-plugin",
                           f"{plugin},begin={begin:#x},end={end:#x},edges=1,out={out}"],
                          stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True, check=False)
    if done.returncode != 0:
        raise Failed(f"{EMULATORS[target][0]}: {image}: status {done.returncode}: {done.stderr.strip()[-400:]}")
    cycles = model.Model(target, tools_prefix(target) + "objdump", image)
    places = Places(text_symbols(tools_prefix(target) + "nm", image), cycles.code)
    counts = [Count(n, cycles.cycles(blocks, edges), *picture, places.of(blocks))
              for (n, blocks, edges), picture in zip(regions(out), printed(done.stderr))]
    os.unlink(out)
    return counts


def count_image(build, name, target):
    """A Count for each region from bench_draw to bench_end of an image."""
    image = os.path.join(build, name)
    return count_host(image) if target == "host" else count_emulated(image, target, os.path.join(build, "count.so"))


def count(build, bits, target, cases):
    """A Count for each of the target's cases."""
    cases = cases_of(target, cases)
    counts = count_image(build, os.path.join(str(bits), f"bench-{target}"), target)
    if len(counts) != len(cases):
        raise Failed(f"{target}: {len(counts)} counts for {len(cases)} cases")
    return counts


# ---- memory ----

MEMORY_COLUMNS = ["target", "scene", "mode", "rows", "ram_bytes", "goal_bytes", "objects_bytes", "instructions", "of_at_once",
                  "cycles_typical", "active", "set_up", "set_up_again", "transformed", "triangles", "vertices", "notes"]


def goal_bytes(mode, m, references):
    """What a 320 x 240 picture in RGB565 with depth may take beside the scene."""
    if mode == "line":
        return 4096 + 112 * m.active + 4 * m.triangles + 2 * m.vertices
    return 12288 + 16 * m.vertices + 4 * references if mode == "bands-8" else "na"


def memory_rows(cases, counts, references):
    """RAM against instructions of every picture in bands; counts: {target: [Count]}, references: of list_references."""
    rows = []
    for target, of_target in counts.items():
        at_once = {case.scene: c.instructions for case, c in zip(cases_of(target, cases), of_target) if case.method == "at-once"}
        for case, c in zip(cases_of(target, cases), of_target):
            if case.method not in MODES:
                continue
            m, goal, notes = c.memory, goal_bytes(case.method, c.memory, references[case.scene]), []
            if goal == "na":
                notes.append("goal: none for this mode")
            if not c.cycles:
                notes.append("cycles: no timing table for the host's processor")
            rows.append([target, case.scene, case.method, MODES[case.method], m.bytes, goal, m.objects_bytes, c.instructions,
                         f"{c.instructions / at_once[case.scene]:.3f}", c.cycles[1] if c.cycles else "na", m.active, m.set_up,
                         m.again, m.transformed, m.triangles, m.vertices, "; ".join(notes)])
    return rows


def write_memory(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as f:
        out = csv.writer(f)
        out.writerow(MEMORY_COLUMNS)
        out.writerows(rows)


# ---- command line ----

def print_table(cases, counts):
    scenes = list(dict.fromkeys(case.scene for case in cases))
    print(f"{'per fragment':28s}" + "".join(f"{scene:>16s}" for scene in scenes))
    for target, of_target in counts.items():
        rows = {}
        for case, c in zip(cases_of(target, cases), of_target):
            text = f"{c.instructions / case.fragments:.1f}"
            if c.cycles:
                text += f" ({c.cycles[1] / case.fragments:.1f})"
            rows.setdefault((case.method, case.tolerance), {})[case.scene] = text
        several = {method for method, tolerance in rows if tolerance != "0"}
        for (method, tolerance), row in rows.items():
            name = f"{target} {method}" + (f" {tolerance} px" if method in several else "")
            print(f"{name:28s}" + "".join(f"{row.get(scene, ''):>16s}" for scene in scenes))
    print("instructions, and in brackets modelled cycles (typical)")


def arguments(description):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--build", required=True, help="folder of the images")
    parser.add_argument("--bits", type=int, default=DEFAULT_BITS, help="size of the reciprocal table, log2")
    parser.add_argument("targets", nargs="+", choices=TARGETS)
    return parser


def main():
    parser = arguments("Counts instructions and models cycles per fragment.")
    parser.add_argument("--csv")
    parser.add_argument("--memory", help="CSV file: RAM against instructions of pictures in bands")
    args = parser.parse_args()
    cases = list_cases(args.build)
    counts = {target: count(args.build, args.bits, target, cases) for target in args.targets}
    if args.csv:
        with open(args.csv, "w", newline="", encoding="utf-8") as f:
            out = csv.writer(f)
            out.writerow(["target", "scene", "method", "tolerance_px", "fragments", "instructions", "cycles_low",
                          "cycles_typical", "cycles_high"])
            for target, of_target in counts.items():
                for case, c in zip(cases_of(target, cases), of_target):
                    out.writerow([target, *case, c.instructions, *(c.cycles or ["na"] * 3)])
    if args.memory:
        write_memory(args.memory, memory_rows(cases, counts, list_references(args.build)))
    print_table(cases, counts)


if __name__ == "__main__":
    try:
        main()
    except (Failed, OSError) as e:
        sys.exit(f"count.py: {e}")
