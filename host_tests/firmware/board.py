"""Programs of examples/firmware and same_bits on emulated boards."""
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections import namedtuple

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
IMAGES = os.path.join(ROOT, os.environ.get("EW_FIRMWARE", "build/release/firmware"))
COUNT = os.path.join(ROOT, os.environ.get("EW_COUNT", "build/release/cycles/count.so"))
LIMIT_SECONDS = 300

sys.path.insert(0, os.path.join(ROOT, "tools", "cycles"))
import count  # noqa: E402 - found by the line above
import model  # noqa: E402

ARM, RISC_V, AVR, HOST = "arm-none-eabi-", "riscv64-unknown-elf-", "avr-", ""
# prefix of the compiler's tools, words for QEMU, what it is, KB of RAM
Machine = namedtuple("Machine", "tools words name ram")
MACHINES = {
    "microbit": Machine(ARM, ["-M", "microbit"], "Cortex-M0, BBC micro:bit", 16),
    "lm3s6965evb": Machine(ARM, ["-M", "lm3s6965evb"], "Cortex-M3, LM3S6965 board", 64),
    "m0plus": Machine(ARM, ["-M", "mps2-an385"], "Cortex-M0+ code on mps2-an385", 4096),
    "m3": Machine(ARM, ["-M", "mps2-an385"], "Cortex-M3, mps2-an385", 4096),
    "m4": Machine(ARM, ["-M", "mps2-an386"], "Cortex-M4, mps2-an386", 4096),
    "m7": Machine(ARM, ["-M", "mps2-an500"], "Cortex-M7, mps2-an500", 4096),
    "m33": Machine(ARM, ["-M", "mps2-an505"], "Cortex-M33, mps2-an505", 2048),
    "m55": Machine(ARM, ["-M", "mps3-an547"], "Cortex-M55, mps3-an547", 512),
    "rv32imc": Machine(RISC_V, ["-M", "virt", "-cpu", "lowrisc-ibex", "-m", "32M", "-bios", "none",
                                "-device", "bochs-display"], "RV32IMC (Ibex), virt", 8192),
    "avr": Machine(AVR, [], "ATmega2560, 16-bit int", 8),
}
for _compiler in ("gcc", "clang"):
    for _level in ("O0", "O2", "O3"):
        MACHINES[f"host-{_compiler}-{_level}"] = Machine(HOST, [], f"host, {_compiler} -{_level}", None)

# Whose instruction timings stand for a target's (the Cortex-M0's are nearly the M0+'s; none are
# published for M7 and M55), and the function that each example calls when a frame has been drawn.
MODELS = {"microbit": "m0plus", "lm3s6965evb": "m3", **{t: t for t in ("m0plus", "m3", "m4", "m33", "rv32imc")}}
FRAME_END = {"oled": "panel_show", "rgb565": "board_print", "hash": "picture_hash", "hash64x48": "picture_hash",
             "lines": "board_print"}
FRAME_BEGIN = {"lines": "draw_picture"}  # of others: player_draw

# Not QEMU for the AVR: version 7.2 stands still at libgcc's __clzsi2 (a skipped return), and with
# -singlestep computes other bits.
EMULATORS = {ARM: "qemu-system-arm", RISC_V: "qemu-system-riscv32", AVR: "simavr"}


def image(program, target):
    return os.path.join(IMAGES, f"{program}-{target}.elf")


def missing(program, target):
    """Why a program cannot run on a target, or None."""
    tools = MACHINES[target].tools
    compiler = tools + "gcc" if tools or "gcc" in target else "clang"
    for needed in (compiler, EMULATORS.get(tools)):
        if needed and not shutil.which(needed):
            return f"{needed} is not installed"
    return None if os.path.exists(image(program, target)) else f"{image(program, target)} has not been made"


def command(program, target):
    """`timeout` ends what hangs, and passes on that it is to end."""
    tools, limit = MACHINES[target].tools, ["timeout", str(LIMIT_SECONDS)]
    if tools == HOST:
        return [*limit, image(program, target)]
    if tools == AVR:
        return [*limit, EMULATORS[tools], "-m", "atmega2560", "-f", "16000000", image(program, target)]
    return [*limit, EMULATORS[tools], *MACHINES[target].words, "-display", "none", "-monitor", "none",
            "-serial", "none", "-chardev", "stdio,id=console", "-semihosting-config",
            "enable=on,target=native,chardev=console", "-kernel", image(program, target)]


