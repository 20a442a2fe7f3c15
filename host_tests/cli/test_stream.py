"""ew-stream from outside: bad input, the simulated display, what it writes. EW_BIN is the
folder of the programs."""
import base64
import json
import os
import pathlib
import random
import re
import signal
import struct
import subprocess
import tempfile
import time
import unittest

from png import png_chunks, png_pixels

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("EW_BIN", ROOT / "build/release/bin")).resolve()
STREAM = BIN / "ew-stream"
SEED = int(os.environ.get("EW_SEED", "1"))
WIDTH, HEIGHT = 48, 32


def stream(*arguments, stdin=b"", timeout=60):
    return subprocess.run([STREAM, *map(str, arguments)], input=stdin, capture_output=True, timeout=timeout,
                          check=False)


def tiny_gltf():
    """Two triangles of two colours."""
    points = [(-1, 0, 0), (1, 0, 0), (0, 1.5, 0), (0, -0.5, 1)]
    indices = struct.pack("<6H", 0, 1, 2, 0, 3, 1)
    data = b"".join(struct.pack("<3f", *p) for p in points) + indices
    view = {"buffer": 0}
    return {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "scene": 0,
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": i + 1, "material": i} for i in (0, 1)]}],
        "materials": [{"doubleSided": True, "pbrMetallicRoughness": {"baseColorFactor": colour}}
                      for colour in ([0.8, 0.2, 0.1, 1], [0.1, 0.5, 0.9, 1])],
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
        "bufferViews": [{**view, "byteOffset": 0, "byteLength": 48}, {**view, "byteOffset": 48, "byteLength": 12}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -0.5, 0], "max": [1, 1.5, 1]},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
            {"bufferView": 1, "byteOffset": 6, "componentType": 5123, "count": 3, "type": "SCALAR"}],
    }


def png_rgb565(path):
    """The pixels of a PNG file as little-endian RGB565."""
    size, rows = png_pixels(path)
    assert size == (WIDTH, HEIGHT)
    pixels = zip(*(b"".join(rows)[k::3] for k in range(3)))
    return b"".join(struct.pack("<H", r >> 3 << 11 | g >> 2 << 5 | b >> 3) for r, g, b in pixels)


def noise(frames, seed=SEED):
    return random.Random(seed).randbytes(frames * 2 * WIDTH * HEIGHT)


class StreamTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not STREAM.exists():
            raise unittest.SkipTest(f"{STREAM.name} is not built")
        cls.folder = tempfile.TemporaryDirectory()
        cls.work = pathlib.Path(cls.folder.name)
        cls.sim = f"sim:{WIDTH}x{HEIGHT}"
        cls.scene = None
        if (BIN / "ew-bake").exists():
            source = cls.work / "tiny.gltf"
            source.write_text(json.dumps(tiny_gltf()))
            cls.scene = cls.work / "tiny.ewb"
            subprocess.run([BIN / "ew-bake", source, "-o", cls.scene], check=True, capture_output=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def need_scene(self):
        if not self.scene:
            self.skipTest("ew-bake is not built")
        return self.scene

    def totals(self, result):
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = re.findall(r"^(\S.*?) {2,}(\S.*)$|^(\S+/\S+ \S+) +(\S+)$", result.stdout.decode(), re.M)
        return {a or c: float(b or d) for a, b, c, d in lines}

    def refused(self, result, *words, status=1):
        text = result.stderr.decode()
        self.assertEqual(result.returncode, status, text)
        self.assertEqual(text.count("\n"), 1, text)
        self.assertTrue(text.startswith("ew-stream: "), text)
        for word in words:
            self.assertIn(str(word), text)


class Usage(StreamTest):
    def test_help_and_version(self):
        result = stream("--help")
        self.assertEqual(result.returncode, 0)
        for option in ("--device", "--profile", "--frames", "--fps", "--codec", "--keyframe", "--out", "--compare",
                       "--record", "--gpio-reset", "--gpio-te", "--te-timeout", "--reconnect", "--timeout", "--list",
                       "--fault-drop", "--raw"):
            self.assertIn(option, result.stdout.decode())
        result = stream("--version")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stdout.decode(), r"^ew-stream \d+\.\d+\.\d+\n$")

    def test_wrong_usage(self):
        for arguments in ([], ["x.ewb"], ["--device", self.sim], ["--nonsense"], ["x.ewb", "y.ewb", "-d", self.sim],
                          ["x.ewb", "-d", self.sim, "--raw", "8x8"], ["x.ewb", "-d", self.sim, "--codec", "png"],
                          ["x.ewb", "-d", self.sim, "--frames", "-1"], ["x.ewb", "-d", self.sim, "--frames", "x"],
                          ["x.ewb", "-d", self.sim, "--fps", "nan"], ["x.ewb", "-d", self.sim, "--profile", "both"],
                          ["x.ewb", "-d", "16c0:05df", "--out", "dir"], ["x.ewb", "-d", "16c0:05df", "--fault-drop", "9"]):
            with self.subTest(arguments=arguments):
                self.wrong(arguments)

    def wrong(self, arguments, *words):
        result = stream(*arguments)
        text = result.stderr.decode()
        self.assertEqual((result.returncode, result.stdout), (2, b""), text)
        self.assertTrue(text.startswith("ew-stream"))
        for word in words:
            self.assertIn(word, text.splitlines()[0])

    def test_malformed_device(self):
        for device in ("nonsense", "16c0", "16c0:5", "16c0:05dfx", "16c0:05df:", "simulated:8x8", "x16c:05df", "",
                       "16c0:05df:" + 128 * "S"):
            with self.subTest(device=device):
                self.wrong(["x.ewb", "--device", device], f"--device {device}: ", "VID:PID")

    def test_malformed_sizes(self):
        for size in ("0x0", "99999x99999", "4097x1", "1x4097", "12", "x", "8x", "8x8x8", "-8x8", " 8x8", ""):
            with self.subTest(size=size):
                self.wrong(["x.ewb", "--device", f"sim:{size}"], f"--device sim:{size}: size", "1 to 4096")
                self.wrong(["--raw", size, "--device", self.sim], f"--raw {size}: size", "1 to 4096")

    def test_malformed_lines(self):
        for option in ("--gpio-reset", "--gpio-te"):
            for line in ("7", "gpiochip0", "gpiochip0:", ":7", "", "gpiochip0:" + 128 * "L"):
                with self.subTest(option=option, line=line):
                    self.wrong(["x.ewb", "--device", self.sim, option, line], f"{option} {line}: ", "CHIP:LINE")


