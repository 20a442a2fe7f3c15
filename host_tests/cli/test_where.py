"""Where instructions go, and what is aimed at: pixel loops in machine code, stages that add up, aims that are met, missed
or wrongly written. What is counted is counted here only where `make count` or `make goals` has built the images."""
import bisect
import contextlib
import csv
import io
import os
import pathlib
import shutil
import tempfile
import unittest
import unittest.mock

import assembled  # the folders of the tools are on the path from here on
import aims
import count
import goals
import pixels
import where

BUILD = pathlib.Path(os.environ.get("EW_BIN", assembled.ROOT / "build/release/bin")).resolve().parent / "cycles"
PIXEL = "ldrh r0, [r1], #2\ncmp r0, r2, lsr #15\nbcs 9f\nstrh r2, [r1, #-2]\n9: adds r2, r2, r3\n"


def assemble(test, target, source):
    """The instructions of a few lines, by address."""
    code = assembled.assemble(test, target, source).code
    return [code[at] for at in sorted(code)]


class PixelLoops(unittest.TestCase):
    def numbers(self, target, source):
        """Which instructions, by number, are in pixel loops; and with which a pixel of an unrolled one begins."""
        function = assemble(self, target, source)
        return tuple([n for n, i in enumerate(function) if i.address in of] for of in pixels.of_function(function))

    def test_a_loop(self):
        self.assertEqual(self.numbers("m3", f"movs r5, #1\n1: {PIXEL}subs r4, #1\nbne 1b\nbx lr"), ([*range(1, 8)], []))

    def test_an_unrolled_loop_and_what_is_left_over(self):
        source = f"subs r4, #2\nblt 2f\n1: {PIXEL}{PIXEL}subs r4, #2\nbge 1b\n2: cmp r4, #-1\nbne 4f\n{PIXEL}4: bx lr"
        self.assertEqual(self.numbers("m3", source), ([*range(2, 14), *range(16, 21)], [2, 7, 16]))

    def test_copies_with_other_offsets(self):
        pixel = "ldrh r0, [r3, #{0}]\nlsrs r4, r2, #15\ncmp r0, r4\nbcs 9f\nstrh r4, [r3, #{0}]\n9: adds r2, r2, r5\n"
        source = f"b 3f\n1: {pixel.format(0)}{pixel.format(2)}adds r3, #4\n3: cmp r3, r6\nbne 1b\nbx lr"
        self.assertEqual(self.numbers("m0plus", source), ([*range(1, 16)], [1, 7]))

    def test_a_way_back_into_the_middle_is_no_loop_of_its_own(self):
        source = "b 2f\n1: strh r0, [r1]\n3: adds r1, #2\ncmp r1, r3\nbeq 4f\n2: ldrh r0, [r1]\ncmp r0, r2\nbcs 3b\nb 1b\n4: bx lr"
        self.assertEqual(self.numbers("m3", source), ([*range(1, 9)], []))

    def test_the_loop_around_is_none(self):
        source = f"5: movs r4, #9\n1: {PIXEL}subs r4, #1\nbne 1b\nstrh r0, [r6]\nldrh r0, [r6]\nsubs r7, #1\nbne 5b\nbx lr"
        self.assertEqual(self.numbers("m3", source), ([*range(1, 8)], []))

    def test_loops_that_only_store_or_move_words(self):
        for source in ("1: strh r0, [r1, r4]\nsubs r4, #2\nbne 1b\nbx lr", "1: ldr r0, [r1]\nstr r0, [r2]\nsubs r4, #2\nbne 1b\nbx lr"):
            self.assertEqual(self.numbers("m3", source), ([], []))

    def test_a_loop_with_a_call(self):
        source = "1: lhu a0, 0(s0)\njal ra, 9f\nsh a0, 0(s0)\naddi s0, s0, 2\nbne s0, s1, 1b\nret\n9: ret"
        self.assertEqual(self.numbers("rv32imc", source), ([*range(5)], []))


