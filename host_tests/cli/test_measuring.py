"""The measuring room's own arithmetic: cycle models against the manuals' examples and hand-counted
loops, the baseline's verdicts, the automatic choice against the cheapest."""
import contextlib
import io
import os
import tempfile
import unittest

import assembled  # the folders of the tools are on the path from here on
import atlas
import baseline
import charts
import count
import memory
import model
import report
import tables
import visibility
import work


class Assembled(unittest.TestCase):
    """Programs of a few lines, assembled for real, with executed blocks given by hand."""

    def assemble(self, target, source):
        made = assembled.assemble(self, target, source)
        made.at = sorted(made.code)
        return made

    def straight(self, target, source):
        """Cycles of a block, without its last instruction, a nop."""
        made = self.assemble(target, source + "\nnop\n")
        return made.block(made.at[0], made.at[-1])

    def loop(self, target, source, last_before, rounds):
        """Instructions up to `last_before` once, the rest to the branch `rounds` times, and a return."""
        made = self.assemble(target, source)
        first, start, branch, end = made.at[0], made.at[last_before + 1], made.at[-2], made.at[-1]
        blocks = {(first, branch): 1, (start, branch): rounds - 1, (end, end): 1}
        edges = {(first, branch, start): 1, (start, branch, start): rounds - 2, (start, branch, end): 1}
        return made.cycles(blocks, edges)

    def test_the_manuals_own_examples(self):
        # Arm DDI 0337I, load/store timings: so many cycles in total
        for source, cycles in (("ldr r0, [r1]\nldr r1, [r2]", 3), ("ldr r0, [r1, r2]\nstr r0, [r3, #20]", 3),
                               ("ldr r0, [r1, r2]\nstr r1, [r3, r2]", 3), ("ldr r0, [r1, r5]\nldr r1, [r2]\nldr r2, [r3, #4]", 4),
                               ("str r0, [r1, #4]", 1)):
            for target in ("m3", "m4"):
                self.assertEqual(self.straight(target, source)[1], cycles, f"{target}: {source}")

    def test_an_address_just_computed_waits(self):
        self.assertEqual(self.straight("m3", "adds r1, r1, #4\nldr r0, [r1]"), (3, 4, 4))
        self.assertEqual(self.straight("m3", "adds r2, r1, #4\nldr r0, [r1]"), (3, 3, 3))
        self.assertEqual(self.straight("m3", "ldr r1, [r2]\nldr r0, [r1]"), (4, 4, 4))

    def test_hand_counted_delay_loop(self):
        source = "movs r0, #100\n1: subs r0, #1\nbne 1b\nbx lr"
        self.assertEqual(self.loop("m0plus", source, 0, 100), (302,) * 3)  # 1 + 100 + 99 2 + 1 + 2
        self.assertEqual(self.loop("m3", source, 0, 100), (1 + 100 + 99 * 2 + 1 + 2, 402, 1 + 100 + 99 * 4 + 1 + 4))
        source = "li a0, 100\n1: addi a0, a0, -1\nbnez a0, 1b\nret"
        self.assertEqual(self.loop("rv32imc", source, 0, 100), (302, 401, 401))  # 1 + 100 + 99 3 + 1 + 2

    def test_m33_as_others_measured_it(self):
        for source, cycles in (("ldr r0, [r1]\nadds r2, r2, #1\nadds r0, r0, #1", 3), ("ldr r0, [r1]\nadds r0, r0, #1", 3),
                               ("ldmia r6!, {r0-r3}", 4)):
            self.assertEqual(self.straight("m33", source)[1], cycles, source)
        # subs 1, bne 2 taken
        self.assertEqual(self.loop("m33", "movs r0, #100\n1: subs r0, #1\nbne 1b\nbx lr", 0, 100)[1], 1 + 100 + 99 * 2 + 1 + 2)

    def test_kinds_of_instructions(self):
        expected = {"push {r4-r7, lr}": (6, 6), "pop {r4-r7, pc}": (8, 8), "muls r0, r1, r0": (1, 1), "ldrh r0, [r1, r2]": (2, 2),
                    "cmp r0, r1": (1, 1), "stmia r0!, {r1, r2}": (3, 3)}
        for source, (m0, m3) in expected.items():
            self.assertEqual(self.straight("m0plus", source)[1], m0, source)
            self.assertEqual(self.straight("m3", source)[1], m3, source)
        for source, m3, m4 in (("smull r0, r1, r2, r3", (3, 4, 5), (1, 1, 1)), ("mla r0, r1, r2, r3", (2, 2, 2), (1, 1, 1)),
                               ("smlal r0, r1, r2, r3", (4, 6, 7), (1, 1, 1)), ("udiv r0, r1, r2", (2, 7, 12), (2, 7, 12))):
            self.assertEqual(self.straight("m3", source), m3, source)
            self.assertEqual(self.straight("m4", source), m4, source)
        for source, cycles in (("mul a0, a1, a2", (1, 3, 33)), ("mulhu a0, a1, a2", (2, 4, 33)), ("lw a0, 0(a1)", (2, 2, 2)),
                               ("divu a0, a1, a2", (38, 38, 38)), ("srli a0, a0, 3", (1, 1, 1))):
            self.assertEqual(self.straight("rv32imc", source), cycles, source)