class BadInput(StreamTest):
    def test_no_such_display(self):
        for device in ("fffe:fffd", "fffe:fffd:SERIAL", "/dev/hidraw4095", "/", "/dev/null"):
            with self.subTest(device=device):
                self.refused(stream("x.ewb", "--device", device), device)

    def test_frames_of_another_size(self):
        self.refused(stream("--raw", "8x8", "--device", self.sim), "stdin", "8x8", f"{WIDTH}x{HEIGHT}")

    def test_scene_that_is_none(self):
        for name, content in (("missing.ewb", None), ("empty.ewb", b""), ("text.ewb", b"a scene\n" * 99)):
            with self.subTest(name=name):
                if content is not None:
                    (self.work / name).write_bytes(content)
                self.refused(stream(self.work / name, "--device", self.sim), name)
        self.refused(stream(self.work, "--device", self.sim), self.work)

    def test_broken_scene(self):
        whole = self.need_scene().read_bytes()
        broken = self.work / "broken.ewb"
        record = self.work / "never"
        rng = random.Random(SEED)
        lengths = rng.sample(range(len(whole)), 40)
        places = rng.sample(range(len(whole)), 60)
        cases = [(f"cut to {n}", whole[:n]) for n in lengths]
        cases += [(f"byte {p}", whole[:p] + bytes([whole[p] ^ 1 << rng.randrange(8)]) + whole[p + 1:]) for p in places]
        for name, content in cases:
            with self.subTest(name, seed=SEED):
                broken.write_bytes(content)
                self.refused(stream(broken, "--device", self.sim, "--record", record), "broken.ewb")
        self.assertEqual([p.name for p in self.work.glob("never*")], [])

    def test_raw_frame_cut_short(self):
        self.refused(stream("--raw", f"{WIDTH}x{HEIGHT}", "--device", self.sim, "--fps", 0, stdin=noise(3)[:-1]),
                     "stdin", "frame 2")

    def test_files_that_cannot_be_written(self):
        file = self.work / "file"
        file.write_text("kept")
        raw = ("--raw", f"{WIDTH}x{HEIGHT}", "--device", self.sim, "--fps", 0)
        self.refused(stream(*raw, "--record", self.work / "no" / "record"), "no/record")
        self.refused(stream(*raw, "--dump-drawn", self.work), self.work)
        self.refused(stream(*raw, "--out", file), file)
        self.assertEqual(file.read_text(), "kept")

    def test_the_scene_is_not_written_over(self):
        scene = self.work / "own.ewb"
        link = self.work / "link.ewb"
        scene.write_bytes(self.need_scene().read_bytes())
        link.symlink_to(scene)
        for option in ("--record", "--dump-drawn"):
            for name in (scene, link):
                with self.subTest(option, name=name.name):
                    self.refused(stream(scene, "--device", self.sim, "--frames", 1, "--fps", 0, option, name), name.name, "is the input file")
        self.assertEqual(scene.read_bytes(), self.need_scene().read_bytes())
        self.assertEqual(list(self.work.glob("*.part")), [])

    def test_wrong_lines(self):
        for option in ("--gpio-reset", "--gpio-te"):
            self.refused(stream("x.ewb", "--device", self.sim, option, "gpiochip4095:7"), "gpiochip4095:7")


