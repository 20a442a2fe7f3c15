#!/usr/bin/env python3
"""Writes font_table.inc, the glyphs of ew_font_small, from the drawing in font.txt.

A glyph becomes its width and its rows, a byte each, the left pixel in the high bit.

Usage: font_table.py -o FILE
"""
import argparse
import os
import sys

FIRST, LAST, HEIGHT, WIDTH = 32, 126, 8, 5


def bands(text):
    """(number of the first code, rows) of each band: a line that is a number, and what follows."""
    lines = text.splitlines()
    for at, line in enumerate(lines):
        if line.isdecimal():
            yield int(line), lines[at + 1:at + 1 + HEIGHT]


def glyphs(text):
    """Code to rows of # and dots; ValueError where the drawing is not as it should be."""
    found = {}
    for code, rows in bands(text):
        for rows_of_glyph in zip(*(row.split(" ") for row in rows), strict=True):
            widths = {len(row) for row in rows_of_glyph}
            if len(rows) != HEIGHT or len(widths) != 1 or not 1 <= max(widths) <= WIDTH:
                raise ValueError(f"code {code}: not {HEIGHT} rows of one width, 1 to {WIDTH}")
            if set("".join(rows_of_glyph)) - set("#."):
                raise ValueError(f"code {code}: something else than # and dots")
            found[code] = rows_of_glyph
            code += 1
    if list(found) != list(range(FIRST, LAST + 1)):
        raise ValueError(f"not codes {FIRST} to {LAST} in order")
    return found


def table(found):
    lines = ["/* Made by font_table.py from font.txt; `make check-tables` makes it again and compares. */"]
    for code, rows in found.items():
        values = [int(row.replace("#", "1").replace(".", "0"), 2) << (8 - len(row)) for row in rows]
        name = chr(code) if chr(code) not in "\\ " else {"\\": "backslash", " ": "space"}[chr(code)]
        lines.append(f"{len(rows[0])}, " + ", ".join(f"0x{value:02X}" for value in values) + f", /* {name} */")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description="Writes the glyphs of the core's font.")
    parser.add_argument("-o", "--output", required=True)
    args = parser.parse_args()
    source = os.path.join(os.path.dirname(os.path.abspath(__file__)), "font.txt")
    try:
        with open(source, encoding="ascii") as drawing:
            made = table(glyphs(drawing.read()))
    except ValueError as wrong:
        print(f"font_table.py: {source}: cannot read the drawing: {wrong}", file=sys.stderr)
        return 1
    with open(args.output, "w", encoding="ascii") as out:
        out.write(made)
    return 0


if __name__ == "__main__":
    sys.exit(main())
