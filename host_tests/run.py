#!/usr/bin/env python3
"""Runs test programs and adds up what they say.

usage: run.py [--verbose] PROGRAM|FILE.py ...

A program is a cmocka group: it is asked for TAP. A .py file is a unittest module. The
output of a test that failed is shown, and so is the reason of every skip. The last line
is `N passed, N failed, N skipped`; the exit status is 1 when a test failed or when none
ran.
"""
import os
import re
import subprocess
import sys
import time
import unittest

LIMIT_SECONDS = 900  # for one program


class Tally:
    def __init__(self):
        self.passed = self.failed = self.skipped = 0

    def fail(self, name, output):
        self.failed += 1
        print(f"FAIL {name}")
        for line in output.splitlines()[-40:]:
            print(f"     {line}")

    def skip(self, name, reason):
        self.skipped += 1
        print(f"skip {name}: {reason}")


def run_cmocka(program, tally):
    """TAP of cmocka 1.1: `ok N - name`, `not ok N - name`, `not ok N # SKIP name`; what a
    test printed stands before its line, and what an assertion said behind it."""
    environment = dict(os.environ, CMOCKA_MESSAGE_OUTPUT="TAP")
    try:
        done = subprocess.run([program], env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=LIMIT_SECONDS, text=True, errors="replace")
        text, status = done.stdout, done.returncode
    except subprocess.TimeoutExpired as late:
        text, status = (late.stdout or b"").decode(errors="replace"), "time-out"
    base, before, ran, failed = os.path.basename(program), [], 0, 0
    planned = re.search(r"^1\.\.(\d+)", text, re.M)
    lines = text.splitlines()
    for number, line in enumerate(lines):
        verdict = re.match(r"(not ok|ok) \d+(?: - (.*))?(?: # SKIP (.*))?", line)
        if not verdict:
            before.append(line)
            continue
        ran += 1
        skipped = "# SKIP" in line
        name = f"{base}: {(line.split('# SKIP')[1] if skipped else verdict.group(2) or '').strip()}"
        if skipped:
            reasons = [b.split("SKIP", 1)[1].strip() for b in before if b.startswith("# SKIP")]
            tally.skip(name, reasons[-1] if reasons else "no reason given")
        elif verdict.group(1) == "ok":
            tally.passed += 1
        else:
            failed += 1
            tally.fail(name, "\n".join(before + lines[number:number + 4]))
        before = []
    if not planned or ran != int(planned.group(1)) or (status != 0 and not failed):
        tally.fail(f"{base}: ended with status {status} after {ran} tests", "\n".join(before))


class Result(unittest.TestResult):
    def __init__(self, tally, verbose):
        super().__init__()
        self.tally, self.verbose = tally, verbose

    def addSuccess(self, test):
        self.tally.passed += 1

    def addFailure(self, test, err):
        self.tally.fail(test.id(), self._exc_info_to_string(err, test))

    addError = addFailure

    def addSubTest(self, test, subtest, err):
        if err is not None:
            self.tally.fail(subtest.id(), self._exc_info_to_string(err, test))

    def addSkip(self, test, reason):
        self.tally.skip(test.id(), reason)


def run_unittest(path, tally, verbose):
    folder, name = os.path.split(os.path.abspath(path))
    if folder not in sys.path:
        sys.path.insert(0, folder)
    suite = unittest.defaultTestLoader.loadTestsFromName(os.path.splitext(name)[0])
    suite.run(Result(tally, verbose))


def main(arguments):
    verbose = "--verbose" in arguments
    tally = Tally()
    for path in arguments:
        if path.startswith("--"):
            continue
        start, before = time.monotonic(), (tally.passed, tally.failed, tally.skipped)
        if path.endswith(".py"):
            run_unittest(path, tally, verbose)
        else:
            run_cmocka(path, tally)
        ran = [b - a for a, b in zip(before, (tally.passed, tally.failed, tally.skipped))]
        print(f"{os.path.basename(path)}: {ran[0]} passed, {ran[1]} failed, {ran[2]} skipped "
              f"({time.monotonic() - start:.1f} s)", flush=True)
    if not tally.passed and not tally.failed:
        print("no test ran")
    print(f"{tally.passed} passed, {tally.failed} failed, {tally.skipped} skipped")
    return 0 if tally.passed and not tally.failed else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
