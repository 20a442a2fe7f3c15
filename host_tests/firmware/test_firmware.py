"""The firmware examples on emulated boards, and the same bits on every machine.

Writes build/report/hashes.csv (every hash of every target) and firmware.csv (what each
program takes of flash, RAM and stack), and prints both in short."""
import csv
import os
import re
import subprocess
import sys
import tempfile
import unittest

import board
from board import MACHINES, ROOT, count

sys.path.insert(0, os.path.join(ROOT, "host_tests", "cli"))
from png import png_pixels  # noqa: E402 - found by the line above

BIN = os.path.join(ROOT, os.environ.get("EW_BIN", "build/release/bin"))
REPORT = os.path.join(ROOT, "build", "report")
REFERENCE = "host-gcc-O2"
LITTLE, MIDDLE, FULL = "microbit", "lm3s6965evb", [t for t in MACHINES if t not in ("microbit", "lm3s6965evb", "avr")]

hashes = {}  # (target, scene, method, tolerance, size): hash
figures = []  # dictionaries with the columns below
COLUMNS = ["program", "target", "flash_bytes", "ram_bytes", "stack_bytes", "frame_instructions", "frame_cycles_low",
           "frame_cycles_typical", "frame_cycles_high"]


def need(test, program, target):
    reason = board.missing(program, target)
    if reason:
        (test.fail if os.environ.get("FIRMWARE_REQUIRE") else test.skipTest)(reason)


def run(test, program, target):
    """Runs, notes flash, RAM, stack and counts, and returns the other lines."""
    need(test, program, target)
    ran = board.Ran(program, target)
    note(test, program, target, ran)
    return [line for line in ran.lines if line != "end" and not line.startswith("stack ")]


def note(test, program, target, ran):
    if target.startswith("host"):
        return
    stack = [int(line.split()[1]) for line in ran.lines if line.startswith("stack ")]
    flash, ram = board.sizes(program, target)
    test.assertEqual(len(stack), 1)
    test.assertTrue(0 < stack[0] < 1024 * MACHINES[target].ram - ram, stack)
    instructions, cycles = max(ran.counted, key=lambda frame: frame[0], default=("na", None))
    used = (flash, ram, stack[0], cycles[1] if cycles else 0)
    for amount, limit in zip(used, LIMITS.get((program, target), ())):
        test.assertLessEqual(amount, limit, "more than docs/porting.md says")
    figures.append(dict(zip(COLUMNS, (program, target, flash, ram, stack[0], instructions, *(cycles or ["na"] * 3))),
                        seconds=ran.seconds))


def stated():
    """The table of docs/porting.md: (program, target) to bytes of flash, RAM and stack, and cycles."""
    limits = {}
    with open(os.path.join(ROOT, "docs", "porting.md"), encoding="utf-8") as page:
        for line in page:
            cells = [cell.strip() for cell in line.strip("| \n").split("|")]
            if len(cells) == 7 and cells[0].startswith("`"):
                most = [float(cell.split()[0]) * {"KB": 1024, "M": 1e6}[cell.split()[1]] for cell in cells[3:]]
                for target in re.findall(r"`(\w+)`", cells[1]):
                    limits[cells[0].strip("`"), target] = most
    return limits


LIMITS = stated()


def same_bits(test, target):
    """Of same_bits on a target: case to hash, and (scene, mode) to a picture's memory."""
    found, memory = {}, {}
    for line in run(test, "same_bits", target):
        kind, *case, value = line.split()
        if kind == "memory":
            scene, mode, size, *rest = *case, value
            memory[scene, mode] = count.Memory(int(size), 0, *map(int, rest))
            continue
        test.assertEqual(kind, "hash", line)
        test.assertNotIn(tuple(case), found)
        found[tuple(case)] = value
    return found, memory


def expected_cases(target, reference):
    """What a target has room for: host_tests/firmware/same_bits.h."""
    if target in FULL:
        return set(reference)
    if target == MIDDLE:
        return {case for case in reference if case[3] != "320x240"}
    if target == LITTLE:
        return {case for case in reference if case[3] != "320x240" and case[0] != "B" and case[1] != "spans"}
    return {case for case in reference if case[0] in ("fixed", "triangles", "hud")}


