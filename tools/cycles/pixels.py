"""Pixel loops, found in machine code: the innermost loops of a function that load and store half-words - a depth,
a texel, a colour - and, where such a loop is unrolled, the copies of a pixel's instructions that stand beside it
for what is left over.

It says nothing of what the half-words are: whoever asks names functions that have them for pixels only.
"""
import re

LOAD, STORE = re.compile(r"ldrh|lhu"), re.compile(r"strh|sh\s")
LEAST_COPIED = 5  # instructions: shorter copies are taken for chance
ENDS = ("branch", "branch-register", "table-branch")  # nothing follows
CALL = re.compile(r"jalr?\s")  # whatever the model takes it for


def target_of(instruction):
    """The address that a branch goes to, or None."""
    goes = instruction.kind in ("branch", "branch-if") and not CALL.match(instruction.text)
    at = re.search(r"[ ,]([0-9a-f]+)$", instruction.text.strip()) if goes else None
    return int(at[1], 16) if at else None


def ends(instruction):
    return instruction.to_pc or instruction.kind in ENDS and not CALL.match(instruction.text)


def shape(instruction):
    """What copies of an instruction have in common: all but immediates and branches' targets."""
    return instruction.text.split()[0] if instruction.kind.startswith("branch") else re.sub(r"-?\b\d\w*", "", instruction.text)


def blocks_of(function):
    """([instructions of a block], [set of the blocks that may follow it]) of a function's instructions by address.
    Calls are no ends; where a table or a register says where to go on, nothing follows."""
    targets = {target_of(i) for i in function}
    blocks, begin = [], True
    for i in function:
        if begin or i.address in targets:
            blocks.append([])
        blocks[-1].append(i)
        begin = ends(i) or i.kind == "branch-if"
    number = {block[0].address: n for n, block in enumerate(blocks)}
    after = []
    for n, block in enumerate(blocks):
        last = block[-1]
        falls = [n + 1] if n + 1 < len(blocks) and not ends(last) else []
        after.append({*falls, *([number[target_of(last)]] if target_of(last) in number else [])})
    return blocks, after


def cycles(nodes, after):
    """The sets of nodes that can all reach each other, and themselves."""
    reached = {n: after[n] & nodes for n in nodes}
    grown = True
    while grown:
        grown = False
        for n, of in reached.items():
            more = of.union(*(reached[m] for m in of))
            grown = grown or len(more) > len(of)
            reached[n] = more
    return {frozenset(m for m in reached[n] if n in reached[m]) for n in nodes if n in reached[n]}


def innermost(nodes, after):
    """The loops among nodes, as sets, that are loops no more without the block by which they are entered."""
    found = []
    for loop in cycles(nodes, after):
        heads = [n for n in loop if any(n in after[m] for m in nodes - loop)] or [min(loop)]
        inner = innermost(loop - {min(heads)}, after)
        found += inner or [loop]
    return found


def period(shapes):
    """The length of what a loop's body begins with twice or more, or that of all of it."""
    for n in range(LEAST_COPIED, len(shapes) // 2 + 1):
        if shapes[:n] == shapes[n:2 * n]:
            return n
    return len(shapes)


def of_function(function):
    """({addresses of instructions in pixel loops}, {those of them with which a pixel of an unrolled loop begins}) of a
    function's instructions by address."""
    inside, begins = set(), set()
    if not any(STORE.match(i.text) for i in function):
        return inside, begins
    blocks, after = blocks_of(function)
    shapes = [shape(i) for i in function]
    for loop in innermost(set(range(len(blocks))), after):
        body = [i for n in sorted(loop) for i in blocks[n]]
        if not all(any(kind.match(i.text) for i in body) for kind in (LOAD, STORE)):
            continue
        inside.update(i.address for i in body)
        of_body = [shape(i) for i in body]
        n = period(of_body)
        copies = [i for i in range(len(shapes) - n + 1) if shapes[i:i + n] == of_body[:n]] if n < len(of_body) else []
        inside.update(function[k].address for i in copies for k in range(i, i + n))
        begins.update(function[i].address for i in copies)
    return inside, begins
