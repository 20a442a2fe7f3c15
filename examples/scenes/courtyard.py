#!/usr/bin/env python3
"""Writes the sample scene: a tiled courtyard with a knot that turns on a plinth.

    courtyard.py -o courtyard.glb

The scene is meant to be drawn unlit: the sun, from the right and above, is painted into
the textures and into the tints of the materials. Units are metres, y is up, the camera
looks towards -z.
"""
import math
import sys

from glb import Glb, Mesh, add, main

COURT = 4.0  # half the width between the two arcades
ARCADE = 6.5  # x of the arcades' back walls
BAYS = [0.0, -3.0, -6.0, -9.0, -12.0]  # z of the columns
FRONT, END = 7.0, -13.5  # z behind the camera and of the far wall
SPRING = 2.3  # height at which the arches start
TOP, WALK = 4.4, 3.4  # of the walls, of the ceilings in the arcades
KNOT = (0.0, 2.06, -3.0)  # its middle
SHADOW_EDGE = 2.0  # x from which the right wall shades the floor
TURN_SECONDS = 4.0


# ---- noise and colours; a colour is three floats, 0 to 255, sRGB ----

def scramble(x, y, seed):
    """A pseudo-random number in [0, 1) for a point of a lattice."""
    n = (x * 374761393 + y * 668265263 + seed * 2246822519) & 0xFFFFFFFF
    n = ((n ^ n >> 13) * 1274126177) & 0xFFFFFFFF
    n = ((n ^ n >> 15) * 2654435761) & 0xFFFFFFFF
    return (n ^ n >> 16) / 4294967296.0


def noise(x, y, cells_x, cells_y, seed):
    """Smooth noise in [0, 1) over the unit square; it repeats without a seam."""
    x, y = x * cells_x, y * cells_y
    ix, iy = math.floor(x), math.floor(y)
    fx, fy = x - ix, y - iy
    fx, fy = fx * fx * (3 - 2 * fx), fy * fy * (3 - 2 * fy)
    corner = [[scramble((ix + i) % cells_x, (iy + j) % cells_y, seed) for i in (0, 1)] for j in (0, 1)]
    rows = [a + (b - a) * fx for a, b in corner]
    return rows[0] + (rows[1] - rows[0]) * fy


def clouds(x, y, cells_x, cells_y, seed):
    """Three octaves of noise, about [0, 1]."""
    total = 0.0
    for octave, weight in enumerate((4, 2, 1)):
        total += weight * noise(x, y, cells_x << octave, cells_y << octave, seed + octave)
    return total / 7


def mix(a, b, t):
    t = min(max(t, 0.0), 1.0)
    return tuple(p + (q - p) * t for p, q in zip(a, b))


def lit(colour, factor):
    return tuple(c * factor for c in colour)


def step(low, high, x):
    """0 below low, 1 above high, smooth between."""
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


# ---- textures: functions of the texel's centre (x, y) in [0, 1), y downwards ----

TERRACOTTA, CREAM, GROUT = (190, 112, 78), (226, 202, 162), (140, 112, 88)
SAND, MORTAR = (222, 196, 152), (172, 144, 108)


def tile(x, y, count, seed):
    """Checkered tiles with joints, `count` on a side."""
    column, row = int(x * count), int(y * count)
    fx, fy = x * count - column, y * count - row
    edge = min(fx, fy, 1 - fx, 1 - fy)
    base = TERRACOTTA if (column + row) % 2 else CREAM
    base = lit(base, 0.93 + 0.14 * scramble(column, row, seed))
    base = lit(base, 0.95 + 0.1 * clouds(x, y, 8, 8, seed + 10))
    return mix(GROUT, base, step(0.02, 0.07, edge))


def floor_texel(x, y):
    return tile(x, y, 4, 1)