class Stages(unittest.TestCase):
    @staticmethod
    def counted(places):
        return count.Count(sum(places.values()), None, "0", None, places)

    def test_every_instruction_has_its_place(self):
        function = assemble(self, "m3", f"nop\nnop\n1: {PIXEL}subs r4, #1\nbne 1b\nbx lr\nudiv r0, r0, r1\nbx lr")
        at = [i.address for i in function]
        symbols = [(at[0], "/x/src/raster/span.c", "runs"), (at[10], "", "__udivsi3")]
        places = count.Places(symbols, {i.address: i for i in function})
        # a block goes on over a function's end
        found = places.of({(at[0], at[4]): 1, (at[2], at[8]): 9, (at[9], at[10]): 2})
        self.assertEqual(found, {("/x/src/raster/span.c", "runs", True): 3 + 9 * 7, ("/x/src/raster/span.c", "runs", False): 2 + 2,
                                 ("", "__udivsi3", False): 2})
        of = where.stages(self.counted(found))
        self.assertEqual({stage: n for stage, n in of.items() if n}, {"pixels": 66, "rows": 4, "products": 2})

    def test_stages_of_functions(self):
        for file, function, stage in (("/p/src/geometry/clip.c", "place", "culling"), ("/p/src/raster/triangle.c", "place", "placing"),
                                      ("/p/src/raster/triangle.c", "ew_raster_triangle_in_range.part.0", "culling"),
                                      ("src/geometry/light.c", "x", "vertices"), ("fixed/recip.c", "ew_recip_table", "products"),
                                      ("", "__aeabi_uidivmod", "products"), ("/b/libgcc/libgcc2.c", "__muldi3", "products"),
                                      ("/p/board/memory.c", "memcpy", "copies"), ("/p/fixed/matrix.c", "normalise", "scene")):
            self.assertEqual(where.stage_of(file, function), stage, function)

    def test_an_unknown_function_is_refused_by_name(self):
        for file, function in (("/p/src/raster/new.c", "novel"), ("", "semihost"), ("/p/not_src/raster/xspan.c", "runs")):
            with self.assertRaisesRegex(count.Failed, rf"{function} \({file or 'no source file'}\).*no stage"):
                where.stages(self.counted({count.Place(file, function, False): 1}))

    def test_a_sum_that_differs_is_refused(self):
        counted = self.counted({count.Place("src/raster/edge.c", "step", False): 5})._replace(instructions=6)
        with self.assertRaisesRegex(count.Failed, "5 instructions of 6"):
            where.stages(counted)

    def test_on_the_host_pixels_are_part_of_rows(self):
        of = where.stages(self.counted({count.Place("src/raster/span.c", "runs", None): 5}))
        self.assertEqual((of["rows"], "pixels" in of), (5, False))

    def test_files_that_callgrind_does_not_know(self):
        symbols = [(0, "a.c", "one"), (4, "b.c", "two"), (8, "c.c", "two")]
        found = count.in_their_files({("x.h", "one"): 1, ("a.c", "one"): 2, ("c.c", "two"): 4, ("", "none"): 8}, symbols)
        self.assertEqual(found, {("a.c", "one", None): 3, ("c.c", "two", None): 4, ("", "none", None): 8})


class Recorder(count.Places):
    """Remembers what regions it was asked for."""
    asked = []

    def of(self, blocks):
        self.asked.append((self, blocks))
        return super().of(blocks)

    def pixels(self, blocks):
        """How often pixels of unrolled loops were begun in a region."""
        ends = [bisect.bisect_left(self.addresses, start) for start in [*self.starts, self.addresses[-1] + 1]]
        begins = set().union(*(pixels.of_function([self.code[at] for at in self.addresses[first:end]])[1]
                               for (_, file, _), first, end in zip(self.symbols, ends, ends[1:]) if file.endswith("/src/raster/span.c")))
        return sum(times * sum(first <= at <= last for at in begins) for (first, last), times in blocks.items())