class SameBits(unittest.TestCase):
    """One hash of colour and depth for each case, the same on every machine."""

    @classmethod
    def setUpClass(cls):
        cls.reference, _ = same_bits(cls("test_the_cases_differ"), REFERENCE)

    def test_the_cases_differ(self):
        """A picture that was not drawn would have its neighbour's hash."""
        for size in ("64x48", "320x240"):
            affine = {v for case, v in self.reference.items() if case[1:] == ("affine", "0", size)}
            self.assertEqual(len(affine), 7 if size == "64x48" else 6)
        drawn = {self.reference["D", method, t, "320x240"] for method, t in (
            ("affine", "0"), ("exact", "0"), ("auto", "16"))}
        self.assertEqual(len(drawn), 3)

    def hold(self, target):
        found, memory = same_bits(self, target)
        for case, value in found.items():
            hashes[(target, *case)] = value
        self.assertEqual(set(found), expected_cases(target, self.reference))
        self.assertEqual({c: v for c, v in found.items() if self.reference[c] != v}, {})
        if target in FULL and not target.startswith("host"):
            self.hold_memory(memory)

    def hold_memory(self, memory):
        """320 x 240, RGB565, textured, with depth: what a picture takes beside the scene, with each triangle set up once."""
        references = count.list_references(os.path.dirname(board.COUNT))
        self.assertEqual({case for case in memory if case[1] in ("bands-8", "line")},
                         {(scene, mode) for scene in "ABCDE" for mode in ("bands-8", "line")})
        for (scene, mode), m in memory.items():
            with self.subTest(scene=scene, mode=mode):
                goal = count.goal_bytes(mode, m, references[scene])
                if goal != "na":
                    self.assertLessEqual(m.bytes, goal)
                self.assertEqual(m.again, 0)
                self.assertLessEqual(m.transformed, 2 * m.vertices)


class Hash(unittest.TestCase):
    """The `hash` and `lines` examples: baked scenes, four frames each."""

    def hold(self, target):
        for program, scene, size in (("hash", "courtyard", "320x240"), ("hash64x48", "crate", "64x48"),
                                     ("lines", "crate", "320x240")):
            if program == "hash" and target not in FULL:
                continue
            lines, wanted = run(self, program, target), run(self, program, REFERENCE)
            self.assertEqual(len(set(wanted)), 4)
            for line in lines:
                hashes[(target, scene, "frame " + line.split()[1], "-", size)] = line.split()[2]
            self.assertEqual(lines, wanted)


for _target in MACHINES:
    setattr(SameBits, "test_" + _target.replace("-", "_"), lambda self, t=_target: self.hold(t))
    if _target != "avr":
        setattr(Hash, "test_" + _target.replace("-", "_"), lambda self, t=_target: self.hold(t))


MACHINES["m3_hot"] = MACHINES["m3"]  # one program only


class InRam(unittest.TestCase):
    """EW_HOT: the code of rows and pixels in RAM, called from flash far away."""

    def test_the_picture_is_the_same(self):
        need(self, "hash64x48", "m3_hot")
        ran = board.Ran("hash64x48", "m3_hot")
        self.assertEqual([line for line in ran.lines if line.startswith("frame ")], run(self, "hash64x48", REFERENCE))
        frames = board.Frames("hash64x48", "m3_hot", "")
        inside, outside = frames.addresses("ew_rows_of_texture", "runs_of_texture", "ew_recip_entries"), frames.addresses("ew_setup", "main")
        self.assertGreaterEqual(min(inside), 0x20000000)
        self.assertLess(max(outside), 0x400000)


