/* The golden checks: the standard scenes A to E, drawn by each rung, against the referee.
 * No stored picture of our own is asked. */
#include "unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../accuracy/standard_measure.h"
#include "../reference/scenes.h"

static uint16_t colour[STANDARD_WIDTH * STANDARD_HEIGHT], depth[STANDARD_WIDTH * STANDARD_HEIGHT];
static standard_scene scene;

static measures draw(char name, ew_rung rung, uint16_t tolerance)
{
    enum { BACKGROUND = 0x1234 };
    const ew_target target = { .colour = colour, .depth = depth, .width = STANDARD_WIDTH, .height = STANDARD_HEIGHT,
                               .stride = STANDARD_WIDTH };
    measures m;
    assert_int_equal(measure_standard(name, rung, tolerance, NULL, &target, BACKGROUND, &m), 0);
    return m;
}

/* What every picture owes, whatever its rung. Fragments: the counts of exact coverage, as
 * published for A and B. */
static void hold(char name, const measures *m)
{
    static const long fragments[STANDARD_SCENES] = { 31472, 30620, 34400, 12849, 37600 };
    test_context("scene %c: %ld fragments, %ld wrong, %ld double, %ld overdrawn, %ld against the truth, vertices %.3f, "
                 "depth %.3f, %ld colours", name, m->fragments, m->wrong_px, m->double_hits, m->hit_again,
                 m->wrong_truth_px, m->snapped_max, m->depth_max, m->colour_px);
    assert_int_equal(m->fragments, fragments[name - 'A']);
    assert_int_equal(m->wrong_px, 0);
    assert_int_equal(m->double_hits, 0);
    assert_int_equal(m->hit_again, 0);
    /* E's horizon snaps onto the centres of a row */
    assert_true(m->wrong_truth_px <= (name == 'E' ? 200 : 0));
    assert_true(m->snapped_max <= 0.75);
    assert_true(m->depth_max <= 1);
    assert_int_equal(m->colour_px, 0);
}

static void uv_limits(const measures *m, double rms, double worst)
{
    test_context("u rms %.4f max %.4f, v rms %.4f max %.4f", m->u_rms, m->u_max, m->v_rms, m->v_max);
    assert_true(m->u_rms <= rms && m->v_rms <= rms);
    assert_true(m->u_max <= worst && m->v_max <= worst);
}

static void exact_rung(void **state)
{
    (void)state;
    for (char name = 'A'; name <= 'E'; name++) {
        measures m = draw(name, EW_RUNG_EXACT, 0);
        hold(name, &m);
        uv_limits(&m, 0.002, 1.0 / 64);
        assert_int_equal(m.rung[EW_RUNG_EXACT] + m.rung[EW_RUNG_TABLE] + m.rung[EW_RUNG_RUNS], m.fragments);
        assert_true(m.u_rms <= 0.02 && m.v_rms <= 0.02);
        assert_int_equal(m.within_e, m.fragments);
        assert_true(m.disp_max == 0);
    }
}

static void table_rung(void **state)
{
    (void)state;
    for (char name = 'A'; name <= 'E'; name++) {
        measures m = draw(name, EW_RUNG_TABLE, 0);
        hold(name, &m);
        uv_limits(&m, 0.002, 1.0 / 64);
        assert_int_equal(m.rung[EW_RUNG_TABLE], m.fragments);
    }
}

/* Runs use their tolerance: with twice of it they may not, or the bound would be loose. */
static void runs_keep_their_tolerance_and_use_it(void **state)
{
    (void)state;
    for (uint16_t tolerance = 1; tolerance <= 32; tolerance = (uint16_t)(2 * tolerance)) {
        measures m = draw('D', EW_RUNG_RUNS, tolerance);
        hold('D', &m);
        test_context("tolerance %d/16: %.4f texels beyond, v rms %.4f", tolerance, m.uv_off, m.v_rms);
        assert_true(m.uv_off <= 1.0 / 64);
        /* v changes by up to 9 texels from pixel to pixel here; rms displacement is 0.2 of t and more */
        assert_true(m.v_rms > 0.02 * tolerance);
        test_context("tolerance %d/16: displacement %.4f", tolerance, m.disp_max);
        assert_true(m.disp_max <= tolerance / 16.0 + 1.0 / 256);
        assert_true(m.disp_max > 0.7 * tolerance / 16);
    }
}