def medallion_texel(x, y):
    """A rosette in a ring, darkened towards the plinth that stands on it."""
    dx, dy = 2 * x - 1, 2 * y - 1
    r, angle = math.hypot(dx, dy), math.atan2(dy, dx)
    petal = 0.5 + 0.5 * math.cos(8 * angle)
    if r > 0.96:
        colour = tile(x * 2 % 1, y * 2 % 1, 4, 1)
    elif r > 0.9:
        colour = (92, 62, 58)
    elif r > 0.78:
        blocks = int((angle / (2 * math.pi) + 0.5) * 32)
        colour = CREAM if blocks % 2 else (58, 104, 112)
    elif r > 0.74:
        colour = (92, 62, 58)
    else:
        colour = mix((206, 176, 128), (52, 112, 118), step(0.42, 0.58, petal * (1 - 0.45 * r / 0.74) + 0.12))
    colour = lit(colour, 0.94 + 0.12 * clouds(x, y, 16, 16, 30))
    # The sun stands right of the view: the plinth's soft shadow falls to the left.
    near = math.hypot(dx + 0.1, dy) - 0.36
    return lit(colour, 0.45 + 0.55 * step(-0.02, 0.34, near))


def stone_texel(x, y):
    """Sandstone blocks, four rows, every other one shifted by half a block."""
    row = int(y * 4)
    column = x * 2 + (0.5 if row % 2 else 0.0)
    fx, fy = column % 1, y * 4 % 1
    edge = min(min(fx, 1 - fx) * 2, fy, 1 - fy)
    block = scramble(int(column) % 2, row, 5)
    base = lit(mix(SAND, (206, 170, 128), block), 0.92 + 0.12 * scramble(int(column) % 2, row, 6))
    base = lit(base, 0.9 + 0.2 * clouds(x, y, 8, 8, 40))
    base = lit(base, 1.04 - 0.1 * fy)
    return mix(MORTAR, base, step(0.02, 0.09, edge))


def plaster_texel(x, y):
    """The arcades' back walls: y runs once from the ceiling to the floor."""
    colour = mix((196, 152, 112), (178, 98, 74), step(0.66, 0.67, y))
    colour = mix(colour, (232, 208, 164), step(0.62, 0.63, y) - step(0.66, 0.67, y))
    colour = lit(colour, 0.9 + 0.2 * clouds(x, y, 4, 4, 50))
    return lit(colour, 0.55 + 0.45 * math.sin(math.pi * min(1.0, 0.12 + 0.8 * y)))


def around(x):
    """Light on a round thing whose texture runs once around it, 0 to 1. At x the surface
    faces (cos, sin) of 2 pi x in world (x, z); the sun comes from (0.8, 0.6)."""
    facing = math.cos(2 * math.pi * x) * 0.8 + math.sin(2 * math.pi * x) * 0.6
    return 0.5 + 0.5 * facing


def column_texel(x, y):
    flute = abs(math.sin(math.pi * 16 * x))
    colour = mix((150, 122, 108), (250, 232, 196), around(x) ** 1.2)
    colour = lit(colour, 0.88 + 0.12 * step(0.1, 0.6, flute))
    return lit(colour, (0.94 + 0.12 * clouds(x, y, 8, 8, 60)) * (0.8 + 0.2 * step(0.0, 0.25, 1 - y)))


def leaf_texel(x, y):
    speck = clouds(x, y, 16, 8, 70)
    colour = mix((26, 58, 40), (122, 150, 70), around(x) * 0.75 + (speck - 0.5) * 0.9)
    return lit(colour, 0.72 + 0.36 * (1 - y))


def sky_texel(x, y):
    """y runs from 30 m above the ground to 2 m below it; hills stand at the foot."""
    colour = mix((92, 150, 206), (236, 224, 200), step(0.15, 0.9, y))
    cloud = clouds(x, y, 4, 8, 80) + 0.25 * (clouds(x, y, 8, 16, 84) - 0.5)
    colour = mix(colour, (255, 246, 232), step(0.52, 0.78, cloud) * 0.85)
    far = 0.885 - 0.035 * clouds(x, 0.3, 4, 4, 90) - 0.012 * noise(x, 0.7, 16, 4, 91)
    near = 0.915 - 0.03 * noise(x, 0.1, 3, 3, 92) - 0.012 * noise(x, 0.5, 12, 4, 93)
    if y > far:
        colour = mix((126, 158, 172), (168, 184, 172), (y - far) * 14)
    if y > near:
        colour = mix((84, 124, 96), (132, 152, 100), (y - near) * 12 + 0.3 * noise(x, y, 32, 32, 94))
    grain = scramble(int(x * 128), int(y * 128), 95) - 0.5  # hides the steps of RGB565
    return tuple(c + 5 * grain for c in colour)


