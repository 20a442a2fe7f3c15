"""A fault put into the span code, one wrong rounding, must turn up in the data that the report's charts are
drawn from, and fail a test. Faults are put into a copy of the core below build/."""
import csv
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools" / "cycles"), str(ROOT / "tools" / "report")]

import tables  # noqa: E402

BUILD = ROOT / "build" / "faults"
JUDGE = """tools/report/judge.c host_tests/accuracy/measure.c host_tests/accuracy/scene_measure.c host_tests/accuracy/standard_measure.c
host_tests/reference/referee.c host_tests/reference/scenes.c tools/common/image.c tools/common/player.c tools/common/whole_file.c""".split()
WORST = """host_tests/property/test_worst.c host_tests/property/worst.c host_tests/property/promise.c host_tests/property/triangles.c
host_tests/property/cases.c host_tests/unit/unit.c host_tests/reference/exact.c host_tests/reference/referee.c""".split()

# The reciprocal of the exact rung, of 31 bits, rounded down to 11: on the floors u and v are off by 1/8 of a texel; the
# small triangles of scene B span too few texels for that to show. And nothing changed, which the rest is compared with.
FAULTS = {"sound": (r"(?!)", ""), "rounded": (r"\bew_recip_newton\(", "0xFFF00000u & ew_recip_newton(")}


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.programs = {name: cls.build(name, *fault) for name, fault in FAULTS.items()}

    @staticmethod
    def build(name, pattern, replacement):
        """(judge, test_worst) with the core's span code changed."""
        folder = BUILD / name.replace(" ", "-")
        shutil.rmtree(folder, ignore_errors=True)
        for part in ("include", "fixed", "src"):
            shutil.copytree(ROOT / part, folder / part)
        span = folder / "src" / "raster" / "span.c"
        text, found = re.subn(pattern, replacement, span.read_text(encoding="utf-8"))
        if replacement and not found:
            raise AssertionError(f"{name}: src/raster/span.c has no {pattern}: the fault must be put elsewhere")
        span.write_text(text, encoding="utf-8")
        core = [str(path) for layer in ("fixed", "src/raster", "src/geometry", "src/scene") for path in sorted((folder / layer).glob("*.c"))]
        programs = []
        for program, sources, libraries in (("judge", JUDGE, ["-lpng", "-lz"]), ("test_worst", WORST, ["-lcmocka"])):
            out = folder / program
            subprocess.run([os.environ.get("CC", "cc"), "-std=gnu11", "-O1", "-DEW_TRACE=1", f"-I{folder / 'include'}", "-I.", "-o", str(out), *sources,
                            *core, *libraries, "-lm"], cwd=ROOT, check=True)
            programs.append(str(out))
        return programs

    def judged(self, name):
        done = subprocess.run([self.programs[name][0], "--method", "exact"], stdout=subprocess.PIPE, text=True, check=True)
        return list(csv.DictReader(done.stdout.splitlines()))

    def test_turns_up_in_the_charts_data(self):
        sound, faulty = self.judged("sound"), self.judged("rounded")
        self.assertEqual([row["scene"] for row in sound if tables.beyond(row)], [])
        self.assertEqual([row["scene"] for row in faulty if tables.beyond(row)], ["A", "C", "D", "E"])
        for before, after in zip(sound, faulty):
            self.assertNotEqual(before["picture"], after["picture"])

    def test_fails_a_test(self):
        for name, status in (("sound", 0), ("rounded", 1)):
            done = subprocess.run([self.programs[name][1]], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
            self.assertEqual(done.returncode, status, done.stdout)


if __name__ == "__main__":
    unittest.main()
