"""Modelled cycles: how often each block of a program ran, and published instruction timings.

A cost function gives (low, typical, high) cycles of one instruction, knowing the one before it,
whether it was a taken branch, and where to. Memory answers at once: flash wait states, caches and
other bus masters are not modelled. SOURCES says for each core which document its rows are from
and which of them could be checked against it.
"""
import functools
import re
import subprocess
from collections import namedtuple

SOURCES = {
    "m0plus": "Arm DDI 0484C, Cortex-M0+ Technical Reference Manual, table 3.1, with the fast multiplier. Its rows for "
              "data processing, multiply and loads were compared; those for branches, BL and POP {pc} were compared "
              "with a second, independent tool's only.",
    "m3": "Arm DDI 0337, Cortex-M3 Technical Reference Manual: table 18.1 (issue E) for data processing, MUL, branches, "
          "single and multiple loads and stores, and 'Load/store timings' (issue I); table 3-1 of its revision r2p1 for MLA 2, "
          "long multiplies 3-5 and 4-7, divides 2-12; that IT goes along with a neighbour, 0 or 1: Microchip's description of the "
          "Cortex-M3's Auxiliary Control Register, bit DISFOLD. All compared.",
    "m4": "Arm 100166, Cortex-M4 Technical Reference Manual, table 3-1: data processing, MUL, MLA and the range of P "
          "(pipeline refill, 1-3); long multiplies 1 and divides 2-12: Texas Instruments SWCU192, table 3-25; loads and stores: "
          "SWCU185; folded IT, 0 or 1: SLAU723A, register ACTLR. All compared.",
    "m33": "An estimate: Arm publishes no instruction timings for the Cortex-M33. Compared with measurements of an RP2350 that "
           "others published (jnk0le, 'pipeline cycle test', 2025): single loads and stores 1, a stall where a loaded register is "
           "used at once, N registers in N cycles, taken branches 1 or 2, branches not taken 0 or 1, IT 0 behind most "
           "instructions. Multiplies and multiply-accumulates 1: Nordic, nRF5340 Product Specification, CPU. Unchecked: that a long "
           "multiply may take 2 (high), divides 2-12 as on the M4, pairs of 16-bit instructions issued together, which "
           "are not modelled.",
    "rv32imc": "lowRISC Ibex, 'Pipeline Details' (stall cycles of each kind of instruction), compared. Low: single-cycle "
               "multiplier and branch target adder; typical: fast multiplier, no such adder; high: slow multiplier.",
}

Instruction = namedtuple("Instruction", "address size kind written in_address read registers to_pc text")

# ---- disassembly ----

ARM_REGISTER = re.compile(r"\b(r1[0-5]|r[0-9]|sp|lr|pc|ip|fp|sl|sb)\b")
CONDITION = "(?:eq|ne|cs|cc|hs|lo|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)"
ARM_KINDS = [  # the first that matches; what is left is data processing
    (re.compile(pattern + r"\Z"), kind) for pattern, kind in [
        ("b" + CONDITION, "branch-if"), ("cbn?z", "branch-if"), ("b", "branch"), ("bl", "call"), ("blx?" + CONDITION, "call"),
        ("blx", "call-register"), (f"bx{CONDITION}?", "branch-register"), ("tb[bh]", "table-branch"),
        ("push|stm.*", "store-many"), ("pop|ldm.*", "load-many"), ("ldrd|ldrex.*", "load-many"), ("strd|strex.*", "store-many"),
        ("ldr.*", "load"), ("str.*", "store"), ("[su]div.*", "divide"), ("[su]mull.*", "multiply-long"),
        ("[su]mlal|umaal", "multiply-long-add"), ("ml[as].*", "multiply-add"), ("mul.*|smul.*|smla.*|smm.*", "multiply"),
        ("it[te]*", "it"), ("mrs|msr|dsb|dmb|isb|cps.*|wf[ie]|svc|bkpt|sev|udf", "system")]]


def list_length(operands):
    length = 0
    for part in re.search(r"\{([^}]*)\}", operands).group(1).split(","):
        ends = re.fullmatch(r"\s*r(\d+)-r(\d+)\s*", part)
        length += int(ends[2]) - int(ends[1]) + 1 if ends else 1
    return length


