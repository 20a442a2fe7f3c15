"""What the sample scenes are written with: meshes of flat polygons, textures as functions, and
a glTF binary file of both. Only the standard library is needed, and the same bytes come out of
every run.
"""
import argparse
import json
import math
import os
import struct
import sys
import zlib


def png(width, height, function):
    """The picture as PNG, 8 bits RGB, no filter."""
    rows = bytearray()
    for j in range(height):
        rows.append(0)
        for i in range(width):
            colour = function((i + 0.5) / width, (j + 0.5) / height)
            rows += bytes(min(max(int(c + 0.5), 0), 255) for c in colour)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 9))
            + chunk(b"IEND", b""))


def add(a, b, k=1.0):
    return tuple(p + k * q for p, q in zip(a, b))


class Mesh:
    """Triangles sorted by material; fronts are counter-clockwise."""

    def __init__(self):
        self.parts = {}

    def polygon(self, material, corners, uvs=None):
        """A convex polygon, as a fan."""
        part = self.parts.setdefault(material, ([], [], []))
        base = len(part[0])
        part[0].extend(corners)
        part[1].extend(uvs or [(0.0, 0.0)] * len(corners))
        for i in range(1, len(corners) - 1):
            part[2].extend((base, base + i, base + i + 1))

    def patch(self, material, origin, along, up, cells, uv):
        """A grid of quads facing along x up; uv maps a point to texture coordinates."""
        for j in range(cells[1]):
            for i in range(cells[0]):
                corners = []
                for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                    corners.append(add(add(origin, along, a / cells[0]), up, b / cells[1]))
                self.polygon(material, corners, [uv(p) for p in corners])

    def rings(self, material, centre, rings, sides, v_range=(1.0, 0.0), repeat=1.0):
        """A solid of revolution around y from rings (height, radius), bottom to top."""
        for k in range(len(rings) - 1):
            v = [v_range[0] + (v_range[1] - v_range[0]) * (k + n) / (len(rings) - 1) for n in (0, 1)]
            for i in range(sides):
                points, uvs = [], []
                # Angle 0 is +x and grows towards +z, so the outside runs backwards.
                for side, level in ((i + 1, 0), (i, 0), (i, 1), (i + 1, 1)):
                    height, radius = rings[k + level]
                    angle = 2 * math.pi * side / sides
                    if radius == 0 and side == i + 1 and level == 1:
                        continue
                    points.append((centre[0] + radius * math.cos(angle), centre[1] + height,
                                   centre[2] + radius * math.sin(angle)))
                    uvs.append((repeat * side / sides, v[level]))
                self.polygon(material, points, uvs)

    def triangles(self):
        return sum(len(part[2]) for part in self.parts.values()) // 3