class Callgrind(unittest.TestCase):
    def test_libc_and_repeated_costs_are_left_out(self):
        text = ("events: Ir\nob=(1) /x/bench-host\nfl=(1) a.c\nfn=(1) draw\n10 100\nfi=(2) b.h\n+1 20\ncob=(2) /lib/libc.so.6\ncfn=(2) memset\n"
                "calls=3 0\n12 900\nfe=(1)\n13 5\nob=(2)\nfn=(2)\n0 900\nob=(1)\nfn=(3) end\n* 1\ntotals: 1026\n")
        with tempfile.NamedTemporaryFile("w", suffix=".out") as f:
            f.write(text)
            f.flush()
            self.assertEqual(count.outside_libc(f.name), {("a.c", "draw"): 125, ("a.c", "end"): 1})


class Baseline(unittest.TestCase):
    def compare(self, now, made_with):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as said:
            path = os.path.join(folder, "baseline.csv")
            baseline.write(path, 8, {"m3": "gcc 1"}, {("m3", "A", "auto", "0.25"): 1000, ("m3", "B", "auto", "0.25"): 500})
            return baseline.compare(path, {"m3": made_with}, now), said.getvalue()

    def test_growth_fails_and_is_named(self):
        failures, said = self.compare({("m3", "A", "auto", "0.25"): 1011, ("m3", "B", "auto", "0.25"): 505}, "gcc 1")
        self.assertEqual(failures, 1)
        self.assertIn("FAIL: m3 A auto 0.25: 1000 instructions, now 1011 (+1.10 %)", said)
        self.assertIn("changed: m3 B", said)

    def test_another_compiler_only_warns(self):
        failures, said = self.compare({("m3", "A", "auto", "0.25"): 2000, ("m3", "C", "auto", "0.25"): 1}, "gcc 2")
        self.assertEqual(failures, 0)
        for word in ("warning: m3: made with 'gcc 2'", "warning: m3 A", "new: m3 C", "gone: m3 B"):
            self.assertIn(word, said)