def knot_texel(x, y):
    """Bands of gold and teal along the knot; y runs from facing up to facing down."""
    band = x * 2 % 1
    gold = mix((255, 214, 110), (236, 160, 60), y)
    teal = mix((70, 196, 190), (24, 104, 128), y)
    inlay = abs(band - 0.75)
    colour = gold if band < 0.5 else teal
    if band >= 0.5 and inlay < 0.06 + 0.05 * math.cos(2 * math.pi * 4 * y):
        colour = mix((255, 236, 180), (240, 190, 110), y)
    if min(band, abs(band - 0.5), 1 - band) < 0.025:
        colour = (92, 52, 44)
    shade = 1.06 - 0.62 * step(0.08, 0.8, y) + 0.16 * step(0.82, 1.0, y)
    glint = 1 - step(0.0, 0.07, abs(y - 0.2))
    return mix(lit(colour, shade), (255, 255, 240), 0.55 * glint)


TEXTURES = {  # name: (width, height, function)
    "floor": (128, 128, floor_texel),
    "medallion": (128, 128, medallion_texel),
    "stone": (128, 128, stone_texel),
    "plaster": (64, 64, plaster_texel),
    "column": (64, 64, column_texel),
    "leaf": (64, 64, leaf_texel),
    "sky": (128, 128, sky_texel),
    "knot": (128, 64, knot_texel),
}

SUN, SHADE = (1.0, 1.0, 1.0), (0.36, 0.39, 0.52)  # tints, linear
MATERIALS = {  # name: (texture or None, linear tint or colour)
    "floor": ("floor", SUN),
    "floor in shade": ("floor", SHADE),
    "medallion": ("medallion", SUN),
    "stone": ("stone", SUN),
    "stone in shade": ("stone", SHADE),
    "plaster": ("plaster", SUN),
    "column": ("column", SUN),
    "column in shade": ("column", (0.5, 0.52, 0.62)),
    "leaf": ("leaf", SUN),
    "sky": ("sky", SUN),
    "knot": ("knot", SUN),
    "meadow": (None, (0.26, 0.34, 0.13)),
    "ceiling": (None, (0.085, 0.06, 0.05)),
    "soffit": (None, (0.30, 0.21, 0.14)),
    "soffit in shade": (None, (0.16, 0.13, 0.13)),
    "ledge": (None, (0.86, 0.74, 0.52)),
    "ledge in shade": (None, (0.33, 0.31, 0.34)),
    "ledge below": (None, (0.24, 0.17, 0.12)),
    "pot": (None, (0.42, 0.12, 0.06)),
    "pot rim": (None, (0.55, 0.19, 0.10)),
}


# ---- geometry ----

def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(sum(p * p for p in a))
    return tuple(p / length for p in a)


def floor_uv(p):
    return p[0] / 2, p[2] / 2


def build_floor(mesh):
    def area(material, left, right, near, far, cells, uv=floor_uv):
        mesh.patch(material, (left, 0, near), (right - left, 0, 0), (0, 0, far - near), cells, uv)

    area("floor in shade", -ARCADE, -COURT, FRONT, END, (1, 8))
    area("floor in shade", SHADOW_EDGE, ARCADE, FRONT, END, (2, 8))
    area("floor", -COURT, -2.0, FRONT, END, (1, 8))
    # The medallion, 4 m wide, takes a part of the sunny middle.
    near, far = KNOT[2] + 2.0, KNOT[2] - 2.0
    area("floor", -2.0, SHADOW_EDGE, FRONT, near, (2, 3))
    area("floor", -2.0, SHADOW_EDGE, far, END, (2, 4))
    area("medallion", -2.0, SHADOW_EDGE, near, far, (2, 2), lambda p: ((p[0] + 2) / 4, (p[2] - far) / 4))


def wall_uv(p):
    return p[2] / 2, (TOP - p[1]) / 2


def arch(mesh, place, low, high, material, soffit, uv):
    """The wall above an opening from `low` to `high` along it, and the arch's underside.
    place(s, y, d) is the point s along the wall, y up, d into it; the wall is seen from
    d < 0 with s running to the right."""
    steps = 7
    centre, radius = (low + high) / 2, (high - low) / 2
    curve = []
    for i in range(steps + 1):
        angle = math.pi * i / steps
        curve.append((centre - radius * math.cos(angle), SPRING + radius * math.sin(angle)))
    for (s0, y0), (s1, y1) in zip(curve, curve[1:]):
        corners = [place(s0, y0, 0), place(s1, y1, 0), place(s1, TOP, 0), place(s0, TOP, 0)]
        mesh.polygon(material, corners, [uv(p) for p in corners])
        mesh.polygon(soffit, [place(s0, y0, 0.5), place(s1, y1, 0.5), place(s1, y1, 0), place(s0, y0, 0)])