class Glb:
    """Collects glTF objects and the binary chunk.

    textures: name to (width, height, function of the texel's centre); materials: name to
    (name of a texture or None, linear tint or colour). All are drawn unlit."""

    def __init__(self, generator, textures, materials):
        self.json = {"asset": {"version": "2.0", "generator": generator},
                     "extensionsUsed": ["KHR_materials_unlit"]}
        self.binary = bytearray()
        self.append("samplers", {"wrapS": 10497, "wrapT": 10497})
        texture_numbers, self.materials = {}, {}
        for name, (width, height, function) in textures.items():
            image = self.append("images", {"name": name, "mimeType": "image/png",
                                           "bufferView": self.view(png(width, height, function))})
            texture_numbers[name] = self.append("textures", {"source": image, "sampler": 0})
        for name, (texture, tint) in materials.items():
            surface = {"baseColorFactor": [*tint, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}
            if texture:
                surface["baseColorTexture"] = {"index": texture_numbers[texture]}
            number = self.append("materials", {"name": name, "pbrMetallicRoughness": surface,
                                               "extensions": {"KHR_materials_unlit": {}}})
            self.materials[name] = (number, texture is not None)

    def append(self, kind, item):
        self.json.setdefault(kind, []).append(item)
        return len(self.json[kind]) - 1

    def view(self, data, target=None):
        self.binary += bytes(-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.binary += data
        return self.append("bufferViews", view)

    def floats(self, rows, kind, target=None, bounds=False):
        data = b"".join(struct.pack("<%df" % len(row), *row) for row in rows)
        accessor = {"bufferView": self.view(data, target), "componentType": 5126, "count": len(rows),
                    "type": kind}
        if bounds:
            exact = [struct.unpack("<%df" % len(row), struct.pack("<%df" % len(row), *row)) for row in rows]
            accessor["min"] = [min(column) for column in zip(*exact)]
            accessor["max"] = [max(column) for column in zip(*exact)]
        return self.append("accessors", accessor)

    def mesh(self, name, mesh):
        primitives = []
        for material, (positions, uvs, indices) in mesh.parts.items():
            number, textured = self.materials[material]
            positions, uvs, indices = shared(positions, uvs, indices)
            attributes = {"POSITION": self.floats(positions, "VEC3", 34962, True)}
            if textured:
                attributes["TEXCOORD_0"] = self.floats(uvs, "VEC2", 34962)
            view = self.view(struct.pack("<%dH" % len(indices), *indices), 34963)
            accessor = {"bufferView": view, "componentType": 5123, "count": len(indices), "type": "SCALAR"}
            primitives.append({"attributes": attributes, "indices": self.append("accessors", accessor),
                               "material": number})
        return self.append("meshes", {"name": name, "primitives": primitives})

    def scene(self, objects, eye, target, degrees):
        """A node for each (name, Mesh, translation), and a camera so many degrees high."""
        camera = self.append("cameras", {"name": "view", "type": "perspective",
                                         "perspective": {"yfov": math.radians(degrees), "znear": 0.25}})
        for name, mesh, translation in objects:
            self.append("nodes", {"name": name, "mesh": self.mesh(name, mesh), "translation": list(translation)})
        self.append("nodes", {"name": "camera", "camera": camera, "translation": list(eye),
                              "rotation": look_at(eye, target)})
        self.json["scenes"] = [{"nodes": list(range(len(objects) + 1))}]
        self.json["scene"] = 0

    def turn(self, node, seconds):
        """The node turns once around y, for ever. In quarters: less than half a turn from key to key."""
        turns = [i / 4 for i in range(5)]
        times = self.floats([(seconds * t,) for t in turns], "SCALAR", bounds=True)
        rotations = self.floats([(0.0, math.sin(math.pi * t), 0.0, math.cos(math.pi * t)) for t in turns], "VEC4")
        self.append("animations", {"name": "turn", "samplers": [{"input": times, "output": rotations}],
                                   "channels": [{"sampler": 0, "target": {"node": node, "path": "rotation"}}]})

    def bytes(self):
        self.binary += bytes(-len(self.binary) % 4)
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        size = 12 + 8 + len(text) + 8 + len(self.binary)
        return (struct.pack("<4sII", b"glTF", 2, size) + struct.pack("<I4s", len(text), b"JSON") + text
                + struct.pack("<I4s", len(self.binary), b"BIN\0") + bytes(self.binary))


def shared(positions, uvs, indices):
    """Corners that agree in position and texture coordinates become one vertex."""
    known = {}
    out = [known.setdefault((positions[i], uvs[i]), len(known)) for i in indices]
    places = list(known)
    return [p for p, _ in places], [uv for _, uv in places], out


def look_at(eye, target):
    """The rotation, as a quaternion, that turns -z towards the target and keeps y up."""
    dx, dy, dz = (t - e for t, e in zip(target, eye))
    yaw, pitch = math.atan2(-dx, -dz), math.atan2(dy, math.hypot(dx, dz))
    cy, sy, cp, sp = math.cos(yaw / 2), math.sin(yaw / 2), math.cos(pitch / 2), math.sin(pitch / 2)
    return [cy * sp, sy * cp, -sy * sp, cy * cp]


def write_whole(path, data):
    """Writes beside `path` and renames, so that no half a file is ever left."""
    temporary = path + ".part"
    try:
        with open(temporary, "wb") as file:
            file.write(data)
        os.replace(temporary, path)
    except OSError:
        if os.path.isfile(temporary):
            os.remove(temporary)
        raise


def main(description, build):
    """A scene's program: `build` returns the file's bytes and the number of triangles."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("-o", "--output", metavar="FILE", required=True, help="the .glb file to write")
    output = parser.parse_args().output
    data, triangles = build()
    try:
        write_whole(output, data)
    except OSError as error:
        print(f"{os.path.basename(sys.argv[0])}: {output}: cannot be written: {error.strerror}", file=sys.stderr)
        return 1
    print(f"{output}: {len(data)} bytes, {triangles} triangles")
    return 0
