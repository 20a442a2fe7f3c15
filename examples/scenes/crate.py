#!/usr/bin/env python3
"""Writes a scene for chips with little memory: a crate that turns above a tiled floor.

    crate.py -o crate.glb

Textures are 32 x 32 and made for few greys: every edge that counts is one of light and dark.
"""
import math
import sys

from glb import Glb, Mesh, main

HALF = 0.62  # of the crate's side
FLOOR = 5.0  # half the floor's side; a tile is 1 wide
TURN_SECONDS = 4.0


def floor_texel(x, y):
    """Two by two tiles with joints."""
    column, row = int(x * 2), int(y * 2)
    edge = min(x * 2 - column, y * 2 - row, column + 1 - x * 2, row + 1 - y * 2)
    if edge < 0.06:
        return (70, 66, 62)
    return (226, 214, 190) if (column + row) % 2 else (128, 96, 78)


def board(x, y):
    """Planks in a frame with a diagonal brace; 0 is a gap, 1 the lightest wood."""
    edge = min(x, y, 1 - x, 1 - y)
    if edge < 0.04 or 0.16 <= edge < 0.2:
        return 0.0
    if edge < 0.16:
        return 1.0
    if abs(x - y) < 0.11:
        return 0.0 if abs(x - y) > 0.08 else 0.9
    return 0.0 if y * 5 % 1 < 0.12 else 0.62 + 0.1 * (int(y * 5) % 2)


def side_texel(x, y):
    wood = board(x, y)
    return (50 + 180 * wood, 34 + 142 * wood, 22 + 84 * wood)


def lid_texel(x, y):
    """The lid has a round mark."""
    ring = math.hypot(x - 0.5, y - 0.5)
    if 0.2 < ring < 0.32:
        return (40, 60, 130)
    wood = 1.0 if min(x, y, 1 - x, 1 - y) < 0.16 else 0.8
    return (240 * wood, 206 * wood, 140 * wood)


TEXTURES = {"floor": (32, 32, floor_texel), "side": (32, 32, side_texel), "lid": (32, 32, lid_texel)}
MATERIALS = {  # opposite sides share a tint, so that the turning sides are told apart
    "floor": ("floor", (1.0, 1.0, 1.0)),
    "side": ("side", (1.0, 1.0, 1.0)),
    "side in shade": ("side", (0.4, 0.42, 0.5)),
    "lid": ("lid", (1.0, 1.0, 1.0)),
}


def build_crate():
    mesh = Mesh()
    square = [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)]
    for k in range(4):  # the side that faces +z, turned by quarters
        turned = []
        for a, b in ((-HALF, -HALF), (HALF, -HALF), (HALF, HALF), (-HALF, HALF)):
            x, z = ((a, HALF), (HALF, -a), (-a, -HALF), (-HALF, a))[k]
            turned.append((x, b, z))
        mesh.polygon("side in shade" if k % 2 else "side", turned, square)
    mesh.polygon("lid", [(-HALF, HALF, HALF), (HALF, HALF, HALF), (HALF, HALF, -HALF), (-HALF, HALF, -HALF)], square)
    return mesh


def build():
    glb = Glb("crate.py", TEXTURES, MATERIALS)
    ground, crate = Mesh(), build_crate()
    ground.patch("floor", (-FLOOR, 0, FLOOR), (2 * FLOOR, 0, 0), (0, 0, -2 * FLOOR), (2, 2),
                 lambda p: (p[0] / 2, p[2] / 2))
    glb.scene([("floor", ground, (0.0, 0.0, 0.0)), ("crate", crate, (0.0, 0.85, 0.0))],
              eye=(0.9, 2.1, 3.0), target=(0.0, 0.8, 0.0), degrees=42)
    glb.turn(1, TURN_SECONDS)
    return glb.bytes(), ground.triangles() + crate.triangles()


if __name__ == "__main__":
    sys.exit(main("Writes a scene of a turning crate as a glTF binary file.", build))