class Simulated(StreamTest):
    raw = ("--raw", f"{WIDTH}x{HEIGHT}", "--device", f"sim:{WIDTH}x{HEIGHT}", "--fps", 0, "--compare")

    def test_scene_in_every_mode(self):
        scene = self.need_scene()
        for profile in ("direct", "buffered"):
            for codec in ("auto", "raw", "srl"):
                with self.subTest(profile=profile, codec=codec):
                    totals = self.totals(stream(scene, "--device", self.sim, "--frames", 12, "--fps", 0, "--compare",
                                                "--profile", profile, "--codec", codec))
                    self.assertEqual(totals["frames accepted"], 12)
                    self.assertEqual(totals["frames sent"], 12)
                    self.assertEqual(totals["key frames"], 1)
                    self.assertEqual(totals["bytes/frame raw"], 2 * WIDTH * HEIGHT)
                    if codec != "raw":
                        self.assertLess(totals["bytes/frame sent"], WIDTH * HEIGHT)

    def test_pictures_are_what_was_drawn(self):
        out, drawn = self.work / "out", self.work / "drawn"
        frames = noise(5)
        self.totals(stream(*self.raw, "--out", out, "--dump-drawn", drawn, stdin=frames))
        self.assertEqual(drawn.read_bytes(), frames)
        size = 2 * WIDTH * HEIGHT
        names = [f"frame-{i:04}.png" for i in range(5)]
        self.assertEqual(sorted(p.name for p in out.iterdir()), ["animation.png", *names])
        for i, name in enumerate(names):
            self.assertEqual(png_rgb565(out / name), frames[i * size:(i + 1) * size])
        chunks = list(png_chunks((out / "animation.png").read_bytes()))
        self.assertEqual(struct.unpack(">I", dict(chunks)[b"acTL"][:4])[0], 5)
        self.assertEqual(sum(kind == b"fcTL" for kind, _ in chunks), 5)

    def test_drawn_frames_can_be_sent_again(self):
        drawn, again = self.work / "first", self.work / "again"
        self.totals(stream(self.need_scene(), "--device", self.sim, "--frames", 6, "--fps", 0, "--dump-drawn", drawn))
        frames = drawn.read_bytes()
        size = 2 * WIDTH * HEIGHT
        self.assertEqual(len(frames), 6 * size)
        self.assertGreater(len({frames[i:i + size] for i in range(0, len(frames), size)}), 3)
        self.totals(stream(*self.raw, "--dump-drawn", again, stdin=frames))
        self.assertEqual(again.read_bytes(), frames)

    def test_record_has_whole_reports(self):
        record = self.work / "record"
        totals = self.totals(stream(*self.raw, "--record", record, stdin=noise(3)))
        lines = record.read_text().splitlines()
        self.assertAlmostEqual(len(lines), 3 * totals["reports/frame"], delta=0.2)
        for line in lines:
            self.assertRegex(line, r"^04( [0-9a-f]{2}){63}$")

    def test_lost_reports(self):
        for profile in ("direct", "buffered"):
            for every in (200, 211, 333):
                with self.subTest(profile=profile, every=every):
                    totals = self.totals(stream(*self.raw, "--fault-drop", every, "--profile", profile, stdin=noise(12)))
                    self.assertEqual(totals["frames accepted"], 12)
                    self.assertGreater(totals["frames refused"], 0)
                    self.assertGreater(totals["key frames"], 1)

    def test_losses_without_end(self):
        start = time.monotonic()
        result = stream(*self.raw, "--fault-drop", 3, "--timeout", 300, "--record", self.work / "lost", stdin=noise(2))
        self.refused(result, "no frame confirmed for 300 ms")
        self.assertLess(time.monotonic() - start, 5)
        self.assertFalse((self.work / "lost").exists())

    def test_key_frames_when_asked_for(self):
        frame = noise(1)
        totals = self.totals(stream(*self.raw, "--fps", 50, "--keyframe", 0.1, stdin=frame * 25))
        self.assertIn(totals["key frames"], range(3, 20))

    def test_nothing_on_stdin(self):
        self.assertEqual(self.totals(stream(*self.raw))["frames sent"], 0)

    def test_time_is_kept(self):
        start = time.monotonic()
        self.totals(stream(*self.raw, "--fps", 20, stdin=noise(10)))
        self.assertGreater(time.monotonic() - start, 0.45)

    def test_interrupted(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with subprocess.Popen([STREAM, *map(str, self.raw)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE) as program:
                program.stdin.write(noise(2))
                program.stdin.flush()
                time.sleep(1)
                program.send_signal(number)
                out, err = program.communicate(timeout=10)
                self.assertEqual((program.returncode, err), (0, b""))
                self.assertRegex(out.decode(), r"frames accepted +2\n")

    def test_list(self):
        result = stream("--list")
        self.assertEqual(result.returncode, 0)
        self.assertTrue(result.stdout)


if __name__ == "__main__":
    unittest.main()