def arm_instruction(address, size, mnemonic, operands):
    name = mnemonic.split(".")[0]
    operands = re.sub(r"<[^>]*>", "", re.split(r"[;@]|//", operands)[0]).strip()
    kind = next((kind for pattern, kind in ARM_KINDS if pattern.match(name)), "data")
    registers = ARM_REGISTER.findall(operands)
    bracket = re.search(r"\[([^\]]*)\]", operands)
    in_address = frozenset(ARM_REGISTER.findall(bracket[1])) if bracket else frozenset()
    written, read, count, to_pc = frozenset(registers[:1]), frozenset(registers[1:]), 0, False
    if kind in ("load-many", "store-many"):
        count = list_length(operands) if "{" in operands else 2
        written = frozenset(registers) if kind == "load-many" else frozenset()
        to_pc = kind == "load-many" and "pc" in written
    elif kind == "store":
        written, read = frozenset(), frozenset(registers)
        kind = "store-indexed" if len(in_address) > 1 else kind
    elif kind.startswith("multiply-long"):
        written, read = frozenset(registers[:2]), frozenset(registers[2 if kind == "multiply-long" else 0:])
    elif kind in ("it", "system") or kind.startswith(("branch", "call", "table")):
        written, read = frozenset(), frozenset(registers)
    elif re.match(r"(cmp|cmn|tst|teq)", name):
        written, read = frozenset(), frozenset(registers)
    else:
        to_pc = registers[:1] == ["pc"]
        # adds r0, #1 and adds r0, r1 read what they write
        read = frozenset(registers) if len(registers) <= 2 and kind == "data" and not name.startswith("mov") else read
    return Instruction(address, size, kind, written, in_address, read | in_address, count, to_pc, f"{mnemonic} {operands}")


RISCV_REGISTER = re.compile(r"\b(zero|ra|sp|gp|tp|fp|[ast]\d+)\b")
RISCV_KINDS = [
    (re.compile(pattern + r"\Z"), kind) for pattern, kind in [
        ("b(eq|ne|lt|ge|gt|le).*", "branch-if"), ("j|jal|jr|jalr|ret|tail|call", "branch"), ("l[whb]u?", "load"), ("s[whb]", "store"),
        ("mul", "multiply"), ("mulh.*", "multiply-long"), ("(div|rem).*", "divide"), ("csr.*|fence.*|ecall|ebreak|mret|wfi", "system")]]


def riscv_instruction(address, size, mnemonic, operands):
    operands = re.sub(r"<[^>]*>", "", operands.split("#")[0]).strip()
    kind = next((kind for pattern, kind in RISCV_KINDS if pattern.match(mnemonic)), "data")
    return Instruction(address, size, kind, frozenset(), frozenset(), frozenset(), 0, False, f"{mnemonic} {operands}")


