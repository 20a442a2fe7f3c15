#!/usr/bin/env python3
"""Holds what was counted against what is aimed at, and says where the instructions go where an aim is missed.

usage: goals.py --build DIR [--bits B] --goals GOALS.csv --sizes SIZE.csv --csv FILE --where FILE TARGET ...

Writes a line for each line of GOALS.csv, and where.csv of the targets. A missed aim is no failure. Aims of targets
that were not asked for are na.
"""
import csv
import sys

import count
import where

INPUT = ["target", "scene", "method", "tolerance", "unit", "goal", "note"]
COLUMNS = ["target", "scene", "figure", "tolerance", "unit", "goal", "reached", "state", "notes"]
INSTRUCTIONS, BYTES = "instr_per_px", "bytes"
SIZE_LEVEL = "-O2"
FUNCTIONS = 5  # so many are named


def parsed(row, columns):
    if columns != INPUT:
        raise ValueError(f"the columns are {','.join(columns or [])}, not {','.join(INPUT)}")
    if None in row or None in row.values():
        raise ValueError(f"not {len(INPUT)} cells")
    if row["target"] not in count.TARGETS:
        raise ValueError(f"target '{row['target']}' is none of {', '.join(count.TARGETS)}")
    if row["unit"] not in (INSTRUCTIONS, BYTES):
        raise ValueError(f"unit '{row['unit']}' is neither {INSTRUCTIONS} nor {BYTES}")
    try:
        goal = float(row["goal"])
    except ValueError:
        goal = 0
    if not 0 < goal < float("inf"):
        raise ValueError(f"goal '{row['goal']}' is no number above 0")
    return row


def read(path):
    """[(line, row)] of goals.csv. Lines that begin with # are comments."""
    found = []
    with open(path, encoding="utf-8") as f:
        numbered = [(n, line) for n, line in enumerate(f, 1) if not line.startswith("#")]
    table = csv.DictReader(line for _, line in numbered)
    for row in table:
        line = numbered[table.line_num - 1][0]
        try:
            found.append((line, parsed(row, table.fieldnames)))
        except ValueError as e:
            raise count.Failed(f"{path}: line {line}: {e}") from e
    if not found:
        raise count.Failed(f"{path}: holds no goals")
    return found


def read_sizes(path):
    """{(target, configuration): bytes of text}"""
    with open(path, encoding="utf-8") as f:
        return {(row["target"], row["name"]): int(row["text"]) for row in csv.DictReader(f)
                if row["kind"] == "configuration" and row["level"] == SIZE_LEVEL}


def reached(goal, pictures, sizes):
    """The figure as a number, the row's text of it, and the Count and Case it is of, or None."""
    if goal["unit"] == BYTES:
        text = sizes.get((goal["target"], goal["method"]))
        if text is None:
            raise ValueError(f"there is no configuration '{goal['method']}' for {goal['target']}")
        return text, str(text), None
    found = pictures.get(tuple(goal[column] for column in INPUT[:4]))
    if found is None:
        raise ValueError(f"no picture of scene '{goal['scene']}' by '{goal['method']}' at '{goal['tolerance']}' px is counted "
                         f"on {goal['target']}")
    case, counted = found
    n = counted.instructions / case.fragments
    return n, f"{n:.3f}", found


def rows_of(path, cases, counts, sizes):
    """Rows of goals.csv, each with `picture`: its (Case, Count) or None. counts: {target: [Count]}."""
    pictures = {(target, *case[:3]): (case, counted) for target, of_target in counts.items()
                for case, counted in zip(count.cases_of(target, cases), of_target)}
    for line, goal in read(path):
        row = {**{column: goal[column] for column in ("target", "scene", "tolerance", "unit", "goal")}, "figure": goal["method"],
               "reached": "na", "state": "na", "notes": goal["note"], "picture": None}
        if goal["unit"] == INSTRUCTIONS and goal["target"] not in counts:
            row["notes"] += "; reached: the target was not counted"
        else:
            try:
                n, row["reached"], row["picture"] = reached(goal, pictures, sizes)
            except ValueError as e:
                raise count.Failed(f"{path}: line {line}: {e}") from e
            row["state"] = "met" if n <= float(goal["goal"]) else "missed"
        yield row


def shares(row):
    """Where the instructions of a row's picture go: [(stage, instructions per fragment, part)], the largest first."""
    case, counted = row["picture"]
    found = sorted(where.stages(counted).items(), key=lambda item: -item[1])
    return [(stage, n / case.fragments, n / counted.instructions) for stage, n in found if n]


def say(rows):
    for row in rows:
        name = " ".join(row[c] for c in ("target", "scene", "figure") if row[c] != "na")
        at = "" if row["tolerance"] == "na" else f" {row['tolerance']} px"
        print(f"{row['state']:8s}{name + at:36s}{row['reached']:>10s} {row['unit']:13s} goal {row['goal']:>6s} ({row['notes']})")
        if row["state"] == "missed" and row["picture"]:
            case, counted = row["picture"]
            print("        " + ", ".join(f"{stage} {n:.2f} ({100 * part:.0f} %)" for stage, n, part in shares(row) if part >= 0.005))
            print("        most in " + ", ".join(f"{function} {n / case.fragments:.2f}" for function, n in where.dearest(counted, FUNCTIONS)))
    states = [row["state"] for row in rows]
    print(f"goals: {states.count('met')} met, {states.count('missed')} missed" +
          (f", {states.count('na')} not counted" if "na" in states else ""))


def main():
    parser = count.arguments("Holds counts and sizes against what is aimed at.")
    for name in ("--goals", "--sizes", "--csv", "--where"):
        parser.add_argument(name, required=True)
    args = parser.parse_args()
    read(args.goals)  # what is wrong with it is said before the images run
    cases = count.list_cases(args.build)
    counts = {target: count.count(args.build, args.bits, target, cases) for target in args.targets}
    where.write(args.where, where.COLUMNS, [row for target, of in counts.items() for row in where.rows_of(target, cases, of)])
    rows = list(rows_of(args.goals, cases, counts, read_sizes(args.sizes)))
    where.write(args.csv, COLUMNS, rows)
    say(rows)


if __name__ == "__main__":
    try:
        main()
    except (count.Failed, OSError) as e:
        sys.exit(f"goals.py: {e}")
