#!/usr/bin/env python3
"""Writes quaternion_table.inc: the coefficients of sin(t a)/sin a as a series in 1 - cos a.

    sin(t a)/sin a = t (1 + b_1 (1 + b_2 (1 + ...))),  b_i = (v_i - u_i t^2)(1 - cos a),
    u_i = 1/(i (2 i + 1)),  v_i = i/(2 i + 1)

(D. Eberly, "A Fast and Accurate Algorithm for Computing SLERP", 2011). Each row holds
round(2^32 u_i), round(2^32 v_i). What ten terms leave out is largest at t -> 0 and is printed
with --error, as a power of two, for an angle of 45 degrees.

Usage: quaternion_table.py -o FILE
"""
import argparse
import math
from fractions import Fraction

TERMS = 10


def coefficients(i):
    return Fraction(1, i * (2 * i + 1)), Fraction(i, 2 * i + 1)


def left_out():
    """a/sin a less the series at t = 0: the product of all b_i, summed from the next term on."""
    y, product, rest = 1 - math.cos(math.pi / 4), 1.0, 0.0
    for i in range(1, 60):
        product *= float(coefficients(i)[1]) * y
        if i > TERMS:
            rest += product
    return rest


def main():
    parser = argparse.ArgumentParser(description="Writes the coefficients of the core's slerp.")
    parser.add_argument("-o", "--output")
    parser.add_argument("--error", action="store_true")
    args = parser.parse_args()
    if args.error:
        print(f"2^{math.log2(left_out()):.2f}")
    if not args.output:
        return
    lines = ["/* Made by fixed/quaternion_table.py, which says what the entries are; `make check-tables`",
             " * makes them again and compares. */"]
    for i in range(1, TERMS + 1):
        u, v = (int(c * 2 ** 32 + Fraction(1, 2)) for c in coefficients(i))
        lines.append(f"{{ UINT32_C({u}), UINT32_C({v}) }},")
    with open(args.output, "w", encoding="ascii") as out:
        out.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