/* One reciprocal for each pixel - the table's is good enough up to 1,408 texels -, or runs along
 * rows on which 1/z does not change. */
static void tolerance_zero_is_exact(void **state)
{
    (void)state;
    for (char name = 'A'; name <= 'E'; name++) {
        measures m = draw(name, EW_RUNG_AUTO, 0);
        hold(name, &m);
        assert_int_equal(m.rung[EW_RUNG_EXACT] + m.rung[EW_RUNG_TABLE] + m.rung[EW_RUNG_RUNS], m.fragments);
        assert_true(m.u_rms <= 0.02 && m.v_rms <= 0.02);
    }
}

/* Values and colours are held to the disc of the tolerance; affine triangles appear as the
 * tolerance grows, on the sphere's small triangles only, runs nearly everywhere else. */
static void automatic_choice_keeps_its_tolerance(void **state)
{
    (void)state;
    long before = 0;
    const uint16_t tolerances[] = { 1, 2, 4, 8, 16, 32 };
    for (int k = 0; k < 6; k++) {
        for (char name = 'A'; name <= 'E'; name++) {
            measures m = draw(name, EW_RUNG_AUTO, tolerances[k]);
            hold(name, &m);
            assert_true(m.uv_off <= 1.0 / 64);
            assert_true(m.disp_max <= tolerances[k] / 16.0 + 1.0 / 256);
            /* E, and a corner of C, reach so far that 32-bit steps would be felt */
            long exact = m.rung[EW_RUNG_EXACT];
            assert_int_equal(m.rung[EW_RUNG_AFFINE] + m.rung[EW_RUNG_RUNS] + exact, m.fragments);
            assert_true(name == 'E' || exact < m.fragments / 100);
            if (name != 'B') {
                assert_int_equal(m.rung[EW_RUNG_AFFINE], 0);
                continue;
            }
            test_context("tolerance %d/16: %ld affine fragments of B", tolerances[k], m.rung[EW_RUNG_AFFINE]);
            assert_true(m.rung[EW_RUNG_AFFINE] >= before);
            before = m.rung[EW_RUNG_AFFINE];
        }
    }
    assert_int_equal(before, 30620);
}

/* The affine rung is wrong on a floor, and the measure sees it: a check of the check. */
static void affine_is_noticed(void **state)
{
    (void)state;
    measures m = draw('D', EW_RUNG_AFFINE, 0);
    assert_int_equal(m.wrong_px, 0);
    assert_true(m.depth_max <= 1);
    assert_true(m.v_rms > 50);
    assert_true(m.colour_px > 10000);
    assert_true(m.disp_max > 50);
    /* the sphere's triangles are small: there the bound means something, and holds */
    m = draw('B', EW_RUNG_AFFINE, 0);
    test_context("displacement %.4f, bound %.4f", m.disp_max, m.affine_bound);
    assert_true(m.disp_max <= m.affine_bound);
    assert_true(m.disp_max > m.affine_bound / 2);
}

/* The referee's own picture and maps: background where nothing is, and where the drawn texel
 * is another one than the exact, the drawn value was off. */
static void maps_say_what_differs(void **state)
{
    (void)state;
    enum { PIXELS = STANDARD_WIDTH * STANDARD_HEIGHT };
    static uint16_t reference[PIXELS];
    static float displacement[PIXELS], off[PIXELS];
    const measure_maps maps = { reference, displacement, off };
    measure_want_maps(&maps);
    measures m = draw('B', EW_RUNG_AUTO, 4);
    long textured = 0, differ = 0;
    float most = 0;
    for (int i = 0; i < PIXELS; i++) {
        test_context("pixel %d: %04x, exact %04x, displacement %g, %g texels", i, colour[i], reference[i], displacement[i], off[i]);
        if (displacement[i] < 0) {
            assert_int_equal(reference[i], 0x1234);
            assert_int_equal(colour[i], 0x1234);
            continue;
        }
        textured++;
        differ += reference[i] != colour[i];
        assert_true(reference[i] == colour[i] || off[i] > 0);
        if (displacement[i] > most) most = displacement[i];
    }
    assert_int_equal(textured, m.covered_px);
    test_context("%ld of %ld differ", differ, textured);
    assert_true(differ > 0 && differ < textured / 10);
    assert_true(most == (float)m.disp_max); /* no overdraw in this scene */
}