class Tables(unittest.TestCase):
    @staticmethod
    def row(method, tolerance, instr, displacement, bound):
        return {"target": "m3", "scene": "A", "method": method, "tolerance_px": tolerance, "recip_bits": 8,
                "instr_per_px": str(instr), "cycles_per_px": "na", "disp_max_px": str(displacement), "bound_px": bound}

    def test_auto_against_the_cheapest(self):
        rungs = [self.row("exact", "na", 100, 0, 0), self.row("affine", "na", 10, 0.2, 3.0), self.row("runs", "0.25", 50, 0.25, 0.25)]
        for instr, state, by_bound, measured in ((52, "over", "0.0400", "4.2000"), (10, "ok", "-0.8000", "0.0000")):
            auto, = tables.auto_rows([*rungs, self.row("auto", "0.25", instr, 0.1, 0.25)])
            self.assertEqual((auto["state"], auto["over_by_bound"], auto["over_measured"]), (state, by_bound, measured))
            self.assertEqual((auto["cheapest_by_bound"], auto["cheapest_measured"]), ("runs 0.25", "affine"))
        dearer, = tables.auto_rows([rungs[0], self.row("auto", "0", 106, 0, 0)])
        self.assertEqual(dearer["state"], "over")

    def test_what_is_beyond_its_bound(self):
        for displacement, bound, beyond in (("0.2539", "0.25", False), ("0.2540", "0.25", True), ("inf", "0", True), ("nan", "0", True), ("9", "inf", False)):
            self.assertEqual(tables.beyond({"disp_max_px": displacement, "bound_px": bound}), beyond, displacement)

    def test_dearer_pictures_and_broken_bounds_are_named(self):
        auto = [{**self.row("auto m3", "0", 106, 0, 0), **dict.fromkeys(tables.AUTO_COLUMNS, "x"), "state": "over", "scene": "D"}]
        judged = {8: [{"scene": "B", "method": "auto host", "tolerance_px": "1", "disp_max_px": "2", "bound_px": "1"}]}
        with contextlib.redirect_stdout(io.StringIO()) as said:
            report.say("out", [], judged, auto, [])
        self.assertIn("beyond its bound: table of 8 bits, scene B, auto host 1: 2 px, bound 1 px", said.getvalue())
        self.assertIn("auto is dearer: x, table of x bits, scene D", said.getvalue())

    def test_no_cell_is_empty(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(tables.Failed):
            tables.write(os.path.join(folder, "t.csv"), ["a", "notes"], [{"a": "", "notes": ""}])

    def test_frontier(self):
        self.assertEqual(charts.frontier([(1, 5), (2, 6), (3, 4), (2, 5)]), [(1, 5), (3, 5), (3, 4)])


class Work(unittest.TestCase):
    def test_a_straight_line(self):
        a, b, worst = work.fit([(x, 50 + 3 * x) for x in (1, 10, 100, 1000)])
        self.assertAlmostEqual(a, 50)
        self.assertAlmostEqual(b, 3)
        self.assertAlmostEqual(worst, 0)
        self.assertGreater(work.fit([(1, 1), (10, 100), (100, 10000)])[2], 0.5)

    def test_where_two_ways_cross(self):
        self.assertAlmostEqual(visibility.crossing([(1, 2.0), (4, 0.5), (16, 0.1)]), 2)
        self.assertAlmostEqual(visibility.crossing([(1, 0.5), (4, 2.0), (16, 0.5)]), 8)
        self.assertEqual(visibility.crossing([(1, 0.9), (4, 0.5)]), "always")
        self.assertEqual(visibility.crossing([(1, 0.5), (4, 1.0)]), "never")

    def test_the_worst_frame(self):
        rows = [{"target": "m3", "sweep": "s", "x": i, "instructions": n, "cycles_typical": 2 * n, "notes": ""} for i, n in enumerate((10, 40, 10))]
        frame, = work.frames(rows)
        self.assertEqual((frame["mean_instructions"], frame["worst_instructions"], frame["worst_frame"], frame["worst_cycles"], frame["worst_over_mean"]),
                         ("20", 40, 1, 80, "2.000"))

    def test_a_target_draws_its_own_profile(self):
        cases = [count.Case("A", method, "0", 1) for method in ("exact", "auto", "auto m3", "auto host")]
        self.assertEqual([case.method for case in count.cases_of("m4", cases)], ["exact", "auto", "auto m3"])
        self.assertEqual([case.method for case in count.cases_of("rv32imc", cases)], ["exact", "auto"])


class Modes(unittest.TestCase):
    def test_goals(self):
        m = count.Memory(0, 0, active=3, set_up=3, again=0, transformed=8, triangles=2, vertices=4)
        self.assertEqual([count.goal_bytes(mode, m, 28) for mode in ("bands-8", "line", "bands-4")],
                         [12 * 1024 + 16 * 4 + 4 * 28, 4 * 1024 + 112 * 3 + 4 * 2 + 2 * 4, "na"])

    def test_series_of_a_target(self):
        rows = [dict(zip(count.MEMORY_COLUMNS, [target, scene, mode, 1, ram, "na", 0, 2000000, "1", cycles]))
                for target, scene, mode, ram, cycles in (("m3", "A", "at-once", 4096, 3000000), ("m3", "A", "line", 1024, 5000000),
                                                         ("host", "A", "line", 1024, "na"))]
        self.assertEqual(memory.series(rows, "m3", "cycles_typical"), {"A": [(4096, 3.0, "at-once"), (1024, 5.0, "line")]})
        self.assertEqual(memory.series(rows, "host", "cycles_typical"), {})
        self.assertEqual(memory.ticks([3, 30]), [2, 5, 10, 20, 50])


class Atlas(unittest.TestCase):
    @staticmethod
    def walk(states, predicted):
        return [{"axis": "a", "method": "m", "x": str(2 ** i), "predicted_limit": predicted, "state": s} for i, s in enumerate(states)]

    def test_cells_of_a_map_meet(self):
        self.assertEqual(atlas.edges([0, 1, 2]), [-0.5, 0.5, 1.5, 2.5])
        self.assertEqual(atlas.edges([8]), [7.5, 8.5])

    def test_limits(self):
        for states, predicted, measured, verdict in (
                (["ok", "ok", "ok", "degraded"], "5", 4, "agrees"), (["ok", "degraded", "ok"], "4", 1, "DISAGREES"),
                (["degraded", "degraded", "ok"], "4", 4, "agrees"), (["ok", "ok"], "4", None, "never reached"),
                (["refused"], "4", None, "never ok"), (["ok", "refused"], "na", 1, "")):
            self.assertEqual(atlas.limits(self.walk(states, predicted)), [["a", "m", predicted, measured, verdict]], states)


if __name__ == "__main__":
    unittest.main()
