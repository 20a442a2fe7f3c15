"""What can be known of the core without running it: stacks, calls, outside names. Built for
each target whose compiler is there."""
import os
import re
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import cross

BUILD = os.path.join(cross.ROOT, os.path.dirname(os.environ.get("EW_BIN", "build/release/bin")), "static")
STACK_LIMIT = 512  # bytes, below: any public call


HEADERS = ("fixed", "error", "raster", "draw2d", "geometry", "picture", "light", "scene", "display", "panel")
LAYERS = ("fixed", "src/raster", "src/geometry", "src/scene", "src/display")


class Static(unittest.TestCase):
    def each_build(self, check):
        """Calls check(call graph) for each target and level."""
        reasons = [cross.missing(target) for target in cross.TARGETS if cross.missing(target)]
        if len(reasons) == len(cross.TARGETS):
            self.skipTest("; ".join(sorted(set(reasons))))
        for target in cross.TARGETS:
            for level in cross.LEVELS:
                if not cross.missing(target):
                    with self.subTest(target=target, level=level):
                        check(cross.Stacks(cross.build(target, level, LAYERS, [], BUILD)))

    def test_no_recursion_no_stray_call_no_frame_without_bound(self):
        # all() raises on each of them
        self.each_build(lambda graph: self.assertLessEqual(cross.public_functions(HEADERS), set(graph.all())))

    def test_public_calls_stay_below_the_stack_limit(self):
        def check(graph):
            deep = {name: graph.depth(name)[0] for name in sorted(cross.public_functions(HEADERS))}
            self.assertEqual({name: bytes for name, bytes in deep.items() if bytes >= STACK_LIMIT}, {})

        self.each_build(check)


class Hot(unittest.TestCase):
    """EW_HOT and EW_HOT_TABLE: what rows and pixels need lies where a firmware puts it."""

    DEFINES = ['-DEW_HOT=__attribute__((section(".ew_hot")))', '-DEW_HOT_TABLE=__attribute__((section(".ew_hot_table")))']
    # all rows of triangles go through these but for the last: clears do
    ROOTS = ("ew_rows_of_texture", "ew_rows_packed", "ew_rows_of_any", "ew_raster_fill")
    MORE_ROOTS = {"m3": ("ew_rows_of_runs",)} # where there is machine code for them
    TABLES = {"ew_recip_entries", "layouts", "bayer"}

    def sections(self, target, objects):
        """Name to section of functions and tables: both are `.ew_hot`, or what the compiler makes of no macro."""
        found = {}
        for path in objects:
            for line in cross.run([cross.TARGETS[target][0] + "objdump", "-t", path]).splitlines():
                words = line.split()
                if len(words) >= 5 and re.match(r"[0-9a-f]{8} .{5}[F O]", line) and words[-1] not in (".text", ".rodata"):
                    found[os.path.basename(path), words[-1]] = words[-3]
        return found

    def test_rows_and_pixels_lie_in_the_section(self):
        for target in cross.TARGETS:
            if cross.missing(target):
                continue
            with self.subTest(target=target):
                objects = cross.build(target, "-O2", LAYERS, self.DEFINES, BUILD)
                graph, found = cross.Stacks(objects), self.sections(target, objects)
                reached, ahead = set(), list(self.ROOTS + self.MORE_ROOTS.get(target, ()))
                while ahead:
                    name = ahead.pop()
                    if name not in reached and name in graph.frame:
                        reached.add(name)
                        ahead += graph.calls.get(name, ())
                    elif name not in reached:
                        self.assertTrue(cross.HELPERS.fullmatch(name), name)
                names = {name.split(":")[-1] for name in reached}
                self.assertGreater(len(names), 20)
                self.assertIn("runs_of_texture", names)
                by_name = {}
                for (_, name), section in found.items():
                    by_name.setdefault(name, set()).add(section)
                self.assertEqual({name: by_name[name] for name in names if by_name[name] != {".ew_hot"}}, {})
                self.assertEqual({name: by_name[name] for name in self.TABLES if by_name[name] != {".ew_hot_table"}}, {})
                # and what is done once a triangle, a material or a scene does not
                for name in ("ew_setup", "ew_raster_init", "ew_scene_open", "ew_texture_check", "ew_draw_text"):
                    self.assertNotIn(".ew_hot", by_name[name], name)


class Options(unittest.TestCase):
    """The machine code of arch.h asks for nearly all registers: compilers find them whatever they are told."""

    LEVELS = ("-O1", "-Og", "-O2", "-O3", "-Os")
    # with an FPU GCC once found none: it has other registers to spill to then
    THUMB2 = ("-mcpu=cortex-m3", "-mcpu=cortex-m4 -mfloat-abi=hard", "-mcpu=cortex-m7 -mfloat-abi=softfp",
              "-mcpu=cortex-m33 -mfloat-abi=hard -fno-omit-frame-pointer", "-mcpu=cortex-m4 -mfloat-abi=hard -fpic",
              "-mcpu=cortex-m55 -mfloat-abi=hard -fstack-protector-all")
    ARMV6M = ("-mcpu=cortex-m0", "-mcpu=cortex-m0plus -fpic", "-mcpu=cortex-m23 -mlong-calls",
              "-mcpu=cortex-m0plus -fno-omit-frame-pointer -DEW_PORTABLE")

    def test_the_rows_compile_with_all(self):
        if cross.missing("m3"):
            self.skipTest(cross.missing("m3"))
        for cpu in self.THUMB2 + self.ARMV6M:
            for level in self.LEVELS:
                for source in ("span", "triangle"):
                    with self.subTest(options=cpu, level=level, source=source):
                        made = subprocess.run(["arm-none-eabi-gcc", "-mthumb", *cpu.split(), level, "-std=c99", "-ffreestanding",
                                               "-Iinclude", "-S", "-o", os.devnull, f"src/raster/{source}.c"],
                                              cwd=cross.ROOT, stderr=subprocess.PIPE, text=True)
                        self.assertEqual((made.returncode, made.stderr), (0, ""))


class Reader(unittest.TestCase):
    """The reader of call graphs notices what it should."""

    GRAPH = ('graph: {{ title: "a.c"\nnode: {{ title: "f" label: "f\\na.c:1:1\\n100 bytes ({kind})" }}\n'
             'node: {{ title: "g" label: "g\\na.c:2:1\\n30 bytes (static)" }}\n{edges}}}\n')

    def stacks(self, *edges, kind="static"):
        graph = cross.Stacks([])
        graph.read(self.GRAPH.format(kind=kind, edges="".join(
            f'edge: {{ sourcename: "{a}" targetname: "{b}" label: "a.c:1:1" }}\n' for a, b in edges)))
        return graph

    def test_sums_the_deepest_chain(self):
        self.assertEqual(self.stacks(("f", "g")).depth("f"), (130, ("f", "g")))
        self.assertEqual(self.stacks(("f", "g"), ("f", "__aeabi_lmul")).depth("f")[0], 100 + cross.HELPER_FRAME)

    def test_refuses_what_has_no_bound(self):
        for edges, kind in (((("f", "g"), ("g", "f")), "static"), ((("g", "g"),), "static"),
                            ((("f", "__indirect_call"),), "static"), ((("f", "malloc"),), "static"),
                            ((("f", "__aeabi_fadd"),), "static"), ((), "dynamic")):
            with self.subTest(edges=edges, kind=kind), self.assertRaises(cross.StackError):
                self.stacks(*edges, kind=kind).all()


if __name__ == "__main__":
    unittest.main()