def disassemble(objdump, image):
    """{address: Instruction}"""
    text = subprocess.run([objdump, "-d", image], stdout=subprocess.PIPE, check=True, text=True).stdout
    make = riscv_instruction if "riscv" in text.split("\n", 2)[1] else arm_instruction
    found = {}
    for address, code, mnemonic, operands in re.findall(r"^\s*([0-9a-f]+):\t([0-9a-f ]+?)\s*\t([^.\s]\S*)[ \t]*(.*)$", text, re.M):
        address = int(address, 16)
        found[address] = make(address, len(code.replace(" ", "")) // 2, mnemonic, operands)
    return found


# ---- cores ----

def same(cycles):
    return cycles, cycles, cycles


def m0plus(i, before, taken, target):
    """Two-stage pipeline: a taken branch costs one cycle more than one not taken."""
    del before, target
    flat = {"branch": 2, "branch-register": 2, "call": 3, "call-register": 2, "load": 2, "store": 2, "store-indexed": 2, "system": 3}
    if i.kind == "branch-if":
        return same(2 if taken else 1)
    if i.kind in ("load-many", "store-many"):
        return same(1 + i.registers + (2 if i.to_pc else 0))
    return same(flat.get(i.kind, 2 if i.to_pc else 1))


def refill(target):
    """P: 1 to 3, by the alignment and width of the target and whether it could be guessed."""
    return 1, 3 if target is not None and target.size == 4 and target.address & 2 else 2, 3


def plus(a, b):
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def m3_or_m4(flat):
    def cost(i, before, taken, target):
        p = refill(target)
        jump = taken if i.kind == "branch-if" else i.to_pc or i.kind in ("branch", "call", "branch-register", "call-register")
        # a load's result is there a cycle later; a load or store behind it goes along unless it needs it
        behind_load = before is not None and before.kind == "load" and not before.written & i.in_address
        # an address from the data processing just before waits for the register file
        waits = before is not None and before.kind in ("data", "multiply") and bool(before.written & i.in_address)
        stall = (0, 1, 1) if waits and i.kind in ("load", "store", "store-indexed") else same(0)
        if i.kind == "load":
            own = same(1 if behind_load else 2)
        elif i.kind == "store":
            own = 1, 1, 2
        elif i.kind == "store-indexed":
            own = (1, 1, 2) if behind_load else same(2)
        elif i.kind in ("load-many", "store-many"):
            own = same(1 + i.registers)
        elif i.kind == "table-branch":
            own, jump = same(3), True
        else:
            own = flat.get(i.kind, same(1))
        return plus(plus(own, stall), p if jump else same(0))
    return cost


M3 = {"multiply-add": same(2), "multiply-long": (3, 4, 5), "multiply-long-add": (4, 6, 7), "divide": (2, 7, 12),
      "it": (0, 1, 1), "system": (1, 2, 4)}
M4 = {**M3, "multiply-add": same(1), "multiply-long": same(1), "multiply-long-add": same(1)}


def m33(i, before, taken, target):
    stall = 1 if before is not None and before.kind in ("load", "load-many") and before.written & i.read else 0
    jump = taken if i.kind == "branch-if" else i.to_pc or i.kind in ("branch", "call", "branch-register", "call-register", "table-branch")
    if i.kind == "branch-if":
        own = same(1) if taken else (0, 1, 1 + stall)
    elif i.kind in ("load-many", "store-many"):
        own = i.registers, i.registers, i.registers + 1
    elif i.kind == "load":
        own = 1, 1 + stall, 2
    else:
        own = {"divide": (2, 7, 12), "multiply-long": (1, 1, 2), "multiply-long-add": (1, 1, 2), "it": (0, 0, 1),
               "table-branch": same(3)}.get(i.kind, (1, 1 + stall, 1 + stall))
    return plus(own, (0, 1, 2) if jump else same(0)) if target is not None or jump else own


def ibex(i, before, taken, target):
    del before, target
    if i.kind == "branch-if":
        return (2, 3, 3) if taken else same(1)
    return {"branch": same(2), "load": same(2), "store": same(2), "multiply": (1, 3, 33), "multiply-long": (2, 4, 33),
            "divide": same(38)}.get(i.kind, same(1))


COSTS = {"m0plus": m0plus, "m3": m3_or_m4(M3), "m4": m3_or_m4(M4), "m33": m33, "rv32imc": ibex}

# ---- evaluation ----


class Model:
    """The cycles of regions of one image. Costs are worked out once for each block and edge."""

    def __init__(self, target, objdump, image):
        self.code = disassemble(objdump, image)
        self.cost = COSTS[target]
        self.block = functools.lru_cache(None)(self._block)
        self.edge = functools.lru_cache(None)(self._edge)

    def _ends(self, first, last):
        """The last instruction of a block and the one before it, None in a block of one."""
        before, at = None, first
        while at != last:
            before = self.code[at]
            at += before.size
        return before, self.code[at]

    def _block(self, first, last):
        """All but the last instruction."""
        total, before, at = (0, 0, 0), None, first
        while at != last:
            i = self.code[at]
            total = plus(total, self.cost(i, before, False, None))
            before, at = i, at + i.size
        return total

    def _edge(self, first, last, to):
        """The last instruction of a block on its way to another; and, where that is the next one in
        memory, what the other's first instruction owes to having it before."""
        before, i = self._ends(first, last)
        target = self.code.get(to)
        if to != i.address + i.size:
            return self.cost(i, before, True, target)
        follows = plus(self.cost(i, before, False, target), self.cost(target, i, False, None))
        alone = self.cost(target, None, False, None)
        return tuple(a - b for a, b in zip(follows, alone))

    def cycles(self, blocks, edges):
        """(low, typical, high) of a region: blocks {(first, last): times}, edges {(first, last, to): times}."""
        total, left = [0, 0, 0], dict(blocks)
        for key, times in edges.items():
            left[key[:2]] -= times
            for k, c in enumerate(self.edge(*key)):
                total[k] += c * times
        for key, times in blocks.items():
            ways_out = self.cost(*reversed(self._ends(*key)), True, None) if left[key] else (0, 0, 0)
            for k, c in enumerate(self.block(*key)):
                total[k] += c * times + ways_out[k] * left[key]
        return tuple(total)
