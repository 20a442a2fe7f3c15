#!/usr/bin/env python3
"""Writes recip_table.inc: the reciprocal tables of 2^4 to 2^9 entries.

Entry i of the table of 2^b entries stands for x = 1 + i/2^b, 1 <= x <= 2, and holds
2^17 / x - 2^16, so 17 bits of the reciprocal in 16. Between two entries the core goes
along the chord, which lies above the curve 1/x by at most
    (1/sqrt(x0) - 1/sqrt(x1))^2                      (where x = sqrt(x0 x1))
so every entry is lowered by half of that, the mean of its two intervals: the error is
then as large below as above. Rounded to nearest; the first would be 65536 and is 65535.

Usage: recip_table.py -o FILE
"""
import argparse
from decimal import Decimal, ROUND_HALF_UP, getcontext

getcontext().prec = 40


def chord_error(i, n):
    """Largest height of the chord over 1/x on interval i of n."""
    x0, x1 = 1 + Decimal(i) / n, 1 + Decimal(i + 1) / n
    return (1 / x0.sqrt() - 1 / x1.sqrt()) ** 2


def entries(bits):
    n = 1 << bits
    for i in range(n + 1):
        around = [chord_error(j, n) for j in (i - 1, i) if 0 <= j < n]
        lowered = 1 / (1 + Decimal(i) / n) - sum(around) / len(around) / 2
        value = (lowered * 2 ** 17 - 2 ** 16).quantize(Decimal(1), rounding=ROUND_HALF_UP)
        yield max(0, min(65535, int(value)))


def main():
    parser = argparse.ArgumentParser(description="Writes the reciprocal tables of the core.")
    parser.add_argument("-o", "--output", required=True)
    args = parser.parse_args()
    lines = ["/* Made by fixed/recip_table.py, which says what the entries are; `make check-tables`",
             " * makes them again and compares. */"]
    for bits in range(4, 10):
        lines.append(f"#{'if' if bits == 4 else 'elif'} EW_RECIP_BITS == {bits}")
        values = list(entries(bits))
        for k in range(0, len(values), 12):
            lines.append("    " + ", ".join(str(v) for v in values[k:k + 12]) + ",")
    lines.append("#endif")
    with open(args.output, "w", encoding="ascii") as out:
        out.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