class Images(unittest.TestCase):
    """The images as they are built."""

    def image(self, target):
        path = BUILD / str(count.DEFAULT_BITS) / f"bench-{target}"
        tools = ["valgrind"] if target == "host" else [count.tools_prefix(target) + "nm", count.EMULATORS[target][0]]
        for tool in tools:
            if not shutil.which(tool):
                self.skipTest(f"{tool} is not installed")
        for needed in (path, BUILD / "list", BUILD / "count.so"):
            if not needed.exists():
                self.skipTest(f"{needed} is not built: make count")
        return path

    def test_every_function_of_the_core_has_a_stage(self):
        not_drawn = ("src/raster/draw2d.c", "src/raster/font.c", "fixed/error.c")
        for target in count.EMULATORS:
            with self.subTest(target):
                symbols = count.text_symbols(count.tools_prefix(target) + "nm", str(self.image(target)))
                own = [(file, name) for _, file, name in symbols
                       if ("/src/" in file or "/fixed/" in file or "/libgcc/" in file) and not file.endswith(not_drawn)]
                self.assertGreater(len(own), 100)
                for file, name in own:
                    where.stage_of(file, name)

    def test_stages_of_what_is_counted(self):
        self.image("m3")
        cases = count.list_cases(str(BUILD))
        with unittest.mock.patch.object(count, "Places", Recorder):
            drawn = list(zip(count.cases_of("m3", cases), count.count(str(BUILD), count.DEFAULT_BITS, "m3", cases)))
        self.assertEqual(len(drawn), len(Recorder.asked))
        for (case, counted), (places, blocks) in zip(drawn, Recorder.asked):
            # floors: each fragment goes through the unrolled loop, and once
            if case.scene in ("A", "C", "D", "E") and case[1:3] == ("auto", "0.25"):
                self.assertEqual(places.pixels(blocks), case.fragments, case)
            self.assertEqual(sum(where.stages(counted).values()), counted.instructions)
            # no fragment of these is hidden: each goes the same way through one loop
            if case.scene in ("A", "D") and case.method in ("exact", "flat"):
                self.assertEqual(where.stages(counted)["pixels"] % case.fragments, 0, case)
        rows = list(where.rows_of("m3", cases, [counted for _, counted in drawn]))
        own = {(case.scene, case.method, case.tolerance): counted for case, counted in drawn if case.method.startswith("auto")}
        self.assertEqual(len(rows), len(own) * len(where.PURPOSES))
        for key, counted in own.items():
            self.assertEqual(sum(row["instructions"] for row in rows if (row["scene"], row["method"], row["tolerance"]) == key), counted.instructions)


