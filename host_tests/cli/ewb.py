"""A second reader of baked scenes, written from docs/scene-format.md alone.

Scene(bytes) checks everything the page promises and raises ValueError with the broken
promise; afterwards its lists hold the records as tuples and small objects.
"""
import math
import struct
import zlib
from types import SimpleNamespace

SIZES = {"CAMR": 72, "BOUN": 20, "NODE": 68, "PRIM": 40, "VERT": 10, "INDX": 2, "MATL": 8, "TEXR": 8,
         "TEXL": 2,
         "TRAK": 12, "KEYS": 32, "ANIM": 4}
NEEDED = ("CAMR", "BOUN", "NODE", "PRIM", "VERT", "INDX", "MATL")


def check(condition, promise):
    if not condition:
        raise ValueError(promise)


def block(m, e):
    return math.ldexp(m, e - 30)


def read_row(data, at):
    *m, e, e_last = struct.unpack_from("<4ihh", data, at)
    for part, exponent in ((m[:3], e), (m[3:], e_last)):
        check(-1000 <= exponent <= 1000, "row: exponent in range")
        top = max(abs(x) for x in part)
        check(2**29 <= top <= 2**30 or (top == 0 and exponent == 0),
              "row: largest magnitude normalised, or zero with an exponent of 0")
    return [block(x, e) for x in m[:3]] + [block(m[3], e_last)]


def read_matrix(data, at):
    return [read_row(data, at + 20 * k) for k in range(3)]


