#!/usr/bin/env python3
"""ew-bake, seen from outside: what it writes, held against the source and the format
page by a second reader, and what it says to broken files.

EW_BIN names the folder that holds ew-bake, build/release/bin by default.
"""
import base64
import json
import math
import os
import random
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import ewb
from gltf import SQUARE, Builder, Gltf, determinant, png, slerp, square, trs

ROOT = Path(__file__).resolve().parents[2]
BAKE = Path(os.environ.get("EW_BIN", ROOT / "build/release/bin")).resolve() / "ew-bake"
COURTYARD = ROOT / "examples/scenes/courtyard.py"
MODELS = ROOT / "../shared/models"
ASSIMP = Path("/usr/share/assimp/models/glTF2")  # of the package assimp-testmodels


def linear(encoded):
    return encoded / 12.92 if encoded <= 0.04045 else ((encoded + 0.055) / 1.055) ** 2.4


def rgb565(colour):
    """Of a linear colour."""
    levels = []
    for value, most in zip(colour, (31, 63, 31)):
        encoded = value * 12.92 if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
        levels.append(math.floor(encoded * most + 0.5))
    return levels[0] << 11 | levels[1] << 5 | levels[2]


class BakeTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_bake(self, *arguments):
        return subprocess.run([BAKE, *map(str, arguments)], capture_output=True, text=True, timeout=60,
                              check=False)

    def put(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def source(self, source):
        """A path for what a test bakes: a Builder, bytes, or a path already."""
        if isinstance(source, Builder):
            source = source.glb()
        return self.put("in.glb", source) if isinstance(source, bytes) else source

    def bake(self, source, *options, warnings=()):
        """Bakes and reads back; each of `warnings` must be one line on stderr, no more."""
        output = self.folder / "out.ewb"
        path = self.source(source)
        result = self.run_bake(path, "-o", output, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stderr.splitlines()
        self.assertEqual(len(lines), len(warnings), result.stderr)
        for line, warning in zip(lines, warnings):
            self.assertTrue(line.startswith(f"ew-bake: {path}: warning: "), line)
            self.assertIn(warning, line)
        self.stdout = result.stdout
        return ewb.Scene(output.read_bytes())

    def refuse(self, source, *reasons, options=(), output=None, names=None):
        """Must end with exit code 1, one line that has the file and the reasons, no output."""
        path = self.source(source)
        target = output or self.folder / "out.ewb"
        before = sorted(os.listdir(self.folder))
        result = self.run_bake(path, "-o", target, *options)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertTrue(result.stderr.startswith(f"ew-bake: {names or path}: "), result.stderr)
        for reason in reasons:
            self.assertIn(reason, result.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), before, "something was left behind")


class SourceTest(BakeTest):
    """Holds vertices, texture coordinates, indices and matrices of whole files against them."""

    def compare(self, path, *options, warnings=None):
        output = self.folder / "out.ewb"
        result = self.run_bake(path, "-o", output, "--json", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        if warnings is not None:
            self.assertEqual(len(result.stderr.splitlines()), warnings, result.stderr)
        baked, source, summary = ewb.Scene(output.read_bytes()), Gltf(path), json.loads(result.stdout)
        self.summary_agrees(summary, baked, output)
        nodes = self.drawn(source)
        moved = {c["target"].get("node") for a in source["animations"][:1] for c in a["channels"]}
        self.assertEqual(len(nodes), len(baked.nodes))
        for i, (number, mirrored) in enumerate(nodes):
            node = baked.nodes[i]
            if number not in moved:
                for got, exact in zip(node.local, source.local(number)):
                    size = max(map(abs, exact))
                    for a, b in zip(got, exact):
                        self.assertAlmostEqual(a, b, delta=size * 2**-29)
            mesh = source["nodes"][number].get("mesh")
            primitives = source["meshes"][mesh]["primitives"] if mesh is not None else []
            self.compare_triangles(source, primitives, node, mirrored, summary)
        return baked, summary

    def summary_agrees(self, summary, baked, output):
        self.assertEqual(summary["bytes"], output.stat().st_size)
        self.assertEqual(summary["nodes"], len(baked.nodes))
        self.assertEqual(summary["vertices"], len(baked.vertices))
        self.assertEqual(summary["triangles"], len(baked.indices) // 3)
        self.assertEqual(summary["sections"],
                         {tag: count * ewb.SIZES[tag] for tag, (_, count) in baked.sections.items()})

    def drawn(self, source):
        """(number, mirrored) of the nodes that have something to draw in or below them."""
        walk, world, keep = source.walk(), {}, set()
        parents = dict(walk)
        for number, parent in walk:
            sign = determinant(source.local(number))
            world[number] = sign * world.get(parent, 1.0)
            mesh = source["nodes"][number].get("mesh")
            if mesh is not None and any(source.triangles(p) for p in source["meshes"][mesh]["primitives"]):
                while number is not None and number not in keep:
                    keep.add(number)
                    number = parents[number]
        return [(number, world[number] < 0) for number, _ in walk if number in keep]

    def uv_source(self, source, primitive):
        """Accessor values, transform applied, or None where the material has no texture."""
        material = source["materials"][primitive["material"]] if "material" in primitive else {}
        info = material.get("pbrMetallicRoughness", {}).get("baseColorTexture")
        if info is None:
            return None
        change = info.get("extensions", {}).get("KHR_texture_transform", {})
        name = "TEXCOORD_%d" % change.get("texCoord", info.get("texCoord", 0))
        if name not in primitive["attributes"]:
            return None
        (ox, oy), (sx, sy) = change.get("offset", (0, 0)), change.get("scale", (1, 1))
        angle = change.get("rotation", 0)
        c, s = math.cos(angle), math.sin(angle)
        return [(ox + c * sx * u + s * sy * v, oy - s * sx * u + c * sy * v)
                for u, v in source.accessor(primitive["attributes"][name])]

    def compare_triangles(self, source, primitives, node, mirrored, summary):
        drawn = ((p, [p.indices[i], p.indices[i + 1], p.indices[i + 2]])
                 for p in node.primitives for i in range(0, len(p.indices), 3))
        for primitive in primitives:
            positions = source.accessor(primitive["attributes"]["POSITION"])
            uvs = self.uv_source(source, primitive)
            for corners in source.triangles(primitive):
                if mirrored:
                    corners = (corners[0], corners[2], corners[1])
                step = node.primitives[0].scale / 32768
                if self.may_be_flat([positions[c] for c in corners], step):
                    continue
                baked, indices = next(drawn)
                for corner, index in zip(corners, indices):
                    for a, b in zip(ewb.position(baked, index), positions[corner]):
                        self.assertLessEqual(abs(a - b), summary["position_rounding"] * 1.000001 + 1e-12)
                        self.assertLessEqual(abs(a - b), step * 0.500001)
                    if uvs and baked.material.texture:
                        self.compare_uv(baked, index, uvs[corner], summary)
                # One move for all three corners.
                if uvs and baked.material.texture:
                    size = baked.material.texture.width, baked.material.texture.height
                    for k in (0, 1):
                        moves = {round(uvs[c][k] - ewb.texels(baked, i)[k] / size[k]) for c,
                                 i in zip(corners, indices)}
                        self.assertEqual(len(moves), 1)
        self.assertIsNone(next(drawn, None), "more triangles than in the source")

    def may_be_flat(self, points, step):
        grid = [tuple(round(x / step) for x in p) for p in points]
        return any(math.dist(grid[i], grid[i - 1]) < 2 for i in range(3))

    def compare_uv(self, baked, index, exact, summary):
        texture = baked.material.texture
        for got, want, size in zip(ewb.texels(baked, index), exact, (texture.width, texture.height)):
            error = (got - want * size + size / 2) % size - size / 2
            self.assertLessEqual(abs(error), 0.500001 / (1 << baked.bits))
            self.assertLessEqual(abs(error), summary["uv_rounding_texels"] * 1.000001 + 1e-9)


class AgainstSource(SourceTest):
    def shared(self, name):
        path = MODELS / name
        if not path.exists():
            self.skipTest(f"{name}: the folder ../shared/models is not there")
        return path

    def test_chest(self):
        baked, summary = self.compare(self.shared("chest/chest_gold.glb"), warnings=0)
        self.assertEqual(summary["triangles"], 1568)
        self.assertEqual(summary["duration_ms"], 0)
        self.assertEqual((baked.textures[0].width, baked.textures[0].height), (256, 256))

    def test_barrel_jpeg(self):
        baked, _ = self.compare(self.shared("barrel_jpeg/barrel.glb"), warnings=0)
        self.assertEqual((baked.textures[0].width, baked.textures[0].height), (128, 128))

    def test_fox(self):
        baked, summary = self.compare(self.shared("fox/Fox.glb"))
        self.assertEqual(summary["vertices"], 434)
        self.assertEqual(len(baked.tracks), 0)

    def test_character_external_texture(self):
        self.compare(self.shared("character/character.glb"), "--texture-size", "64x32")

    def test_building_quantised(self):
        self.compare(self.shared("building_quantized/building_quantized.gltf"), warnings=0)

    def test_sparse(self):
        self.compare(self.shared("sparse/SimpleSparseAccessor.gltf"), warnings=0)

    def test_feature_mix(self):
        baked, _ = self.compare(self.shared("feature_mix/feature_mix.gltf"))
        self.assertEqual(baked.duration, 2000)

    def test_speeder_drawn_once(self):
        baked, summary = self.compare(self.shared("speeder/craft_speederD.gltf"), warnings=1)
        self.assertEqual((len(baked.nodes), summary["triangles"]), (1, 322))

    def test_animated_box(self):
        self.compare(self.shared("box_animated/BoxAnimated.glb"), warnings=0)

    def test_vertex_colours_warned(self):
        self.compare(self.shared("box_vertex_colors/BoxVertexColors.gltf"), warnings=1)

    def test_unlit_blend_warned(self):
        self.compare(self.shared("unlit/01_unlit.gltf"), warnings=1)

    def test_wrap_modes_warned(self):
        self.compare(self.shared("texture_settings/TextureSettingsTest.glb"), warnings=4)

    def test_draco_refused(self):
        self.refuse(self.shared("coin_draco/coin_draco.glb"), "KHR_draco_mesh_compression", "not supported")

    def assimp(self, name):
        path = ASSIMP / name
        if not path.exists():
            self.skipTest(f"{name}: the package assimp-testmodels is not installed")
        return path

    def test_assimp_box(self):
        self.compare(self.assimp("BoxTextured-glTF-Binary/BoxTextured.glb"), warnings=0)

    def test_assimp_texture_transform(self):
        self.compare(self.assimp("textureTransform/TextureTransformTest.gltf"), warnings=6)

    def test_assimp_modes(self):
        for path in sorted(self.assimp("glTF-Asset-Generator/Mesh_PrimitiveMode").glob("*.gltf")):
            source = Gltf(path)
            if source["meshes"][0]["primitives"][0].get("mode", 4) < 4:
                self.refuse(path, "nothing to draw")
            else:
                self.compare(path, warnings=0)

    def test_assimp_cameras(self):
        baked = self.bake(self.assimp("cameras/Cameras.gltf"), warnings=("far plane", "orthographic"))
        self.assertAlmostEqual(baked.focal, 1 / math.tan(0.35), delta=1e-4)

    def test_assimp_broken(self):
        for name, reason in (("IndexOutOfRange/IndexOutOfRange.gltf", "index 255 is out of range"),
                             ("RecursiveNodes/RecursiveNodes.gltf", "own ancestor"),
                             ("BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "not a finite number"),
                             ("MissingBin/BoxTextured.gltf", "BoxTextured0.bin"),
                             ("IncorrectVertexArrays/Cube.gltf", "outside its buffer"),
                             ("draco/2CylinderEngine.gltf", "KHR_draco_mesh_compression"),
                             ("../glTF/BoxTextured-glTF-Binary/BoxTextured.glb", "glTF 1.0"),
                             ("../glTF/TwoBoxes/TwoBoxes.gltf", "glTF 1.0")):
            with self.subTest(name):
                self.refuse(self.assimp(name), reason)


class SampleScene(SourceTest):
    def test_courtyard(self):
        paths = [self.folder / "a.glb", self.folder / "b.glb"]
        runs = [subprocess.Popen([sys.executable, COURTYARD, "-o", path], stdout=subprocess.PIPE,
                                 cwd=self.folder)
                for path in paths]
        for run in runs:
            run.communicate(timeout=60)
            self.assertEqual(run.returncode, 0)
        self.assertEqual(paths[0].read_bytes(), paths[1].read_bytes())
        baked, summary = self.compare(paths[0], warnings=0)
        self.assertTrue(500 <= summary["triangles"] <= 2000, summary["triangles"])
        self.assertEqual(baked.duration, 4000)
        self.assertLess(summary["uv_rounding_texels"], 1 / 32)
        moving = [node for node in baked.nodes if node.track]
        self.assertEqual(len(moving), 1)
        keys = moving[0].track.keys
        self.assertAlmostEqual(abs(sum(a * b for a, b in zip(keys[0][1], keys[-1][1]))), 1, delta=1e-4)

    def test_courtyard_unwritable(self):
        result = subprocess.run([sys.executable, COURTYARD, "-o", self.folder / "no/such.glb"],
                                capture_output=True,
                                text=True, timeout=60, check=False)
        self.assertEqual((result.returncode, len(result.stderr.splitlines())), (1, 1))


class Output(BakeTest):
    def test_same_bytes_each_run(self):
        one = self.put("one.glb", square().glb())
        (self.folder / "sub").mkdir()
        two = self.put("sub/two.glb", square().glb())
        for path, name in ((one, "1"), (two, "2")):
            self.assertEqual(self.run_bake(path, "-o", self.folder / name).returncode, 0)
        self.assertEqual((self.folder / "1").read_bytes(), (self.folder / "2").read_bytes())

    def test_c_array(self):
        self.bake(square())
        binary = (self.folder / "out.ewb").read_bytes()
        output = self.folder / "scene.c"
        result = self.run_bake(self.folder / "in.glb", "-o", output, "--c-array", "--name", "my_scene")
        self.assertEqual(result.returncode, 0, result.stderr)
        text = output.read_text()
        words = [int(word, 16) for word in re.findall(r"0x([0-9A-F]{8}),", text)]
        self.assertEqual(struct.pack("<%dI" % len(words), *words), binary)
        self.assertIn("const uint32_t my_scene[] = {", text)
        self.assertIn(f"const size_t my_scene_size = {len(binary)};", text)
        compiler = shutil.which("cc")
        if compiler:
            subprocess.run([compiler, "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-fsyntax-only",
                            output],
                           check=True)

    def test_replaces_an_older_file(self):
        self.put("out.ewb", b"older")
        self.bake(square())

    def test_output_paths(self):
        path = self.put("in.glb", square().glb())
        for output, reason in ((self.folder, "directory"), (self.folder / "no/out.ewb", "No such file"),
                               (path / "out.ewb", "Not a directory"), ("/dev/null", "not a regular file"),
                               (path, "is the input file")):
            with self.subTest(str(output)):
                self.refuse(path, reason, output=output, names=output)
        self.assertEqual(path.read_bytes(), square().glb())

    def test_no_room_for_the_output(self):
        def small_files():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))

        path = self.put("in.glb", square().glb())
        result = subprocess.run([BAKE, path, "-o", self.folder / "out.ewb"], capture_output=True, text=True,
                                timeout=60, check=False, preexec_fn=small_files)
        self.assertEqual(result.returncode, 1)
        self.assertIn("out.ewb: cannot be written: File too large", result.stderr)
        self.assertEqual(os.listdir(self.folder), ["in.glb"])

    def test_a_failure_keeps_the_older_file(self):
        self.put("out.ewb", b"older")
        self.refuse(b"no model")
        self.assertEqual((self.folder / "out.ewb").read_bytes(), b"older")

    def test_usage(self):
        path = self.put("in.glb", square().glb())
        out = self.folder / "out.ewb"
        for arguments in ((path,), ("-o", out), (path, path, "-o", out),
                          (path, "-o", out, "--texture-size", "100"),
                          (path, "-o", out, "--texture-size",
                           "64x"), (path, "-o", out, "--texture-size", "4096"),
                          (path, "-o", out, "--texture-size", "0x0"), (path, "-o", out, "--tolerance", "0.3"),
                          (path, "-o", out, "--tolerance", "17"), (path, "-o", out, "--tolerance", "nan"),
                          (path, "-o", out, "--scene", "-1"), (path, "-o", out, "--key-interval", "0"),
                          (path, "-o", out, "--name", "x"), (path, "-o", out, "--c-array", "--name", "3x"),
                          (path, "-o", out, "--bogus")):
            with self.subTest(arguments[1:]):
                self.assertEqual(self.run_bake(*arguments).returncode, 2)
        self.assertFalse(out.exists())
        for option in ("--help", "--version"):
            self.assertEqual(self.run_bake(option).returncode, 0)


class Choices(BakeTest):
    """One feature at a time, with files made for it."""

    def test_tolerance(self):
        for text, value in (("0", 0), ("0.0625", 1 / 16), ("16", 16)):
            self.assertEqual(self.bake(square(), "--tolerance", text).materials[0].tolerance, value)
        self.assertEqual(self.bake(square()).materials[0].tolerance, 0.25)

    def test_texels_are_exact_where_nothing_is_resized(self):
        baked = self.bake(square())
        self.assertEqual(baked.textures[0].texels, [0xF800, 0x07E0, 0x001F, 0xFFFF])

    def test_resized_and_tinted_in_linear_light(self):
        generator = random.Random(5)
        for width, height, bits in ((5, 3, 8), (4, 4, 8), (3, 7, 16), (9, 2, 8), (1, 1, 8)):
            most = (1 << bits) - 1
            rows = [[[generator.randint(0, most) for _ in range(3)] for _ in range(width)]
                    for _ in range(height)]
            factor = [generator.random() for _ in range(3)]
            baked = self.bake(square(image=png(rows, bits), factor=(*factor, 1)), "--texture-size", "4x2")
            texture = baked.textures[0]
            self.assertEqual((texture.width, texture.height), ({1: 1}.get(width, 4), {1: 1}.get(height, 2)))
            for y in range(texture.height):
                for x in range(texture.width):
                    mean = self.area_mean(rows, most, x, y, texture)
                    want = rgb565([m * f for m, f in zip(mean, factor)])
                    self.assertEqual(texture.texels[y * texture.width + x], want, (width, height, x, y))

    def area_mean(self, rows, most, x, y, texture):
        """By sampling every source pixel's share of the texel's area."""
        sums, total = [0.0] * 3, 0.0
        for j, row in enumerate(rows):
            share_y = self.overlap(j, y * len(rows) / texture.height, (y + 1) * len(rows) / texture.height)
            for i, pixel in enumerate(row):
                share = share_y * self.overlap(i, x * len(row) / texture.width,
                                               (x + 1) * len(row) / texture.width)
                total += share
                sums = [s + share * linear(c / most) for s, c in zip(sums, pixel)]
        return [s / total for s in sums]

    def overlap(self, pixel, low, high):
        return max(0.0, min(high, pixel + 1) - max(low, pixel))

    def test_texture_sizes(self):
        for pixels, size in ((1, 1), (2, 2), (3, 4), (5, 4), (6, 8), (23, 16), (24, 32), (120, 64)):
            baked = self.bake(square(image=png([[(1, 2, 3)] * pixels] * 2)), "--texture-size", "64")
            self.assertEqual((baked.textures[0].width, baked.textures[0].height), (size, 2))

    def test_same_texture_and_tint_are_baked_once(self):
        builder = square()
        for factor in ((1, 1, 1, 1), (0.5, 1, 1, 1)):
            material = builder.material(0, factor, doubleSided=True)
            builder.node(mesh=builder.mesh(SQUARE, [(0, 0)] * 4, [0, 1, 2], material=material))
        baked = self.bake(builder)
        self.assertEqual((len(baked.textures), len(baked.materials)), (2, 3))
        self.assertEqual([m.double_sided for m in baked.materials], [False, True, True])

    def test_flat_colour(self):
        builder = Builder()
        builder.node(mesh=builder.mesh(SQUARE, None, [0, 1, 2],
                                       material=builder.material(None, (0.2, 0.5, 0.9, 1))))
        builder.node(mesh=builder.mesh(SQUARE, None, [0, 1, 2]))
        baked = self.bake(builder)
        self.assertEqual([m.colour for m in baked.materials], [rgb565((0.2, 0.5, 0.9)), 0xFFFF])

    def test_uv_moved_by_whole_periods(self):
        baked = self.bake(square(uv=((1000.25, -7), (1001.25, -7), (1001.25, -8), (1000.25, -8)),
                                 image=png([[(0, 0, 0)] * 64] * 64)))
        primitive = baked.primitives[0]
        self.assertGreaterEqual(primitive.bits, 9)
        for index, u in zip(primitive.indices, (0.25, 1.25, 1.25, 0.25, 1.25, 0.25)):
            self.assertEqual(ewb.texels(primitive, index)[0] % 64, 16)
            self.assertEqual((ewb.texels(primitive, index)[0] - 64 * u) % 64, 0)

    def test_uv_moved_for_each_triangle_where_one_move_is_not_enough(self):
        builder = square()
        positions, uvs, indices = [], [], []
        for k in range(100):  # 100 squares in a row, 4 repeats of 256 texels each
            positions += [(k + x, y, 0) for x, y, _ in SQUARE]
            uvs += [(4 * (k + x), 4 * y) for x, y, _ in SQUARE]
            indices += [4 * k + i for i in (0, 1, 2, 0, 2, 3)]
        texture = builder.texture(png([[(9, 9, 9)] * 256] * 256))
        builder.node(mesh=builder.mesh(positions, uvs, indices, material=builder.material(texture)))
        baked = self.bake(builder)
        self.assertGreaterEqual(baked.primitives[1].bits, 5)
        self.assertEqual(len(baked.nodes[1].primitives), 1)

    def test_uv_too_coarse_is_said(self):
        image = png([[(0, 0, 0)] * 256] * 2)
        self.bake(square(uv=((0, 0), (40, 0), (40, 1), (0, 1)), image=image),
                  warnings=("rounded to 1/4 texel",))
        self.bake(square(uv=((0, 0), (7, 0), (7, 1), (0, 1)), image=image))
        self.refuse(square(uv=((0, 0), (300, 0), (300, 1), (0, 1)), image=image), "76800 texels", "32767")

    def test_texture_transform_and_sets(self):
        info = {"texCoord": 5, "extensions": {"KHR_texture_transform": {
            "offset": [0.25, 0.5], "rotation": math.pi / 2, "scale": [0.5, 2], "texCoord": 1}}}
        builder = square(info=info)
        primitive = builder.json["meshes"][0]["primitives"][0]
        primitive["attributes"]["TEXCOORD_1"] = primitive["attributes"].pop("TEXCOORD_0")
        builder.json["extensionsRequired"] = builder.json["extensionsUsed"] = ["KHR_texture_transform"]
        baked = self.bake(builder)
        for index, (u, v) in zip(baked.indices, [(0, 1), (1, 1), (1, 0)]):
            got = ewb.texels(baked.primitives[0], index)
            want = (0.25 + 2 * v) * 2, (0.5 - 0.5 * u) * 2  # a quarter turn: u' = v, v' = -u
            self.assertEqual([(a - b) % 2 for a, b in zip(got, want)], [0, 0])

    def test_normalised_and_strided_attributes(self):
        builder = Builder()
        data = b"".join(struct.pack("<3hH2H", *(int(32767 * c) for c in p), 77, int(65535 * p[0]),
                                    int(65535 * p[1]))
                        for p in SQUARE)
        view = builder.view(data, byteStride=12)
        position = builder.add("accessors", {"bufferView": view, "componentType": 5122, "normalized": True,
                                             "count": 4,
                                             "type": "VEC3"})
        uv = builder.add("accessors", {"bufferView": view, "byteOffset": 8, "componentType": 5123,
                                       "normalized": True,
                                       "count": 4, "type": "VEC2"})
        material = builder.material(builder.texture(png([[(0, 0, 0)] * 16] * 16)))
        builder.node(mesh=builder.add("meshes", {"primitives": [{
            "attributes": {"POSITION": position, "TEXCOORD_0": uv}, "mode": 6, "material": material}]}))
        builder.json["extensionsRequired"] = ["KHR_mesh_quantization"]
        baked = self.bake(builder)
        primitive = baked.primitives[0]
        for index, corner in zip(primitive.indices, (1, 2, 0, 2, 3, 0)):
            for a, b in zip(ewb.position(primitive, index), SQUARE[corner]):
                self.assertAlmostEqual(a, b, delta=2e-5)
            for a, b in zip(ewb.texels(primitive, index), SQUARE[corner]):
                self.assertEqual(a % 16, (16 * b) % 16)

    def test_mesh_is_stored_once_and_mirrored_by_its_indices(self):
        builder = square()
        builder.node(mesh=0, scale=[-1, 1, 1])
        builder.node(mesh=0, scale=[-1, -1, 1])
        baked = self.bake(builder)
        self.assertEqual(len(baked.vertices), 4)
        front, back = [0, 1, 2, 0, 2, 3], [0, 2, 1, 0, 3, 2]
        self.assertEqual([n.primitives[0].indices for n in baked.nodes], [front, back, front])

    def test_shared_corners_of_two_materials_stay_together(self):
        builder = Builder()
        third = 1 / 3
        one = builder.mesh([(0, 0, 0), (third, 0, 0), (third, 1, 0)], None, [0, 1, 2])
        two = builder.mesh([(third, 0, 0), (100, 0, 0), (third, 1, 0)], None, [0, 1, 2],
                           material=builder.material())
        builder.json["meshes"][one]["primitives"] += builder.json["meshes"].pop(two)["primitives"]
        builder.node(mesh=one)
        baked = self.bake(builder)
        a, b = baked.primitives
        self.assertEqual(ewb.position(a, 1), ewb.position(b, 0))
        self.assertEqual(ewb.position(a, 2), ewb.position(b, 2))

    def test_more_than_65535_vertices_are_split(self):
        builder = Builder()
        side = 270
        positions = [(x, y, 0) for y in range(side) for x in range(side)]
        indices = []
        for y in range(side - 1):
            for x in range(side - 1):
                i = y * side + x
                indices += [i, i + 1, i + side, i + 1, i + side + 1, i + side]
        mesh = builder.mesh(positions)
        accessor = builder.accessor([(i,) for i in indices], "SCALAR", 5125)
        builder.json["meshes"][mesh]["primitives"][0]["indices"] = accessor
        builder.node(mesh=mesh)
        baked = self.bake(builder)
        self.assertEqual(len(baked.primitives), 2)
        self.assertEqual(len(baked.indices), len(indices))
        flat = [tuple(round(c) for c in ewb.position(p, i)) for p in baked.primitives for i in p.indices]
        self.assertEqual(flat, [positions[i] for i in indices])

    def test_flat_triangles_are_counted(self):
        builder = Builder()
        builder.node(mesh=builder.mesh(SQUARE, None, [0, 1, 2, 0, 0, 1, 2, 1, 2]))
        baked = self.bake(builder)
        self.assertEqual(len(baked.indices), 3)
        self.assertIn("2 triangles", self.stdout)

    def test_small_mesh_far_from_its_origin(self):
        builder = Builder()
        far = [(1000 + x / 1024, 2000 + y / 1024, z) for x, y, z in SQUARE]
        builder.node(mesh=builder.mesh(far, None, [0, 1, 2, 0, 2, 3]))
        baked = self.bake(builder)
        for index, corner in zip(range(4), far):
            for a, b in zip(ewb.position(baked.primitives[0], index), corner):
                self.assertAlmostEqual(a, b, delta=2e-6)

    def test_scene_option(self):
        builder = square()
        builder.json["scenes"].append({"nodes": [builder.node(root=False, mesh=0, translation=[5, 0, 0])]})
        self.assertEqual(self.bake(builder, "--scene", "1").nodes[0].local[0][3], 5)
        self.refuse(builder, "scene 2", "does not exist", options=("--scene", "2"))

    def test_warnings(self):
        def changed(change):
            builder = square()
            change(builder, builder.json["meshes"][0]["primitives"][0])
            return builder

        def colours(b, p):
            p["attributes"]["COLOR_0"] = b.accessor([(1, 1, 1)] * 4, "VEC3")

        def points(b, p):
            b.json["meshes"][0]["primitives"].append({"attributes": p["attributes"], "mode": 0})

        def targets(_, p):
            p["targets"] = [{"POSITION": p["attributes"]["POSITION"]}]

        def lights(b, _):
            b.json["extensionsUsed"] = ["KHR_lights_punctual"]
            b.json["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}

        def skin(b, _):
            b.json["skins"] = [{"joints": [0]}]
            b.json["nodes"][0]["skin"] = 0

        def unknown(b, _):
            b.json["extensionsUsed"] = ["KHR_materials_clearcoat"]

        def odd(b, p):
            p["indices"] = b.accessor([(i,) for i in (0, 1, 2, 0, 2)], "SCALAR", 5121)

        def no_uv(_, p):
            del p["attributes"]["TEXCOORD_0"]

        def material(**more):
            return lambda b, _: b.json["materials"][0].update(more)

        cases = ((colours, "vertex colours"), (points, "points"), (targets, "morph targets"),
                 (lights, "lights"),
                 (skin, "skin"), (unknown, "KHR_materials_clearcoat"), (odd, "the last 2 of its vertices"),
                 (no_uv, "no texture coordinates"), (material(alphaMode="BLEND"), "transparent"),
                 (material(alphaMode="MASK"), "mask"), (material(emissiveFactor=[1, 0, 0]), "emissive"))
        for change, warning in cases:
            with self.subTest(warning):
                self.bake(changed(change), warnings=(warning,))

    def test_wrap_modes_warn_only_where_they_matter(self):
        for mode, word in ((33071, "clamped"), (33648, "mirrored")):
            for reach, warnings in ((1, ()), (1.5, (f"{word} in u",))):
                builder = square(uv=((0, 0), (reach, 0), (reach, 1), (0, 1)))
                builder.json["samplers"] = [{"wrapS": mode, "magFilter": 9729, "minFilter": 9987}]
                builder.json["textures"][0]["sampler"] = 0
                self.bake(builder, warnings=warnings)


class Cameras(BakeTest):
    def test_default_frames_the_bounding_sphere(self):
        builder = square(node={"translation": [10, 20, 30], "scale": [2, 3, 4]})
        baked = self.bake(builder)
        self.assertIn("45 degrees", self.stdout)
        radius = math.hypot(1, 1.5)
        for a, b in zip(baked.centre + [baked.radius], (11, 21.5, 30, radius)):
            self.assertAlmostEqual(a, b, delta=1e-3)
        distance = baked.radius / math.sin(math.radians(22.5))
        for a, b in zip(ewb.transform(baked.view, baked.centre), (0, 0, -distance)):
            self.assertAlmostEqual(a, b, delta=1e-4)
        self.assertAlmostEqual(baked.focal, 1 / math.tan(math.radians(22.5)), delta=1 / 65536)
        self.assertAlmostEqual(baked.near, distance / 20, delta=1e-5)
        direction = [c / math.hypot(0.5, 0.35, 1) for c in (0.5, 0.35, 1)]
        for a, b in zip(baked.view[2][:3], direction):
            self.assertAlmostEqual(a, b, delta=1e-6)
        self.assertEqual(round(baked.view[0][1], 8), 0)

    def test_bounds_hold_every_vertex(self):
        builder = square(node={"rotation": [0.5, 0.5, 0.5, 0.5], "translation": [1e4, 0, -1e4],
                               "scale": [1, 50, 1]})
        baked = self.bake(builder)
        for i, node in enumerate(baked.nodes):
            for primitive in node.primitives:
                for index in range(primitive.vertex_count):
                    point = ewb.transform(baked.world(i), ewb.position(primitive, index))
                    self.assertLessEqual(math.dist(point, baked.centre), baked.radius)

    def test_camera_of_the_file(self):
        builder = square()
        camera = builder.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.01}})
        half = math.sqrt(0.5)  # a quarter turn to the left: looks along -x
        builder.node(root=False, camera=camera, rotation=[0, half, 0, half], translation=[1, 0, 0])
        builder.node(children=[1], scale=[2, 2, 2], translation=[0, 3, 0])
        baked = self.bake(builder)
        for a, b in zip(ewb.transform(baked.view, (1.5, 3, 0)), (0, 0, -0.5)):
            self.assertAlmostEqual(a, b, delta=1e-6)
        for a, b in zip(ewb.transform(baked.view, (1, 3.25, -2)), (2, 0.25, -1)):
            self.assertAlmostEqual(a, b, delta=1e-6)
        self.assertAlmostEqual(baked.focal, 1 / math.tan(0.4), delta=1 / 65536)
        self.assertAlmostEqual(baked.near, 0.01, delta=1e-9)

    def test_far_plane_and_second_camera_warned(self):
        builder = square()
        for far in ({"zfar": 10}, {}):
            camera = builder.add("cameras", {"type": "perspective",
                                             "perspective": {"yfov": 1, "znear": 1, **far}})
            builder.node(camera=camera)
        self.bake(builder, warnings=("far plane", "a further camera"))

    def test_orthographic_refused(self):
        builder = square()
        builder.node(camera=builder.add("cameras", {"type": "orthographic", "orthographic": {
            "xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 10}}))
        self.refuse(builder, "camera 0", "orthographic")

    def test_bad_numbers_refused(self):
        for change, reason in (({"yfov": 0}, "yfov"), ({"yfov": 4}, "yfov"), ({"znear": 0}, "znear"),
                               ({"znear": -1}, "znear"), ({"yfov": 1e-9}, "field of view")):
            builder = square()
            builder.node(camera=builder.add("cameras", {"type": "perspective",
                                                        "perspective": {"yfov": 1, "znear": 1, **change}}))
            self.refuse(builder, "camera", reason)


class Movement(BakeTest):
    def moving(self, path, times, values, interpolation="LINEAR", **node):
        builder = square(node=node)
        kind = "VEC4" if path == "rotation" else "VEC3"
        sampler = {"input": builder.accessor([(t,) for t in times], "SCALAR"),
                   "output": builder.accessor(values, kind), "interpolation": interpolation}
        builder.add("animations", {"samplers": [sampler],
                                   "channels": [{"sampler": 0, "target": {"node": 0, "path": path}}]})
        return builder

    def test_rotation_takes_the_shortest_path(self):
        def turn(degrees, sign=1):
            half = math.radians(degrees) / 2
            return [0, sign * math.sin(half), 0, sign * math.cos(half)]

        times, values = [0.1, 0.5, 1.0], [turn(0), turn(170, -1), turn(100)]
        baked = self.bake(self.moving("rotation", times, values))
        track = baked.nodes[0].track
        self.assertEqual((baked.duration, track.interval, len(track.keys)), (1000, 32, 33))
        for k, (_, q, _) in enumerate(track.keys):
            t = min(max(k * 0.032, 0.1), 1.0)
            i = 0 if t < 0.5 else 1
            exact = slerp(values[i], values[i + 1], (t - times[i]) / (times[i + 1] - times[i]))
            sign = math.copysign(1, sum(a * b for a, b in zip(q, exact)))
            for a, b in zip(q, exact):
                self.assertAlmostEqual(a, sign * b, delta=0.501 / 16384)

    def test_translation_step_and_clamp(self):
        baked = self.bake(self.moving("translation", [0.5, 1.0], [(1, 2, 3), (4, 5, 6)], "STEP"),
                          "--key-interval", "100")
        keys = [key[0] for key in baked.nodes[0].track.keys]
        self.assertEqual(keys, [[1, 2, 3]] * 10 + [[4, 5, 6]])
        self.assertEqual(baked.nodes[0].local, trs((1, 2, 3), (0, 0, 0, 1), (1, 1, 1)))

    def test_cubic_spline(self):
        rows = [(0, 0, 0), (0, 0, 0), (8, 0, 0), (-8, 0, 0), (2, 0, 0), (0, 0, 0)]
        baked = self.bake(self.moving("translation", [0, 0.5], rows, "CUBICSPLINE"), "--key-interval", "125")
        for k, ((x, _, _), _, _) in enumerate(baked.nodes[0].track.keys):
            s = k / 4
            exact = 0.5 * 8 * (s**3 - 2 * s**2 + s) + 2 * (3 * s**2 - 2 * s**3) + 0.5 * -8 * (s**3 - s**2)
            self.assertAlmostEqual(x, exact, delta=1e-8)

    def test_scale_and_resting_values(self):
        baked = self.bake(self.moving("scale", [0, 1], [(1, 1, 1), (3, 2, 1)], translation=[7, 0, 0]))
        first, last = baked.nodes[0].track.keys[0], baked.nodes[0].track.keys[-1]
        self.assertEqual((first[0], first[2]), ([7, 0, 0], [1, 1, 1]))
        self.assertEqual((last[0], last[2]), ([7, 0, 0], [3, 2, 1]))

    def test_growing_from_nothing_keeps_its_front(self):
        for sign, indices in ((1, [0, 1, 2, 0, 2, 3]), (-1, [0, 2, 1, 0, 3, 2])):
            builder = self.moving("scale", [0, 1], [(0, 0, 0), (sign, 1, 1)])
            builder.node(mesh=0)  # so that there is something to see at time 0
            self.assertEqual(self.bake(builder).nodes[0].primitives[0].indices, indices)

    def test_turning_inside_out_is_warned(self):
        self.bake(self.moving("scale", [0, 1], [(1, 1, 1), (-1, 1, 1)]), warnings=("mirrors itself",))

    def test_nothing_moves(self):
        baked = self.bake(self.moving("translation", [0, 1], [(1, 0, 0), (1, 0, 0)]))
        self.assertEqual((len(baked.tracks), baked.duration), (0, 0))
        self.assertEqual(baked.nodes[0].local[0][3], 1)

    def test_warned_and_left_out(self):
        builder = self.moving("translation", [0, 1], [(0, 0, 0), (1, 0, 0)])
        channels = builder.json["animations"][0]["channels"]
        channels.append({"sampler": 0, "target": {"node": 0, "path": "weights"}})
        channels.append({"sampler": 0, "target": {"node": 0, "path": "translation"}})
        builder.add("animations", {"samplers": [], "channels": []})
        self.bake(builder, warnings=("animation 1", "weights", "channel before it"))

    def test_animated_camera_warned(self):
        builder = self.moving("translation", [0, 1], [(0, 0, 0), (1, 0, 0)])
        camera = builder.add("cameras", {"type": "perspective", "perspective": {"yfov": 1, "znear": 1}})
        builder.json["nodes"][0]["camera"] = camera
        self.bake(builder, warnings=("is animated",))

    def test_refused(self):
        nan, one = float("nan"), [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
        cases = ((self.moving("translation", [1, 0], [(0, 0, 0)] * 2), "decrease"),
                 (self.moving("translation", [-1, 0], [(0, 0, 0)] * 2), "below 0"),
                 (self.moving("translation", [0, 1], [(0, 0, 0)] * 3), "one value for each"),
                 (self.moving("translation", [0, 1], [(0, 0, 0), (nan, 0, 0)]), "finite"),
                 (self.moving("rotation", [0, 1], [(0, 0, 0, 1), (0, 0, 0, 0)]), "no length"),
                 (self.moving("translation", [0, 1e6], [(0, 0, 0), (1, 0, 0)]), "--key-interval"),
                 (self.moving("translation", [0, 1], [(0, 0, 0)] * 2, "BEZIER"), "BEZIER"),
                 (self.moving("scale", [0, 1], [(1, 1, 1)] * 2, matrix=one), "has a matrix"))
        for builder, reason in cases:
            with self.subTest(reason):
                self.refuse(builder, reason)


class BadInput(BakeTest):
    def test_no_model(self):
        self.refuse(self.folder / "missing.glb", "No such file")
        self.refuse(self.put("empty.glb", b""), "is empty")
        self.refuse(self.folder, "is a directory", output=self.folder / "x")
        for content in (b"\x89PNG\r\n\x1a\n" + bytes(40), b"hello, world", b"\xff" * 100, b"   \n", b"[1]",
                        bytes(1000)):
            self.refuse(self.put("junk.glb", content), "not a glTF file")
        if hasattr(os, "mkfifo"):
            os.mkfifo(self.folder / "fifo")
            self.refuse(self.folder / "fifo", "not a regular file")

    def test_truncated_anywhere(self):
        binary = square().glb()
        for size in sorted({*range(1, 60), *range(60, len(binary), 97), len(binary) - 1}):
            self.refuse(self.put("cut.glb", binary[:size]))
        text = self.as_text(square())
        for size in range(1, len(text), 67):
            self.refuse(self.put("cut.gltf", text[:size]))

    def as_text(self, builder):
        uri = "data:application/octet-stream;base64," + base64.b64encode(builder.binary).decode()
        builder.json["buffers"] = [{"byteLength": len(builder.binary), "uri": uri}]
        return json.dumps(builder.json)

    def test_container(self):
        binary = square().glb()
        for at, value, reason in ((4, 1, "glTF 1.0"), (4, 3, "version 3"), (8, len(binary) + 4, "truncated"),
                                  (12, 0xFFFFFFF0, "JSON chunk"), (12, 4, "not a valid"),
                                  (16, 0x12345678, "not JSON")):
            changed = bytearray(binary)
            struct.pack_into("<I", changed, at, value)
            self.refuse(bytes(changed), reason)

    def changed(self, change):
        builder = square()
        change(builder.json)
        return builder

    def test_crafted(self):
        """One broken promise each; the reason must name it."""
        def put(kind, number, **items):
            return lambda j: j[kind][number].update(items)

        deep = "x"
        for _ in range(20000):
            deep = [deep]
        nodes = {"children": [0]}
        cases = (
            (lambda j: j["asset"].update(version="1.0"), "glTF 1.0"),
            (lambda j: j["asset"].update(version="3.0"), "asset.version"),
            (lambda j: j.pop("asset"), "asset.version"),
            (lambda j: j.update(extensionsRequired=["KHR_texture_basisu"]), "extension KHR_texture_basisu"),
            (lambda j: j.update(extensionsRequired=["EXT_a", "KHR_mesh_quantization"]), "extension EXT_a"),
            (lambda j: j["scenes"][0].update(nodes=[]), "nothing to draw"),
            (lambda j: j["scenes"][0].update(nodes=[9]), "node 9"),
            (lambda j: j["scenes"][0].update(nodes=[-2]), "node -2"),
            (put("nodes", 0, mesh=7), "mesh 7"),
            (put("nodes", 0, children=[0]), "own ancestor"),
            (put("nodes", 0, children=[5]), "child 5"),
            (lambda j: (j["nodes"].append(nodes), j["nodes"][0].update(children=[1])), "own ancestor"),
            (lambda j: j["nodes"].extend([{"children": [0]}, {"children": [0]}]),
             "is a child of node 1 and of node 2"),
            (put("nodes", 0, camera=0), "camera 0 does not exist"),
            (put("nodes", 0, rotation=[0, 0, 0, 0]), "rotation"),
            (put("nodes", 0, translation=[1, 2]), "translation"),
            (put("nodes", 0, matrix=[1] * 15), "matrix"),
            (put("nodes", 0, matrix=[1] * 16), "0 0 0 1"),
            (put("nodes", 0, scale=[0, 0, 0]), "no finite space"),
            (put("accessors", 0, count=5), "ends outside its buffer view"),
            (put("accessors", 0, count=2**62), "elements"),
            (put("accessors", 0, byteOffset=2**63), "ends outside its buffer view"),
            (put("accessors", 0, bufferView=99), "buffer view 99"),
            (put("accessors", 0, componentType=5130), "component type 5130"),
            (put("accessors", 0, type="VEC2"), "3 components"),
            (put("accessors", 0, sparse={"count": 9, "indices": {"bufferView": 0, "componentType": 5123},
                                         "values": {"bufferView": 0}}), "sparse"),
            (put("accessors", 0, sparse={"count": 1,
                                         "indices": {"bufferView": 0, "componentType": 5123,
                                                     "byteOffset": -4},
                                         "values": {"bufferView": 0}}), "sparse"),
            (put("accessors", 2, componentType=5126, count=3), "unsigned integers"),
            (put("bufferViews", 1, byteLength=2**40), "outside its buffer"),
            (put("bufferViews", 1, byteOffset=2**64 - 8), "outside its buffer"),
            (put("bufferViews", 1, buffer=4), "buffer 4"),
            (put("bufferViews", 1, byteStride=4), "stride"),
            (put("materials", 0, alphaMode="SOLID"), "SOLID"),
            (lambda j: j["materials"][0]["pbrMetallicRoughness"].update(baseColorFactor=[2, 0, 0, 1]),
             "colour factor"),
            (lambda j: j["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].update(index=3),
             "texture 3"),
            (put("textures", 0, source=6), "image"),
            (put("textures", 0, sampler=6), "sampler"),
            (put("images", 0, bufferView=6), "bufferView"),
            (put("images", 0, bufferView=1), "neither PNG nor JPEG"),
            (lambda j: j["meshes"][0]["primitives"][0].update(material=8), "material 8"),
            (lambda j: j["meshes"][0]["primitives"][0].update(mode=9), "mode 9"),
            (lambda j: j["meshes"][0]["primitives"][0].update(indices=88), "out of bounds"),
            (lambda j: j["meshes"][0]["primitives"][0]["attributes"].update(POSITION=88), "accessor 88"),
            (lambda j: j.update(extras={"deep": deep}), "nested deeper than 64"),
            (lambda j: j["nodes"][0].update(name="a\nb\x1b[2J", mesh=70), "mesh 70"),
        )
        limit = sys.getrecursionlimit()
        sys.setrecursionlimit(100000)
        self.addCleanup(sys.setrecursionlimit, limit)
        for i, (change, reason) in enumerate(cases):
            with self.subTest(f"{i}: {reason}"):
                self.refuse(self.changed(change), reason)

    def test_nesting_limit(self):
        for levels, good in ((63, True), (64, False)):  # the file's own object is one more
            value = 0
            for _ in range(levels):
                value = [value]
            builder = self.changed(lambda j, v=value: j.update(extras=v))
            if good:
                self.bake(builder)
            else:
                self.refuse(builder, "nested deeper")

    def test_index_out_of_range(self):
        builder = Builder()
        builder.node(mesh=builder.mesh(SQUARE, None, [0, 1, 4]))
        self.refuse(builder, "mesh 0", "index 4 is out of range", "4 vertices")

    def test_numbers_that_are_none(self):
        for value in (float("nan"), float("inf"), -float("inf")):
            builder = Builder()
            builder.node(mesh=builder.mesh([(0, 0, 0), (1, 0, 0), (0, value, 0)]))
            self.refuse(builder, "mesh 0", "not a finite number")
            self.refuse(square(uv=((0, 0), (value, 0), (1, 1), (0, 1))), "not a finite number")
        text = self.as_text(square()).replace('"mesh": 0', '"mesh": 0, "scale": [1e999, 1, 1]')
        self.refuse(self.put("big.gltf", text), "not a valid glTF file")

    def test_huge_numbers(self):
        builder = Builder()
        builder.node(mesh=builder.mesh([(0, 0, 0), (3e38, 0, 0), (0, 3e38, 0)]), scale=[1e300, 1e300, 1e300])
        self.refuse(builder)
        self.refuse(square(uv=((0, 0), (3e38, 0), (1, 1), (0, 1))), "texels")

    def external(self, uri, kind="buffers"):
        builder = square()
        if kind == "buffers":
            builder.json["buffers"] = [{"byteLength": len(builder.binary), "uri": uri}]
        else:
            self.as_text(builder)
            builder.json["images"] = [{"uri": uri}]
        return json.dumps(builder.json)

    def test_external_files(self):
        builder = square()
        (self.folder / "in").mkdir()
        (self.folder / "in/sub dir").mkdir()
        self.put("in/sub dir/a.bin", builder.binary)
        self.put("outside.bin", builder.binary)
        self.put("in/red.png", png([[(255, 0, 0)]]))
        (self.folder / "in/link.bin").symlink_to("../outside.bin")
        self.bake(self.put("in/good.gltf", self.external("sub%20dir/a.bin")))
        self.bake(self.put("in/good.gltf", self.external("./sub%20dir/../sub%20dir/a.bin")))
        self.assertEqual(self.bake(self.put("in/good.gltf", self.external("red.png", "images"))).texels,
                         [0xF800])
        cases = (("../outside.bin", "leaves the folder"), ("%2e%2e/outside.bin", "leaves the folder"),
                 ("sub%20dir/../../outside.bin", "leaves the folder"), ("link.bin", "leaves the folder"),
                 (str(self.folder / "outside.bin"), "relative"), ("file:///etc/passwd", "relative"),
                 ("http://example.org/a.bin", "relative"), ("..\\outside.bin", "relative"),
                 ("sub%20dir", "is a directory"), ("missing.bin", "No such file"), ("red.png", ""),
                 ("data:model/x;base64,AAAA", "data URI"))
        for kind in ("buffers", "images"):
            for uri, reason in cases:
                if (kind, uri) == ("images", "red.png"):
                    continue
                with self.subTest(f"{kind} {uri}"):
                    self.refuse(self.put("in/bad.gltf", self.external(uri, kind)), reason)

    def test_pictures(self):
        good = png([[(1, 2, 3)] * 8] * 8)
        huge = bytearray(good)
        struct.pack_into(">II", huge, 16, 20000, 8)
        many = bytearray(good)
        struct.pack_into(">II", many, 16, 16384, 16384)
        none = bytearray(good)
        struct.pack_into(">II", none, 16, 0, 8)
        for image, reason in ((bytes(huge), "20000x8"), (bytes(many), "16384x16384"),
                              (bytes(none), "no size"),
                              (good[:40], "cannot be decoded"),
                              (b"GIF89a" + bytes(40), "neither PNG nor JPEG"),
                              (b"\xff\xd8\xff\xe0\x00\x10JFIF" + bytes(20),
                               "cannot be decoded"), (b"x", "neither")):
            with self.subTest(reason):
                self.refuse(square(image=image), "image 0", reason)

    def test_flipped_bytes(self):
        """Whatever happens to a file, it is refused in one line or baked into a good scene."""
        seed = int(os.environ.get("EW_SEED", "1"))
        generator = random.Random(seed)
        binary = square().glb()
        for case in range(250):
            changed = bytearray(binary)
            for _ in range(generator.choice((1, 1, 2, 5, 20))):
                changed[generator.randrange(len(changed))] = generator.randrange(256)
            result = self.run_bake(self.put("flip.glb", bytes(changed)), "-o", self.folder / "out.ewb")
            with self.subTest(f"seed {seed}, case {case}"):
                self.assertIn(result.returncode, (0, 1), result.stderr)
                if result.returncode == 0:
                    ewb.Scene((self.folder / "out.ewb").read_bytes())
                else:
                    self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)


def load_tests(loader, tests, pattern):
    if not BAKE.exists():
        print(f"test_bake: {BAKE} is not there, build it first or set EW_BIN", file=sys.stderr)
        sys.exit(1)
    del loader, pattern
    return tests


if __name__ == "__main__":
    unittest.main()
