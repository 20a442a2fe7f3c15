"""Real models and our own scene, baked, drawn and held against the referee; ew-render."""
import os
import re
import subprocess
import tempfile
import unittest

from png import png_pixels

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.path.join(ROOT, os.environ.get("EW_BIN", "build/release/bin"))
SHARED = os.path.join(ROOT, "../shared/models")
ASSIMP = "/usr/share/assimp/models"


def run(tool, *arguments):
    return subprocess.run([os.path.join(BIN, tool), *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True, timeout=300)


class Models(unittest.TestCase):
    """Golden checks: no wrong pixel, no wrong colour, depth within a unit of what is exact
    within 1/256 px (models have bevels seen edge-on, a few thousandths of a pixel wide and
    hundreds of units deep); at tolerance 0 u and v within 1/16 texel rms."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def baked(self, model):
        scene = os.path.join(self.folder.name, re.sub(r"\W", "_", model) + ".ewb")
        if not os.path.exists(scene):
            done = run("ew-bake", model, "-o", scene)
            self.assertEqual(done.returncode, 0, done.stderr)
        return scene

    def hold(self, model, *options):
        if not os.path.exists(model):
            self.skipTest(f"{os.path.relpath(model, ROOT) if model.startswith(ROOT) else model} is not there")
        scene = self.baked(model)
        for extra in ([], ["--exact"]):
            done = run("ew-accuracy", scene, "--frames", "5", *options, *extra)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            found = re.search(r": (\d+) fragments, (\d+) wrong pixels, (\d+) hit twice, (\d+) of a colour", done.stdout)
            self.assertGreater(int(found.group(1)), 5000, "hardly anything was drawn")
            self.assertEqual(found.group(2, 3, 4), ("0", "0", "0"))
            u, v, beyond, depth, vertex = map(float, re.search(
                r"rms u ([\d.]+) v ([\d.]+), .*, ([\d.]+) beyond the tolerance; depth worst [\d.]+ units, ([\d.]+) over .*; vertices within ([\d.]+) ",
                done.stdout).groups())
            self.assertLessEqual(depth, 1)
            self.assertLessEqual(beyond, 1 / 64)
            self.assertLessEqual(vertex, 0.75)
            if extra:
                self.assertLessEqual(max(u, v), 1 / 16)

    def test_memory_modes(self):
        """Every model, three frames: in bands and line by line, with room and without."""
        models = [os.path.join(SHARED, name) for name in (
            "chest/chest_gold.glb", "barrel_jpeg/barrel.glb", "fox/Fox.glb", "box_animated/BoxAnimated.glb",
            "character/character.glb", "speeder/craft_speederD.gltf", "building_quantized/building_quantized.gltf",
            "cubic_mixed/03_all_animations.gltf", "texture_settings/TextureSettingsTest.glb", "feature_mix/feature_mix.gltf")]
        models = [model for model in models if os.path.exists(model)]
        if not models:
            self.skipTest("the folder ../shared/models is not there")
        for model in models:
            scene, files = self.baked(model), []
            for options in ([], ["--rows", "1"], ["--rows", "1", "--active", "0"], ["--rows", "8"], ["--rows", "37", "--active", "3"]):
                files.append(os.path.join(self.folder.name, f"mode-{len(files)}.png"))
                done = run("ew-render", scene, "-o", files[-1], "--size", "200x123", "--frames", "3", "--fps", "3", "-a", *options)
                self.assertEqual(done.returncode, 0, done.stderr)
                with open(files[0], "rb") as at_once, open(files[-1], "rb") as banded, self.subTest(model=model, options=options):
                    self.assertTrue(at_once.read() == banded.read())

    def test_span_visibility(self):
        """Baked materials are opaque: one picture in any memory and bands."""
        models = [os.path.join(SHARED, name) for name in ("box_animated/BoxAnimated.glb", "chest/chest_gold.glb", "fox/Fox.glb")]
        models = [model for model in models if os.path.exists(model)]
        if not models:
            self.skipTest("the folder ../shared/models is not there")
        for model in models:
            scene, files = self.baked(model), []
            for options in ([], ["--rows", "1", "--active", "0"], ["--rows", "8"], ["--rows", "37", "--active", "3"]):
                files.append(os.path.join(self.folder.name, f"spans-{len(files)}.png"))
                done = run("ew-render", scene, "-o", files[-1], "--size", "200x123", "--frames", "3", "--fps", "3", "-a",
                           "--visibility", "spans", *options)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertRegex(done.stdout, r"\d+ crossings, \d+ sections")
                with open(files[0], "rb") as first, open(files[-1], "rb") as other, self.subTest(model=model, options=options):
                    self.assertTrue(first.read() == other.read())
        self.assertEqual(run("ew-render", scene, "--visibility", "z").returncode, 2)

    def test_courtyard(self):
        scene = os.path.join(self.folder.name, "courtyard.glb")
        subprocess.run(["python3", os.path.join(ROOT, "examples/scenes/courtyard.py"), "-o", scene], check=True,
                       stdout=subprocess.DEVNULL)
        self.hold(scene)
        self.hold(scene, "--size", "131x97")

    def test_chest(self):
        self.hold(os.path.join(SHARED, "chest/chest_gold.glb"))

    def test_barrel(self):
        self.hold(os.path.join(SHARED, "barrel_jpeg/barrel.glb"))

    def test_fox(self):
        self.hold(os.path.join(SHARED, "fox/Fox.glb"))

    def test_box_textured(self):
        self.hold(os.path.join(ASSIMP, "glTF2/BoxTextured-glTF-Binary/BoxTextured.glb"))

    def test_other_shared_models(self):
        for name in ("box_animated/BoxAnimated.glb", "character/character.glb", "speeder/craft_speederD.gltf",
                     "building_quantized/building_quantized.gltf", "cubic_mixed/03_all_animations.gltf",
                     "texture_settings/TextureSettingsTest.glb", "feature_mix/feature_mix.gltf"):
            with self.subTest(name):
                self.hold(os.path.join(SHARED, name), "--size", "160x120", "--every", "2")


class Render(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.scene = os.path.join(cls.folder.name, "courtyard.ewb")
        model = os.path.join(cls.folder.name, "courtyard.glb")
        subprocess.run(["python3", os.path.join(ROOT, "examples/scenes/courtyard.py"), "-o", model], check=True,
                       stdout=subprocess.DEVNULL)
        run("ew-bake", model, "-o", cls.scene)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def test_one_frame_of_the_size_asked_for(self):
        done = run("ew-render", self.scene, "-o", self.path("one.png"), "--size", "33x21")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        size, rows = png_pixels(self.path("one.png"))
        self.assertEqual(size, (33, 21))
        self.assertGreater(len(set(b"".join(rows)[i:i + 3] for i in range(0, 33 * 21 * 3, 3))), 50)

    def test_the_readme_shows_what_is_drawn(self):
        run("ew-render", self.scene, "-o", self.path("now.png"))
        self.assertEqual(png_pixels(self.path("now.png")), png_pixels(os.path.join(ROOT, "docs/courtyard.png")))

    def test_frames_are_numbered_and_move(self):
        done = run("ew-render", self.scene, "--output", self.path("f.png"), "--size", "80x60", "--frames", "3", "--fps", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        pictures = [png_pixels(self.path(f"f-000{i}.png"))[1] for i in range(3)]
        self.assertNotEqual(pictures[0], pictures[1])
        self.assertNotEqual(pictures[1], pictures[2])
        self.assertFalse(os.path.exists(self.path("f-0003.png")))

    def test_bands_are_one_picture(self):
        done = run("ew-render", self.scene, "-o", self.path("line.png"), "--rows", "1", "--active", "20")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, r"line\.png: bands of 1 rows in \d+ bytes, \d+ triangles active at most, [1-9]\d* of \d+ set-ups")
        self.assertEqual(png_pixels(self.path("line.png")), png_pixels(os.path.join(ROOT, "docs/courtyard.png")))
        for option, value in (("--rows", "0"), ("--rows", "4097"), ("--rows", "x"), ("--active", "-1")):
            self.assertEqual(run("ew-render", self.scene, option, value).returncode, 2)

    def test_an_animation_starts_with_the_first_frame(self):
        run("ew-render", self.scene, "-o", self.path("a.png"), "--size", "40x30", "--frames", "4", "--animation")
        run("ew-render", self.scene, "-o", self.path("b.png"), "--size", "40x30")
        with open(self.path("a.png"), "rb") as f:
            data = f.read()
        self.assertEqual((data.count(b"acTL"), data.count(b"fcTL"), data.count(b"fdAT")), (1, 4, 3))
        self.assertEqual(png_pixels(self.path("a.png")), png_pixels(self.path("b.png")))

    def test_help_and_version(self):
        for tool in ("ew-render", "ew-accuracy"):
            for option in ("--help", "--version"):
                done = run(tool, option)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertIn(tool if option == "--version" else "--size", done.stdout)

    def assert_fails(self, status, *arguments, says):
        done = run("ew-render", *arguments)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        self.assertIn(says, done.stderr)
        if status == 1:
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
            self.assertTrue(done.stderr.startswith("ew-render: "))
        self.assertEqual([n for n in os.listdir(self.folder.name) if n.endswith(".part") or n == "no.png"], [])

    def test_wrong_usage(self):
        out = ("-o", self.path("no.png"))
        for size in ("0x0", "99999x99999", "4097x1", "1x0", "12", "x", "-1x5", "3x4x5", "3 x4", " 3x4", ""):
            with self.subTest(size):
                self.assert_fails(2, self.scene, "--size", size, *out, says="--size")
        self.assert_fails(2, self.scene, "--frames", "0", *out, says="--frames")
        self.assert_fails(2, self.scene, "--fps", "x", *out, says="--fps")
        self.assert_fails(2, *out, says="no scene given")
        self.assert_fails(2, self.scene, self.scene, *out, says="one scene only")
        self.assert_fails(2, self.scene, "--wrong", *out, says="--wrong")

    def test_bad_scenes(self):
        out = ("-o", self.path("no.png"))
        self.assert_fails(1, self.path("missing.ewb"), *out, says="missing.ewb: cannot open the scene: No such file")
        self.assert_fails(1, self.folder.name, *out, says="it is a directory")
        with open(self.scene, "rb") as f:
            good = f.read()
        cases = {"empty": (b"", "empty"), "model": (b"glTF\2\0\0\0and so on", "a glTF model, for ew-bake to bake"), "text": (b"hello, world, this is not a scene", "not an edgewalk file"),
                 "short": (good[:-1], "cut short"), "head": (good[:40], "cut short"),
                 "changed": (good[:5000] + bytes([good[5000] ^ 4]) + good[5001:], "wrong checksum"),
                 "version": (good[:4] + b"\2\0" + good[6:], "version")}
        for name, (data, says) in cases.items():
            with self.subTest(name):
                with open(self.path(name), "wb") as f:
                    f.write(data)
                self.assert_fails(1, self.path(name), *out, says=says)

    def test_bad_outputs(self):
        self.assert_fails(1, self.scene, "-o", self.path("none/no.png"), says="cannot be written: No such file")
        os.makedirs(self.path("folder.png"), exist_ok=True)
        self.assert_fails(1, self.scene, "-o", self.path("folder.png"), says="cannot be written: Is a directory")
        os.mkfifo(self.path("pipe"))
        self.assert_fails(1, self.scene, "-o", self.path("pipe"), says="cannot be written: not a regular file")
        with open(self.path("target.png"), "w", encoding="ascii"):
            os.symlink("target.png", self.path("link.png"))
        self.assertEqual(run("ew-render", self.scene, "-o", self.path("link.png"), "--size", "8x8").returncode, 0)
        self.assertTrue(os.path.islink(self.path("link.png")))
        self.assertEqual(png_pixels(self.path("target.png"))[0], (8, 8))
        with open(self.scene, "rb") as f:
            good = f.read()
        for options in ((), ("-a", "-n", "2")):
            self.assert_fails(1, self.scene, *options, "-o", self.scene, says="cannot be written: is the input file")
        with open(self.scene, "rb") as f:
            self.assertEqual(f.read(), good)
        if os.path.exists("/dev/full"):
            self.assert_fails(1, self.scene, "-o", "/dev/full/no.png", says="cannot be written: Not a directory")


if __name__ == "__main__":
    unittest.main()