/* scenes.c against the generator of the published figures, where that is at hand. */
static void scenes_are_the_published_ones(void **state)
{
    (void)state;
    const char *generator = test_shared("bench/gen_scene.py");
    if (!generator) skip();
    const char *const runs[] = { "A", "B", "C", "D", "E" };
    char command[2048];
    for (int k = 0; k < 5; k++) {
        char name = runs[k][0];
        /* D and E stand under the name C in other branches of the header's #if */
        snprintf(command, sizeof command,
                 "d=$(mktemp -d) && python3 - \"$PWD/%s\" \"$d\" >/dev/null <<'END' && cat $d/out; rm -rf $d\n"
                 "import os, re, runpy, sys\n"
                 "path, folder = sys.argv[1:]\n"
                 "os.chdir(folder)\n"
                 "runpy.run_path(path)\n"
                 "text = open('scene.h').read()\n"
                 "parts = re.split(r'#if[^\\n]*|#elif[^\\n]*|#else|#endif', text)\n"
                 "name = '%c'\n"
                 "part = {'A': text, 'B': text, 'C': parts[1], 'E': parts[2], 'D': parts[3]}[name]\n"
                 "tag = name if name in 'AB' else 'C'\n"
                 "out = open('out', 'w')\n"
                 "for what in ('v', 'uv', 't'):\n"
                 "    out.write(re.search(tag + '_' + what + r'\\[\\d+\\]=\\{([^}]*)\\}', part).group(1).replace(',', ' ') + '\\n')\n"
                 "END\n", generator, name);
        FILE *f = popen(command, "r");
        assert_non_null(f);
        standard_scene_init(&scene, name);
        int a, b, c;
        for (uint32_t i = 0; i < scene.vertex_count; i++) {
            test_context("scene %c vertex %u", name, i);
            assert_int_equal(fscanf(f, "%d %d %d", &a, &b, &c), 3);
            assert_true(a == scene.vertices[i].x && b == scene.vertices[i].y && c == -scene.vertices[i].z);
        }
        for (uint32_t i = 0; i < scene.vertex_count; i++) {
            assert_int_equal(fscanf(f, "%d %d", &a, &b), 2);
            assert_true(a == scene.vertices[i].u && b == scene.vertices[i].v);
        }
        for (uint32_t i = 0; i < scene.index_count; i += 3) {
            assert_int_equal(fscanf(f, "%d %d %d", &a, &b, &c), 3);
            assert_true(a == scene.indices[i] && c == scene.indices[i + 1] && b == scene.indices[i + 2]);
        }
        assert_int_equal(fscanf(f, "%d", &a), EOF);
        pclose(f);
    }
}

/* `make accuracy`: the same figures, printed. */
static void print_all(void)
{
    static const struct {
        const char *name;
        ew_rung rung;
        uint16_t tolerance;
    } rows[] = { { "exact", EW_RUNG_EXACT, 0 }, { "table", EW_RUNG_TABLE, 0 },   { "affine", EW_RUNG_AFFINE, 0 }, { "runs 1/4 px", EW_RUNG_RUNS, 4 },
                 { "auto 1/16 px", EW_RUNG_AUTO, 1 }, { "auto 1/4 px", EW_RUNG_AUTO, 4 },
                 { "auto 1 px", EW_RUNG_AUTO, 16 } };
    measure_print_heading();
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        for (char name = 'A'; name <= 'E'; name++) {
            char text[32];
            measures m = draw(name, rows[k].rung, rows[k].tolerance);
            snprintf(text, sizeof text, "%c %s", name, rows[k].name);
            measure_print(text, &m);
        }
    }
}

int main(void)
{
    if (getenv("EW_PRINT")) {
        print_all();
        return 0;
    }
    const struct CMUnitTest tests[] = {
        TEST(exact_rung),
        TEST(table_rung),
        TEST(runs_keep_their_tolerance_and_use_it),
        TEST(tolerance_zero_is_exact),
        TEST(automatic_choice_keeps_its_tolerance),
        TEST(affine_is_noticed),
        TEST(maps_say_what_differs),
        TEST(scenes_are_the_published_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
