"""A few lines that read glTF 2.0, and write small files for the tests."""
import base64
import json
import math
import struct
import zlib
from pathlib import Path
from urllib.parse import unquote

COMPONENT = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
LIMIT = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535}
WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Gltf:
    def __init__(self, path):
        self.folder = Path(path).parent
        data = Path(path).read_bytes()
        self.binary = b""
        if data[:4] == b"glTF":
            size, = struct.unpack_from("<I", data, 12)
            self.json = json.loads(data[20:20 + size])
            self.binary = data[28 + size:]
        else:
            self.json = json.loads(data)
        self.buffers = [self.buffer(b) for b in self.json.get("buffers", [])]

    def __getitem__(self, key):
        return self.json.get(key, [])

    def buffer(self, buffer):
        uri = buffer.get("uri")
        if uri is None:
            return self.binary
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        return (self.folder / unquote(uri)).read_bytes()

    def elements(self, view, offset, form, count):
        view = self["bufferViews"][view]
        data, start = self.buffers[view["buffer"]], view.get("byteOffset", 0) + offset
        stride = view.get("byteStride") or struct.calcsize(form)
        return [list(struct.unpack_from(form, data, start + i * stride)) for i in range(count)]

    def accessor(self, number):
        a = self["accessors"][number]
        width = WIDTH[a["type"]]
        form = "<%d%s" % (width, COMPONENT[a["componentType"]])
        out = [[0] * width for _ in range(a["count"])]
        if "bufferView" in a:
            out = self.elements(a["bufferView"], a.get("byteOffset", 0), form, a["count"])
        if "sparse" in a:
            s, i = a["sparse"], a["sparse"]["indices"]
            places = self.elements(i["bufferView"], i.get("byteOffset", 0),
                                   "<" + COMPONENT[i["componentType"]], s["count"])
            values = self.elements(s["values"]["bufferView"], s["values"].get("byteOffset", 0), form,
                                   s["count"])
            for (place,), value in zip(places, values):
                out[place] = value
        if a.get("normalized"):
            out = [[max(x / LIMIT[a["componentType"]], -1) for x in row] for row in out]
        return out

    def triangles(self, primitive):
        """Corner numbers of each triangle, in glTF's order."""
        count = self["accessors"][primitive["attributes"]["POSITION"]]["count"]
        list_ = list(range(count))
        if "indices" in primitive:
            list_ = [i for i, in self.accessor(primitive["indices"])]
        mode = primitive.get("mode", 4)
        if mode == 4:
            return [tuple(list_[i:i + 3]) for i in range(0, len(list_) - 2, 3)]
        if mode == 5:
            return [(list_[i], list_[i + 1 + i % 2], list_[i + 2 - i % 2]) for i in range(len(list_) - 2)]
        return [(list_[i + 1], list_[i + 2], list_[0]) for i in range(len(list_) - 2)] if mode == 6 else []

    def local(self, node):
        """The node's matrix, three rows."""
        node = self["nodes"][node]
        if "matrix" in node:
            return [[node["matrix"][4 * j + i] for j in range(4)] for i in range(3)]
        rest = (("translation", (0, 0, 0)), ("rotation", (0, 0, 0, 1)), ("scale", (1, 1, 1)))
        return trs(*(node.get(name, value) for name, value in rest))

    def walk(self):
        """Numbers of the drawn scene's nodes, parents first, children in order, each once."""
        scene = self["scenes"][self.json.get("scene", 0)]["nodes"]
        below = {child for node in self["nodes"] for child in node.get("children", [])}
        roots = [n for n in scene if n not in below] or scene
        out = []

        def visit(number, parent):
            out.append((number, parent))
            for child in self["nodes"][number].get("children", []):
                visit(child, number)

        for root in roots:
            visit(root, None)
        return out


def trs(t, q, s):
    x, y, z, w = q
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    return [[row[k] * s[k] for k in range(3)] + [t[i]] for i, row in enumerate(rows)]


def determinant(m):
    (a, b, c), (d, e, f), (g, h, i) = (row[:3] for row in m)
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def png(rows, bits=8):
    """RGB rows to PNG; each pixel three samples of `bits`."""
    sample = ">%dB" if bits == 8 else ">%dH"
    raw = b"".join(b"\0" + struct.pack(sample % (3 * len(row)), *sum(map(tuple, row), ())) for row in rows)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), bits, 2, 0, 0, 0)
    chunks = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + chunks


class Builder:
    """A glTF file under construction; `json` may be changed at will before glb()."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [],
                     "meshes": []}
        self.binary = b""

    def add(self, kind, item):
        self.json.setdefault(kind, []).append(item)
        return len(self.json[kind]) - 1

    def view(self, data, **more):
        self.binary += bytes(-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **more}
        self.binary += data
        return self.add("bufferViews", view)

    def accessor(self, rows, kind, component=5126, **more):
        data = b"".join(struct.pack("<%d%s" % (len(r), COMPONENT[component]), *r) for r in rows)
        return self.add("accessors", {"bufferView": self.view(data), "componentType": component,
                                      "count": len(rows),
                                      "type": kind, **more})

    def mesh(self, positions, uvs=None, indices=None, **more):
        primitive = {"attributes": {"POSITION": self.accessor(positions, "VEC3")}, **more}
        if uvs:
            primitive["attributes"]["TEXCOORD_0"] = self.accessor(uvs, "VEC2")
        if indices:
            primitive["indices"] = self.accessor([(i,) for i in indices], "SCALAR", 5123)
        return self.add("meshes", {"primitives": [primitive]})

    def node(self, root=True, **more):
        number = self.add("nodes", more)
        if root:
            self.json["scenes"][0]["nodes"].append(number)
        return number

    def texture(self, image, **sampler):
        texture = {"source": self.add("images", {"bufferView": self.view(image), "mimeType": "image/png"})}
        if sampler:
            texture["sampler"] = self.add("samplers", sampler)
        return self.add("textures", texture)

    def material(self, texture=None, factor=(1, 1, 1, 1), info=None, **more):
        surface = {"baseColorFactor": list(factor)}
        if texture is not None:
            surface["baseColorTexture"] = {"index": texture, **(info or {})}
        return self.add("materials", {"pbrMetallicRoughness": surface, **more})

    def glb(self):
        binary = self.binary + bytes(-len(self.binary) % 4)
        if binary:
            self.json.setdefault("buffers", [{"byteLength": len(self.binary)}])
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        out = struct.pack("<I4s", len(text), b"JSON") + text
        if binary:
            out += struct.pack("<I4s", len(binary), b"BIN\0") + binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(out)) + out


SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


def square(uv=((0, 1), (1, 1), (1, 0), (0, 0)), image=None, node=None, **material):
    """A textured square of two triangles, one metre wide; the start of most tests."""
    builder = Builder()
    texture = builder.texture(image or png([[(255, 0, 0), (0, 255, 0)], [(0, 0, 255), (255, 255, 255)]]))
    number = builder.material(texture, **material)
    builder.node(mesh=builder.mesh(SQUARE, list(uv), [0, 1, 2, 0, 2, 3], material=number), **(node or {}))
    return builder


def slerp(a, b, s):
    c = sum(x * y for x, y in zip(a, b))
    b = [-x for x in b] if c < 0 else b
    angle = math.acos(min(abs(c), 1.0))
    if angle < 1e-6:
        return a
    return [(math.sin((1 - s) * angle) * x + math.sin(s * angle) * y) / math.sin(angle) for x, y in zip(a, b)]