class Aims(unittest.TestCase):
    HEAD = "# what for\n" + ",".join(goals.INPUT) + "\n"
    CASES = [count.Case("A", "auto", "0.25", 10), count.Case("A", "auto m3", "0.25", 10)]

    def rows(self, lines, sizes=()):
        span, edge = count.Place("src/raster/span.c", "runs", False), count.Place("src/raster/edge.c", "step", False)
        counts = {"m3": [count.Count(130, None, "0", None, {span: 100, edge: 30}), count.Count(10, None, "0", None, {span: 10})]}
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "goals.csv")
            with open(path, "w", encoding="utf-8") as f:
                f.write(self.HEAD + lines)
            return list(goals.rows_of(path, self.CASES, counts, dict(sizes)))

    def test_met_and_missed(self):
        sizes = {("m0plus", "raster, all"): 6144}
        rows = self.rows('m3,A,auto,0.25,instr_per_px,13,aim\nm3,A,auto,0.25,instr_per_px,12.9,aim\nm4,A,auto,0.25,instr_per_px,1,aim\n'
                         'm0plus,na,"raster, all",na,bytes,6144,aim\nm0plus,na,"raster, all",na,bytes,6143,aim\n', sizes)
        self.assertEqual([(row["reached"], row["state"]) for row in rows],
                         [("13.000", "met"), ("13.000", "missed"), ("na", "na"), ("6144", "met"), ("6144", "missed")])
        self.assertIn("not counted", rows[2]["notes"])
        with contextlib.redirect_stdout(io.StringIO()) as said:
            goals.say(rows)
        self.assertEqual(said.getvalue().count("rows 10.00 (77 %), edges 3.00 (23 %)"), 1)
        self.assertIn("most in runs 10.00, step 3.00", said.getvalue())
        self.assertIn("goals: 2 met, 2 missed, 1 not counted", said.getvalue())
        text = aims.section(rows, [], lambda head, lines: "\n".join(" ".join(line) for line in lines), lambda names: "")
        self.assertIn("m3 A auto 0.25 px 12.9 13 <td class='over'>missed</td> rows 10.0, edges 3.0 aim", text)

    def test_errors_name_line_and_reason(self):
        good = "m3,A,auto,0.25,instr_per_px,13,aim\n"
        for line, reason in (("m9,A,auto,0.25,instr_per_px,13,aim", "target 'm9' is none of host, m0plus"),
                             ("m3,A,auto,0.25,cycles,13,aim", "unit 'cycles' is neither"), ("m3,A,auto,0.25,instr_per_px,few,aim", "goal 'few' is no number"),
                             ("m3,A,auto,0.25,instr_per_px,-1,aim", "goal '-1' is no number above 0"), ("m3,A,auto,0.25,instr_per_px,nan,aim", "goal 'nan'"),
                             ("m3,A,auto,0.25,instr_per_px,13", "not 7 cells"), ("m3,A,auto,0.25,instr_per_px,13,a,b", "not 7 cells"),
                             ("m3,Z,auto,0.25,instr_per_px,13,aim", "no picture of scene 'Z' by 'auto' at '0.25' px is counted on m3"),
                             ("m3,na,core,na,bytes,13,aim", "there is no configuration 'core' for m3")):
            with self.subTest(line), self.assertRaises(count.Failed) as failed:
                self.rows(good + "# a remark\n" + line + "\n")
            self.assertIn(f"goals.csv: line 5: {reason}", str(failed.exception))
        with self.assertRaisesRegex(count.Failed, "holds no goals"):
            self.rows("")
        with self.assertRaisesRegex(count.Failed, "line 3: the columns are a,b"), tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "goals.csv")
            pathlib.Path(path).write_text("# x\na,b\n1,2\n", encoding="utf-8")
            goals.read(path)

    def test_the_projects_own(self):
        cases = [(row["target"], row["unit"]) for _, row in goals.read(str(assembled.ROOT / "tools/cycles/goals.csv"))]
        for target, unit, n in (("m3", "instr_per_px", 3), ("m0plus", "instr_per_px", 3), ("host", "instr_per_px", 2), ("m3", "bytes", 2)):
            self.assertEqual(cases.count((target, unit)), n, target)

    def test_bars_of_the_chart(self):
        self.assertEqual(list(aims.parts({"rows": 2, "pixels": 3})), [("rows", 0, 2), ("pixels", 2, 5)])
        self.assertEqual(set(aims.COLOURS), set(where.PURPOSES))
        self.assertEqual(aims.places([("m3", "A"), ("m3", "B"), ("m4", "A")]), {("m3", "A"): 1.0, ("m3", "B"): 2.0, ("m4", "A"): 3.6})

    def test_a_row_for_each_line_of_the_table(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "out.csv")
            where.write(path, goals.COLUMNS, self.rows("m3,A,auto,0.25,instr_per_px,13,aim\n"))
            with open(path, encoding="utf-8") as f:
                self.assertEqual(list(csv.reader(f)), [goals.COLUMNS, ["m3", "A", "auto", "0.25", "instr_per_px", "13", "13.000", "met", "aim"]])


if __name__ == "__main__":
    unittest.main()
