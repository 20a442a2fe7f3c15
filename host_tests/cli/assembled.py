"""A few lines of machine code, assembled and linked for real."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools" / "cycles"), str(ROOT / "tools" / "report")]

import count  # noqa: E402
import model  # noqa: E402

OPTIONS = {"m0plus": ["-mcpu=cortex-m0plus", "-mthumb"], "m3": ["-mcpu=cortex-m3", "-mthumb"], "m4": ["-mcpu=cortex-m4", "-mthumb"],
           "m33": ["-mcpu=cortex-m33", "-mthumb"], "rv32imc": ["-march=rv32imc", "-mabi=ilp32"]}


def assemble(test, target, source):
    """The model of a program."""
    prefix = count.tools_prefix(target)
    if not shutil.which(prefix + "as"):
        test.skipTest(f"{prefix}as is not installed")
    arm = target != "rv32imc"
    with tempfile.TemporaryDirectory() as folder:
        assembled, linked = os.path.join(folder, "a.o"), os.path.join(folder, "a")
        head = ".syntax unified\n.thumb\n" if arm else ""
        subprocess.run([prefix + "as", *OPTIONS[target], "-o", assembled, "-"], input=f"{head}.text\n{source}\n", text=True, check=True)
        subprocess.run([prefix + "ld", *([] if arm else ["-m", "elf32lriscv"]), "-e", "0", "-Ttext", "0x1000", "-o", linked, assembled], check=True)
        return model.Model(target, prefix + "objdump", linked)