class Scene:
    def __init__(self, data):
        self.data = data
        self.sections = {}
        self.read_header()
        self.read_directory()
        camera = self.at("CAMR")
        self.view = read_matrix(data, camera)
        focal, near_m, near_e, zero = struct.unpack_from("<iihH", data, camera + 60)
        self.focal, self.near = focal / 65536, block(near_m, near_e)
        check(0 < self.focal <= 1024 and zero == 0, "CAMR: focal ratio in range")
        check(2**29 <= near_m <= 2**30, "CAMR: near distance normalised")
        *self.centre, self.radius = read_row(data, self.at("BOUN"))
        self.vertices = self.unpack("VERT", "<3h2h")
        self.indices = [i for i, in self.unpack("INDX", "<H")]
        self.read_materials()
        self.read_primitives()
        self.read_movement()
        self.read_nodes()

    def read_header(self):
        data = self.data
        check(len(data) >= 32 and data[:4] == b"EWB\x1a", "magic")
        version, header, size, crc, self.section_count = struct.unpack_from("<HHIIH", data, 4)
        check(version == 1 and header == 32, "version 1, header of 32 bytes")
        check(size == len(data) and size % 4 == 0, "size of the file")
        check(crc == zlib.crc32(data[:12] + b"\0\0\0\0" + data[16:]), "CRC-32")
        check(1 <= self.section_count <= 32 and not any(data[18:32]),
              "section count; rest of the header zero")

    def read_directory(self):
        used = [(0, 32 + 16 * self.section_count)]
        for i in range(self.section_count):
            tag, offset, count, size = struct.unpack_from("<4sIII", self.data, 32 + 16 * i)
            tag = tag.decode("ascii")
            check(tag in SIZES, f"{tag}: a known tag")
            check(tag not in self.sections, f"{tag}: once")
            check(size == SIZES[tag], f"{tag}: bytes per record")
            check(offset % 4 == 0 and offset + count * size <= len(self.data), f"{tag}: inside the file")
            self.sections[tag] = (offset, count)
            used.append((offset, offset + count * size))
        for tag in NEEDED:
            check(tag in self.sections, f"{tag}: present")
        for tag in ("CAMR", "BOUN"):
            check(self.count(tag) == 1, f"{tag}: one record")
        check(self.count("ANIM") <= 1, "ANIM: at most one record")
        used.sort()
        for (_, end), (start, _) in zip(used, used[1:] + [(len(self.data), 0)]):
            check(end <= start, "sections do not overlap")
            check(not any(self.data[end:start]), "bytes between sections are zero")

    def count(self, tag):
        return self.sections.get(tag, (0, 0))[1]

    def at(self, tag, record=0):
        return self.sections[tag][0] + record * SIZES[tag]

    def unpack(self, tag, form):
        if not self.count(tag):
            return []
        start = self.at(tag)
        return list(struct.iter_unpack(form, self.data[start:start + self.count(tag) * SIZES[tag]]))

    def read_materials(self):
        self.texels = [t for t, in self.unpack("TEXL", "<H")]
        self.textures = []
        for first, log2_width, log2_height, form, zero in self.unpack("TEXR", "<I4B"):
            check(log2_width <= 11 and log2_height <= 11 and form == 0 and zero == 0, "TEXR: ranges")
            width, height = 1 << log2_width, 1 << log2_height
            check(first + width * height <= len(self.texels), "TEXR: texels inside TEXL")
            self.textures.append(SimpleNamespace(width=width, height=height,
                                                 texels=self.texels[first:first + width * height]))
        self.materials = []
        for colour, texture, flags, tolerance in self.unpack("MATL", "<4H"):
            check(texture == 0xFFFF or texture < len(self.textures), "MATL: texture exists")
            check(flags in (0, 1) and tolerance <= 256, "MATL: flags and tolerance")
            self.materials.append(SimpleNamespace(
                colour=colour, texture=None if texture == 0xFFFF else self.textures[texture],
                double_sided=flags == 1, tolerance=tolerance / 16))

    def read_primitives(self):
        self.primitives, indices_used = [], 0
        for i in range(self.count("PRIM")):
            start = self.at("PRIM", i)
            first, count, material, first_index, index_count = struct.unpack_from("<IHHII", self.data, start)
            *origin, scale = read_row(self.data, start + 16)
            bits = self.data[start + 36]
            check(count >= 1 and first + count <= len(self.vertices), "PRIM: vertices inside VERT")
            check(material < len(self.materials), "PRIM: material exists")
            check(index_count % 3 == 0 and indices_used <= first_index <= len(self.indices) - index_count,
                  "PRIM: indices inside INDX, behind those of the primitive before")
            indices_used = first_index + index_count
            check(1 <= bits <= 12 and not any(self.data[start + 37:start + 40]), "PRIM: fraction bits, zeros")
            indices = self.indices[first_index:first_index + index_count]
            check(all(index < count for index in indices), "INDX: below the number of vertices")
            self.primitives.append(SimpleNamespace(
                origin=origin, scale=scale, bits=bits, material=self.materials[material], indices=indices,
                vertex_count=count, raw=self.vertices[first:first + count]))

    def read_movement(self):
        keys = []
        for key in self.unpack("KEYS", "<3i4h3i"):
            check(all(abs(m) <= 2**30 for m in key[:3] + key[7:]), "KEYS: |m| <= 2^30")
            quaternion = [q / 16384 for q in key[3:7]]
            check(abs(math.hypot(*quaternion) - 1) <= 1 / 256, "KEYS: quaternion of length 1")
            keys.append((key[:3], quaternion, key[7:]))
        self.tracks, keys_used = [], 0
        for first, count, interval, et, es in self.unpack("TRAK", "<IHHhh"):
            check(count >= 1 and keys_used <= first <= len(keys) - count,
                  "TRAK: keys inside KEYS, behind those of the track before")
            keys_used = first + count
            check(interval >= 1 and -1000 <= et <= 1000 and -1000 <= es <= 1000, "TRAK: interval, exponents")
            track = SimpleNamespace(interval=interval, keys=[])
            for t, q, s in keys[first:first + count]:
                if track.keys:
                    check(sum(a * b for a, b in zip(q, track.keys[-1][1])) >= 0,
                          "KEYS: dot product not negative")
                track.keys.append(([block(m, et) for m in t], q, [block(m, es) for m in s]))
            self.tracks.append(track)
        self.duration = struct.unpack_from("<I", self.data, self.at("ANIM"))[0] if self.count("ANIM") else 0
        check(self.count("ANIM") == 0 or self.duration >= 1, "ANIM: at least 1 ms")

    def read_nodes(self):
        self.nodes = []
        for i in range(self.count("NODE")):
            start = self.at("NODE", i)
            parent, track, first, count = struct.unpack_from("<hhHH", self.data, start)
            check(-1 <= parent < i, "NODE: parent before its children")
            check(-1 <= track < len(self.tracks), "NODE: track exists")
            check(first + count <= len(self.primitives), "NODE: primitives exist")
            self.nodes.append(SimpleNamespace(
                parent=parent, track=None if track < 0 else self.tracks[track],
                local=read_matrix(self.data, start + 8),
                primitives=self.primitives[first:first + count]))

    def world(self, node):
        matrix = self.nodes[node].local
        parent = self.nodes[node].parent
        return matrix if parent < 0 else multiply(self.world(parent), matrix)


def multiply(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) + (a[i][3] if j == 3 else 0) for j in range(4)]
            for i in range(3)]


def transform(matrix, p):
    return [row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] for row in matrix]


def position(primitive, index):
    """Of a vertex of a primitive, in its node."""
    raw = primitive.raw[index]
    return [o + primitive.scale * raw[k] / 32768 for k, o in enumerate(primitive.origin)]


def texels(primitive, index):
    """u and v of a vertex of a primitive, in texels."""
    return [raw / (1 << primitive.bits) for raw in primitive.raw[index][3:]]
