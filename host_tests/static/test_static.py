"""What can be known of the core without running it: stacks, calls, outside names. Built for
each target whose compiler is there."""
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import cross

BUILD = os.path.join(cross.ROOT, os.path.dirname(os.environ.get("EW_BIN", "build/release/bin")), "static")
STACK_LIMIT = 512  # bytes, below: any public call


HEADERS = ("fixed", "error", "raster", "draw2d", "geometry", "light", "scene", "display", "panel")
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