class Frames:
    """Counts a program's instructions from player_draw, or what stands for it, to what it calls next, frame by frame.
    `words` go to QEMU; afterwards `counted` has (instructions, cycles) of each frame, cycles being
    (low, typical, high) or None."""

    def __init__(self, program, target, folder):
        self.target, self.image, self.out = target, image(program, target), os.path.join(folder, "regions")
        self.words = []
        if program in FRAME_END and MACHINES[target].tools in (ARM, RISC_V):
            begin, end = self.addresses(FRAME_BEGIN.get(program, "player_draw"), FRAME_END[program])
            self.words = ["-plugin", f"{COUNT},begin={begin:#x},end={end:#x},edges=1,out={self.out}"]

    def addresses(self, *names):
        done = subprocess.run([MACHINES[self.target].tools + "nm", self.image], check=True,
                              stdout=subprocess.PIPE, text=True)
        lines = [line.split() for line in done.stdout.splitlines()]
        symbols = {fields[2]: int(fields[0], 16) for fields in lines if len(fields) == 3}
        return [symbols[name] for name in names]

    def counted(self):
        if not self.words:
            return []
        name = MODELS.get(self.target)
        timings = name and model.Model(name, MACHINES[self.target].tools + "objdump", self.image)
        return [(n, timings.cycles(blocks, edges) if timings else None)
                for n, blocks, edges in count.regions(self.out)]


class Ran:
    """A program that ran to its end: lines it printed, seconds it took, and Frames.counted."""

    def __init__(self, program, target):
        start = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            frames = Frames(program, target, folder)
            if MACHINES[target].tools == AVR:
                self.lines = run_avr(program, target)
            else:
                self.lines = run(program, target, frames.words)
            self.seconds = time.monotonic() - start
            self.counted = frames.counted()


def run(program, target, words):
    """The lines that a program prints; raises when it does not end well."""
    done = subprocess.run(command(program, target) + words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        said = (done.stdout + done.stderr)[-400:]
        raise RuntimeError(f"{program} on {target}: status {done.returncode}: {said}")
    return done.stdout.splitlines()


def run_avr(program, target):
    """simavr does not end by itself: it is stopped at the line `end`. It shows each line in
    colour and with a full stop for the line's end."""
    lines = []
    with subprocess.Popen(command(program, target), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT) as avr:
        for line in avr.stdout:
            text = line.decode(errors="replace").replace("\x1b[32m", "").replace("\x1b[0m", "").rstrip("\n")
            if text.endswith("."):
                lines.append(text[:-1])
            if lines and lines[-1] == "end":
                avr.terminate()
                return lines
    raise RuntimeError(f"{program} on {target}: ended, or took {LIMIT_SECONDS} s, after {lines[-1:]}")


def sizes(program, target):
    """Bytes of flash and of RAM that the linker gave out; the stack is not among them."""
    tools = MACHINES[target].tools
    done = subprocess.run([tools + "size", image(program, target)], check=True, stdout=subprocess.PIPE, text=True)
    text, data, bss = (int(n) for n in done.stdout.splitlines()[1].split()[:3])
    return text + data, data + bss


class Shown:
    """A board with a display: at each line `frame` of the program what the display shows is
    kept, by QEMU's screendump. Then has frames (width, height, RGB bytes), the other lines
    that the program printed, what the emulator had to say, the exit status, seconds and
    Frames.counted."""

    def __init__(self, program, target):
        self.frames, self.lines = [], []
        start = time.monotonic()
        with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_UNIX) as server:
            server.bind(os.path.join(folder, "qmp"))
            server.listen(1)
            server.settimeout(LIMIT_SECONDS)
            frames = Frames(program, target, folder)
            with open(os.path.join(folder, "errors"), "w+", encoding="utf-8") as errors, subprocess.Popen(
                    [*command(program, target), *frames.words, "-qmp", "unix:" + os.path.join(folder, "qmp")],
                    stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors) as board:
                try:
                    self.follow(board, server, os.path.join(folder, "screen.ppm"))
                    self.status = board.wait(LIMIT_SECONDS)
                finally:
                    board.terminate()
                errors.seek(0)
                self.errors = errors.read()
            self.seconds = time.monotonic() - start
            self.counted = frames.counted()

    def follow(self, board, server, dump):
        with server.accept()[0] as link:
            link.settimeout(LIMIT_SECONDS)
            with link.makefile("rw", encoding="utf-8") as qmp:
                qmp.readline()  # its greeting
                ask(qmp, "qmp_capabilities")
                for line in board.stdout:
                    line = line.decode().strip()
                    if line != "frame":
                        self.lines.append(line)
                        continue
                    ask(qmp, "screendump", filename=dump)
                    self.frames.append(read_ppm(dump))
                    board.stdin.write(b"\n")
                    board.stdin.flush()


def ask(qmp, name, **arguments):
    qmp.write(json.dumps({"execute": name, "arguments": arguments}) + "\n")
    qmp.flush()
    while True:
        answer = json.loads(qmp.readline())
        if "error" in answer:
            raise RuntimeError(f"QEMU: {name}: {answer['error']}")
        if "return" in answer:
            return


def read_ppm(path):
    """Width, height and the RGB bytes of what QEMU writes: no comments in it."""
    with open(path, "rb") as f:
        kind, size, largest, pixels = f.read().split(b"\n", 3)
    assert kind == b"P6" and largest == b"255", (kind, largest)
    width, height = (int(n) for n in size.split())
    return width, height, pixels