def build_arcade(mesh, side):
    """side: -1 the left one, in the sun, 1 the right one, in its own shade."""
    tint = "" if side < 0 else " in shade"

    def place(s, y, d):  # to the right, seen from the court
        return side * (COURT + d), y, side * s

    stations = sorted(side * z for z in BAYS)
    first, last = sorted((side * END, side * FRONT))
    half = 0.4
    for s in stations:
        corners = [place(s - half, SPRING, 0), place(s + half, SPRING, 0), place(s + half, TOP, 0),
                   place(s - half, TOP, 0)]
        mesh.polygon("stone" + tint, corners, [wall_uv(p) for p in corners])
        build_column(mesh, (side * (COURT + 0.25), 0, side * s), tint)
    for low, high in zip(stations, stations[1:]):
        arch(mesh, place, low + half, high - half, "stone" + tint, "soffit" + tint, wall_uv)
    # Closed wall from the outermost columns to the ends of the court.
    for low, high in ((first, stations[0] - half), (stations[-1] + half, last)):
        mesh.patch("stone" + tint, place(low, 0, 0), (0, 0, side * (high - low)), (0, TOP, 0),
                   (max(1, round((high - low) / 2)), 2), wall_uv)
    left, right = stations[0] - half, stations[-1] + half
    mesh.polygon("soffit" + tint, [place(left, 0, 0), place(left, 0, 0.5), place(left, SPRING, 0.5),
                                   place(left, SPRING, 0)])
    mesh.polygon("soffit" + tint, [place(right, 0, 0.5), place(right, 0, 0), place(right, SPRING, 0),
                                   place(right, SPRING, 0.5)])
    build_ledge(mesh, place, first, last, tint)
    # Back wall and ceiling of the walk.
    depth = ARCADE - COURT
    mesh.patch("plaster", place(first, 0, depth), (0, 0, side * (last - first)), (0, WALK, 0), (8, 1),
               lambda p: (p[2] / 3, 0.99 - 0.98 * p[1] / WALK))
    mesh.polygon("ceiling", [place(first, WALK, depth), place(last, WALK, depth), place(last, WALK, 0.5),
                             place(first, WALK, 0.5)])


def build_ledge(mesh, place, low, high, tint):
    """What sticks out on top of a wall: its front and its underside."""
    out, crest = -0.15, TOP + 0.25
    mesh.polygon("ledge" + tint, [place(low, TOP, out), place(high, TOP, out), place(high, crest, out),
                                  place(low, crest, out)])
    mesh.polygon("ledge below", [place(low, TOP, 0), place(high, TOP, 0), place(high, TOP, out),
                                 place(low, TOP, out)])


def build_column(mesh, foot, tint):
    shaft = "column" + tint
    mesh.rings(shaft, foot, [(0.0, 0.34), (0.22, 0.34), (0.3, 0.22)], 8, (1.0, 0.9))
    mesh.rings(shaft, foot, [(0.3, 0.22), (SPRING - 0.3, 0.19)], 8, (0.9, 0.1))
    x, z = foot[0], foot[2]
    low, high, small, large = SPRING - 0.3, SPRING, 0.21, 0.4
    for i, (nx, nz) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))):  # the sun sees the first two
        px, pz = -nz, nx
        corners = []
        for k, y, r in ((1, low, small), (-1, low, small), (-1, high, large), (1, high, large)):
            corners.append((x + nx * r + k * px * r, y, z + nz * r + k * pz * r))
        mesh.polygon("ledge in shade" if tint else "ledge" if i < 2 else "ledge below", corners)