def host_pictures(scene, size, frames, fps):
    """What ew-render makes of the scene that is linked into the firmware: rows of RGB bytes."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([os.path.join(BIN, "ew-render"), os.path.join(board.IMAGES, scene), "--size", size, "--frames",
                        str(frames), "--fps", str(fps), "-o", os.path.join(folder, "f.png")],
                       check=True, stdout=subprocess.DEVNULL)
        pictures = [png_pixels(os.path.join(folder, f"f-{i:04}.png"))[1] for i in range(frames)]
    return pictures


def rgb565(pixels):
    """Channels of 5, 6 and 5 bits: what QEMU and ew-render each widen to 8 in a way of their own."""
    return bytes(value >> (2 if i % 3 == 1 else 3) for i, value in enumerate(pixels))


def grey4(red, green, blue, x, y):
    """A pixel of EW_TARGET_GREY4 with dither, from channels of 5, 6 and 5 bits: docs/fills.md."""
    grey = (77 * (132 * red + red // 8) + 150 * 65 * green + 29 * (132 * blue + blue // 8)) // 256
    threshold = 0
    for bit in range(3):  # of x and y, the lowest counts most
        across, down = x >> bit & 1, y >> bit & 1
        threshold += (2 * (across ^ down) + down) << (4 - 2 * bit)
    return (grey - grey // 16 + 4 * threshold) // 256


class Oled(unittest.TestCase):
    """The SSD0323 of lm3s6965evb: QEMU shows each pixel as 4x4 and grey n as 17 n."""

    FRAMES = 20

    def play(self, program):
        need(self, program, "lm3s6965evb")
        return board.Shown(program, "lm3s6965evb")

    def differing(self, shown):
        """Pixels of all screendumps that are not the host's."""
        self.assertEqual(len(shown.frames), self.FRAMES)
        total, greys = 0, set()
        for (width, height, pixels), rows in zip(shown.frames, host_pictures("crate.ewb", "128x64", self.FRAMES, 10)):
            self.assertEqual((width, height), (512, 256))
            wanted = b""
            for y, row in enumerate(rows):
                channels = rgb565(row)
                levels = [grey4(*channels[3 * x:3 * x + 3], x, y) for x in range(len(channels) // 3)]
                greys.update(levels)
                wanted += b"".join(bytes([17 * level]) * 12 for level in levels) * 4
            total += sum(pixels[i:i + 3] != wanted[i:i + 3] for i in range(0, len(wanted), 3))
        self.assertGreaterEqual(len(greys), 10)
        return total

    def test_every_frame_is_the_hosts(self):
        shown = self.play("oled")
        self.assertEqual((shown.status, self.differing(shown)), (0, 0))
        self.assertNotIn("ssd0323", shown.errors)
        self.assertEqual(len({frame[2] for frame in shown.frames}), self.FRAMES)
        note(self, "oled", "lm3s6965evb", shown)

    def test_without_the_dc_line_it_is_noticed(self):
        shown = self.play("oled_no_dc")
        self.assertGreater(self.differing(shown), 1000)
        self.assertIn("ssd0323: error", shown.errors)  # pixels taken for commands

    def test_a_wrong_window_is_noticed(self):
        shown = self.play("oled_window")
        self.assertGreater(self.differing(shown), 1000)


class Stated(unittest.TestCase):
    """What docs/porting.md says of sizes; `note` holds each program that runs to it."""

    def test_every_example_has_its_line(self):
        self.assertEqual(set(LIMITS), {("hash64x48", "microbit"), ("lines", "microbit"), ("oled", "lm3s6965evb"), ("rgb565", "rv32imc"),
                                       *(("hash", target) for target in ("m3", "m4", "m7", "m33", "m55"))})

    def test_the_microbit_fits(self):
        for program in ("hash64x48", "lines"):
            flash, ram, stack, _ = LIMITS[program, "microbit"]
            self.assertLessEqual(flash, 64 * 1024)
            self.assertLessEqual(ram + stack, 16 * 1024)


class Rgb565(unittest.TestCase):
    """A linear frame buffer on RV32IMC."""

    def test_every_frame_is_the_hosts(self):
        need(self, "rgb565", "rv32imc")
        shown = board.Shown("rgb565", "rv32imc")
        self.assertEqual((shown.status, len(shown.frames)), (0, 4))
        for frame, rows in zip(shown.frames, host_pictures("courtyard.ewb", "320x240", 4, 4)):
            self.assertEqual(frame[:2], (320, 240))
            shows, wanted = rgb565(frame[2]), rgb565(b"".join(rows))
            self.assertEqual(sum(a != b for a, b in zip(shows, wanted)), 0)
        self.assertEqual(len({frame[2] for frame in shown.frames}), 4)
        note(self, "rgb565", "rv32imc", shown)


def write_csv(name, head, rows):
    os.makedirs(REPORT, exist_ok=True)
    with open(os.path.join(REPORT, name), "w", newline="", encoding="utf-8") as f:
        csv.writer(f).writerows([head, *rows])


def tearDownModule():
    def cell(text):
        return "na" if text == "-" else text

    write_csv("hashes.csv", ["target", "scene", "method", "tolerance_px", "size", "hash"],
              [(t, scene, method, cell(tol) if tol == "-" else f"{int(tol) / 16:g}", cell(size), value)
               for (t, scene, method, tol, size), value in hashes.items()])
    write_csv("firmware.csv", COLUMNS, [[row[name] for name in COLUMNS] for row in figures])
    reference = {key[1:]: value for key, value in hashes.items() if key[0] == REFERENCE}
    print(f"{'target':34s}{'hashes':>8s}{'equal':>8s}")
    for target in MACHINES:
        mine = {key[1:]: value for key, value in hashes.items() if key[0] == target}
        equal = sum(reference.get(case) == value for case, value in mine.items())
        if mine:
            print(f"{MACHINES[target].name:34s}{len(mine):8d}{equal:8d}")
    line = "{:11}{:31}{:>8}{:>8}{:>7}{:>14}{:>12}{:>6}"
    print(line.format("program", "on", "flash", "RAM", "stack", "instructions", "cycles", "s"))
    for row in figures:
        print(line.format(row["program"], MACHINES[row["target"]].name, row["flash_bytes"], row["ram_bytes"],
                          row["stack_bytes"], row["frame_instructions"], row["frame_cycles_typical"],
                          f"{row['seconds']:.1f}"))
    print("bytes; instructions and modelled cycles (typical) of the longest frame; seconds of emulation")


if __name__ == "__main__":
    unittest.main()