def build_end(mesh):
    """The far wall with its gate, what lies behind it, and the sky."""
    half = 1.25

    def place(s, y, d):
        return s, y, END - d

    def uv(p):
        return p[0] / 2, (TOP - p[1]) / 2

    arch(mesh, place, -half, half, "stone", "soffit", uv)
    for low, high in ((-ARCADE, -half), (half, ARCADE)):
        mesh.patch("stone", place(low, 0, 0), (high - low, 0, 0), (0, TOP, 0), (3, 2), uv)
    for s in (-half, half):
        corners = [place(s, 0, 0), place(s, SPRING, 0), place(s, SPRING, 0.5), place(s, 0, 0.5)]
        mesh.polygon("soffit", corners if s > 0 else corners[::-1])
    build_ledge(mesh, place, -ARCADE, ARCADE, "")
    mesh.polygon("meadow", [(-8, 0, END), (8, 0, END), (20, 0, -45), (-20, 0, -45)])
    mesh.patch("sky", (-48, -2, -45), (96, 0, 0), (0, 32, 0), (4, 1),
               lambda p: (p[0] / 48, 0.997 - 0.994 * (p[1] + 2) / 32))
    for x in (-2.6, 2.6):
        foot = (x, 0, END + 1.1)
        mesh.rings("pot", foot, [(0.0, 0.26), (0.42, 0.36)], 8)
        mesh.rings("pot rim", foot, [(0.42, 0.41), (0.55, 0.41), (0.55, 0.3)], 8)
        mesh.rings("leaf", foot, [(0.55, 0.34), (1.0, 0.52), (1.9, 0.36), (3.1, 0.0)], 8)


def build_plinth(mesh):
    foot = (KNOT[0], 0, KNOT[2])
    mesh.rings("column", foot, [(0.0, 0.74), (0.16, 0.74)], 8, (0.9, 0.6))
    mesh.rings("ledge", foot, [(0.16, 0.74), (0.16, 0.5)], 8)
    mesh.rings("column", foot, [(0.16, 0.5), (0.78, 0.42)], 8, (1.0, 0.1))
    mesh.rings("column", foot, [(0.78, 0.42), (0.86, 0.56), (0.96, 0.56)], 8, (0.6, 0.2))
    angles = [-math.pi * i / 4 for i in range(8)]
    mesh.polygon("ledge", [add(foot, (0.56 * math.cos(a), 0.96, 0.56 * math.sin(a))) for a in angles])


def knot_point(t):
    """The (2, 3) torus knot, standing upright."""
    r = 0.62 + 0.24 * math.cos(3 * t)
    return r * math.cos(2 * t), r * math.sin(2 * t), 0.33 * math.sin(3 * t)


def build_knot():
    mesh = Mesh()
    segments, sides, tube = 54, 6, 0.15
    ring = []
    for i in range(segments + 1):
        t = 2 * math.pi * i / segments
        centre = knot_point(t)
        forward = unit(add(knot_point(t + 0.01), knot_point(t - 0.01), -1.0))
        right = unit(cross(forward, unit(centre)))
        outward = cross(right, forward)
        normals = []
        for k in range(sides):
            angle = 2 * math.pi * k / sides
            normals.append(add(tuple(math.cos(angle) * p for p in outward), right, math.sin(angle)))
        ring.append((centre, normals))
    for i in range(segments):
        for k in range(sides):
            corners, uvs = [], []
            for n, m in ((i, k), (i, k + 1), (i + 1, k + 1), (i + 1, k)):
                centre, normals = ring[n]
                normal = normals[m % sides]
                corners.append(add(centre, normal, tube))
                # Light comes from above, and turning around y does not change what is above.
                uvs.append((6.0 * n / segments, 0.5 - 0.47 * normal[1]))
            mesh.polygon("knot", corners, uvs)
    return mesh


# ---- glTF ----


def build():
    glb = Glb("courtyard.py", TEXTURES, MATERIALS)
    court, knot = Mesh(), build_knot()
    build_floor(court)
    build_arcade(court, -1)
    build_arcade(court, 1)
    build_end(court)
    build_plinth(court)
    glb.scene([("courtyard", court, (0.0, 0.0, 0.0)), ("knot", knot, KNOT)],
              eye=(1.3, 2.05, 4.3), target=(-0.25, 1.55, -4.0), degrees=50)
    glb.turn(1, TURN_SECONDS)
    return glb.bytes(), court.triangles() + knot.triangles()


if __name__ == "__main__":
    sys.exit(main("Writes the sample scene of edgewalk as a glTF binary file.", build))
