/* validity.c - tests of writing and reading validity.txt, and of its error messages. */
#include "common/film/validity.h"

#include "tests/unit/scratch.h"

static struct validity a_validity(void)
{
    struct validity v = {.effect = {MOVE_DOLLY, FOCUS_PULL, TONE_NONE},
                         .shot = {.lens = {.name = "film",
                                           .width = 320,
                                           .height = 240,
                                           .fx = 1e3 / 3,
                                           .fy = 1e3 / 3,
                                           .cx = 160,
                                           .cy = 121.5},
                                  .up = {0.1, -sqrt(0.98), 0.1},
                                  .origin = {1 / 3.0, -2e-300, 3e200},
                                  .axis_x = {1, 0, 0},
                                  .axis_y = {0, 0.6, 0.8},
                                  .axis_z = {0, -0.8, 0.6},
                                  .low = {-0.1, -1 / 7.0},
                                  .high = {0.2, 1 / 7.0},
                                  .centroid = {4, 5, M_PI},
                                  .near_limit = 0.7,
                                  .median_depth = 3.1},
                         .zoom = 1.1,
                         .step = 0.0155,
                         .limits = {2.5, 0.03, 240},
                         .move = {.move = MOVE_DOLLY,
                                  .end = {{.target = {1, 2, 1 / 3.0}, .focal = 500.1},
                                          {.target = {-0.0, 1e-17, 2},
                                           .size = 45.6,
                                           .corner = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9.000000001}, {10, 11, 12}}}}}};
    struct err err = ERR_INIT;
    assert_ok(validity_region_init(&v.region[0], 3, 2, &err), err);
    assert_ok(validity_region_init(&v.region[1], 1, 1, &err), err);
    for (int i = 0; i < 6; i++) {
        struct validity_cell *c = &v.region[0].cells[i];
        *c = (struct validity_cell){.x = i / 7.0, .y = -i / 3.0, .valid = i % 3};
        if (c->valid) c->low = -1 / (1.0 + i), c->high = i / 11.0;
    }
    v.region[1].cells[0] = (struct validity_cell){.valid = true};
    return v;
}

static void assert_same(const struct validity *a, const struct validity *b)
{
    assert_memory_equal(&a->effect, &b->effect, sizeof a->effect);
    const struct view *l = &a->shot.lens, *m = &b->shot.lens;
    assert_true(l->width == m->width && l->height == m->height && l->fx == m->fx && l->fy == m->fy && l->cx == m->cx &&
                l->cy == m->cy);
    assert_memory_equal(&a->shot.up, &b->shot.up,
                        sizeof a->shot - offsetof(struct shot_setup, up)); /* only doubles from here on */
    assert_true(a->move.move == b->move.move && a->move.on_axis == b->move.on_axis);
    assert_memory_equal(a->move.end, b->move.end, sizeof a->move.end);
    assert_true(a->zoom == b->zoom && a->step == b->step && a->limits.max_h == b->limits.max_h &&
                a->limits.max_outside == b->limits.max_outside && a->limits.side == b->limits.side);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(a->region[k].columns, b->region[k].columns);
        assert_int_equal(a->region[k].rows, b->region[k].rows);
        for (int i = 0; i < a->region[k].columns * a->region[k].rows; i++) {
            const struct validity_cell *c = &a->region[k].cells[i], *d = &b->region[k].cells[i];
            assert_true(c->x == d->x && c->y == d->y && c->valid == d->valid && c->low == d->low && c->high == d->high);
        }
    }
}

static void a_written_file_reads_back_to_the_same_bits(void **state)
{
    (void)state;
    const char *path = scratch_path("validity.txt");
    struct err err = ERR_INIT;
    struct validity v = a_validity(), again;
    const struct provenance prov = {.stage = "sample_validity", .version = "0"};
    for (int i = 0; i < 2; i++) {
        assert_ok(validity_write(&v, path, i ? &prov : NULL, &err), err);
        assert_ok(validity_read(&again, path, NULL, &err), err);
        assert_same(&v, &again);
        assert_int_equal(validity_region_count(&again.region[0]), 4);
        assert_int_equal(validity_region_count(&again.region[1]), 1);
        char *first = scratch_read(path);
        assert_ok(validity_write(&again, path, i ? &prov : NULL, &err), err);
        assert_file_text(path, first);
        free(first);
        validity_release(&again);
    }
    validity_release(&v);
    validity_release(&v);
    validity_release(NULL);
}

static void moves_on_the_axis_read_back_the_same(void **state)
{
    (void)state;
    const char *path = scratch_path("axis.txt");
    struct err err = ERR_INIT;
    struct validity v = a_validity(), again;
    v.effect = (struct film_effect){MOVE_DOLLY_ZOOM, FOCUS_NARROW, TONE_DIM};
    v.move.move = MOVE_DOLLY_ZOOM;
    v.move.on_axis = true;
    assert_ok(validity_write(&v, path, NULL, &err), err);
    assert_ok(validity_read(&again, path, NULL, &err), err);
    assert_same(&v, &again);
    validity_release(&again);
    validity_release(&v);
}

/* ----------------------------------------------------------------------------------------------------- broken files */

static const char *const valid_lines[] = {
    "remodel-validity 1",
    "effect dolly_in+dim",
    "film 32 24 30 16 12",
    "zoom 1",
    "near_limit 1",
    "median_depth 5",
    "up 0 -1 0",
    "origin 0 0 0",
    "axis_x 1 0 0",
    "axis_y 0 1 0",
    "axis_z 0 0 1",
    "centroid 0 0 5",
    "box -1 -1 1 1",
    "limits 2 0.03 240",
    "step 0.01",
    "on_axis 0",
    "end target 0 0 5 focal 30",
    "region 2 1",
    "cell -1 0 none",
    "cell 1 0 from -0.5 to 0.25",
    "end target 0 0 5 size 9 0 0 5 1 0 5 1 1 5 0 1 5",
    "region 1 1",
    "cell 0 0 from 0 to 0",
};
enum { LINES = sizeof valid_lines / sizeof *valid_lines };

/* Reads the first `lines` valid lines, with number `line` (from 1; 0: none) replaced by `text`. */
static enum status read_changed(struct validity *v, int line, const char *text, int lines, struct err *err)
{
    char whole[4096] = "";
    for (int i = 0; i < lines; i++) {
        strcat(whole, i + 1 == line ? text : i < LINES ? valid_lines[i] : "cell 9 9 none");
        strcat(whole, "\n");
    }
    return validity_read(v, scratch_write("broken.txt", whole), NULL, err);
}

static void bad_lines_are_refused_with_file_and_line(void **state)
{
    (void)state;
    static const struct {
        int line;
        const char *text, *words;
    } bad[] = {
        {1, "remodel-path 1", "wanted a line \"remodel-validity ...\""},
        {1, "remodel-validity 2", "found \"2\", wanted the version"},
        {1, "remodel-validity 1 x", "found \"x\""},
        {2, "effect", "an effect"},
        {2, "effect dolly_inn", "did you mean dolly_in?"},
        {2, "effect dolly_in+dimm", "did you mean dim?"},
        {2, "effects dolly_in", "wanted \"effect\""},
        {3, "film 31 24 30 16 12", "even numbers from 2 to 65536"},
        {3, "film 32 0 30 16 12", "even numbers from 2 to 65536"},
        {3, "film 32 65538 30 16 12", "even numbers from 2 to 65536"},
        {3, "film 32 24 0 16 12", "a focal length of 0 or less"},
        {3, "film 32 24 30 16", "wanted film"},
        {3, "film 32 24 30 nan 12", "found \"nan\""},
        {3, "film 32 24 30 16 12 1", "found \"1\""},
        {4, "zoom one", "found \"one\""},
        {4, "zoom", "wanted zoom"},
        {4, "zoom 0", "a zoom of 0 or less"},
        {5, "near_limit inf", "found \"inf\""},
        {6, "median_depth 0", "a median depth of 0 or less"},
        {6, "median_depth -5", "a median depth of 0 or less"},
        {7, "up 0 -1", "up"},
        {8, "origin 0 0 0 0", "found \"0\""},
        {9, "axis_y 1 0 0", "wanted \"axis_x\""},
        {12, "centroid a 0 5", "found \"a\""},
        {13, "box -1 -1 -1 1", "an empty box"},
        {13, "box -1 1 1 -1", "an empty box"},
        {14, "limits 2 0.03 0", "an invalid side"},
        {14, "limits 2 0.03 1e9", "an invalid side"},
        {15, "step 0", "a step of 0 or less"},
        {16, "on_axis 2", "found \"2\""},
        {17, "end 0 0 5 focal 30", "wanted \"target\""},
        {17, "end target 0 0 5 zoom 30", "\"focal\" or \"size\""},
        {17, "end target 0 0 5 focal 0", "a focal length of 0 or less"},
        {17, "end target 0 0 5 focal", "the focal length"},
        {17, "end target 0 0 5 focal 30 40", "found \"40\""},
        {21, "end target 0 0 5 size 0 0 0 5 1 0 5 1 1 5 0 1 5", "a size of 0 or less"},
        {21, "end target 0 0 5 size 9 0 0 5 1 0 5 1 1 5 0 1", "a corner"},
        {18, "region 0 1", "found \"0\""},
        {18, "region 100 100", "found \"100\""},
        {18, "region 2 1.5", "found \"1.5\""},
        {18, "region 3 1", ":21:"}, /* the third cell is missing */
        {19, "cell -1 0", "\"from\" or \"none\""},
        {19, "cell -1 0 maybe", "found \"maybe\""},
        {19, "cell -1 0 none 3", "found \"3\""},
        {20, "cell 1 0 from 0.5 to 0.25", "a lowest z above the highest"},
        {20, "cell 1 0 from 0.5 0.25", "wanted \"to\""},
        {20, "cell 1 0 from nan to 0.25", "found \"nan\""},
    };
    struct validity v;
    struct err err = ERR_INIT;
    assert_ok(read_changed(&v, 0, NULL, LINES, &err), err);
    assert_int_equal(v.effect.move, MOVE_DOLLY_IN);
    assert_int_equal(v.effect.tone, TONE_DIM);
    assert_true(v.region[0].cells[1].low == -0.5 && v.region[0].cells[1].high == 0.25 && !v.region[0].cells[0].valid);
    validity_release(&v);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char location[32];
        snprintf(location, sizeof location,
                 "broken.txt:%d: ", bad[i].line == 18 && bad[i].words[0] == ':' ? 21 : bad[i].line);
        err = (struct err)ERR_INIT;
        if (!read_changed(&v, bad[i].line, bad[i].text, LINES, &err)) fail_msg("accepted: %s", bad[i].text);
        assert_err(err, ST_DATA, bad[i].words);
        assert_contains(err.text, location);
        assert_true(!v.region[0].cells && !v.region[1].cells);
    }
}

static void truncated_and_overlong_files_are_refused(void **state)
{
    (void)state;
    struct validity v;
    for (int lines = 0; lines <= LINES + 1; lines++) {
        struct err err = ERR_INIT;
        char location[32];
        if (lines == LINES) continue;
        snprintf(location, sizeof location, lines ? "broken.txt:%d: " : "broken.txt: found an empty file", lines);
        assert_int_equal(read_changed(&v, 0, NULL, lines, &err), ST_DATA);
        assert_err(err, ST_DATA, "wanted");
        assert_contains(err.text, location);
        assert_true(!v.region[0].cells && !v.region[1].cells);
    }
    struct err err = ERR_INIT;
    assert_int_equal(validity_read(&v, scratch_path("nowhere.txt"), NULL, &err), ST_IO);
    assert_contains(err.text, "nowhere.txt");
}

/* Three cells in a row, of which the last is not valid. */
static void ranges_are_interpolated_between_valid_cells(void **state)
{
    (void)state;
    struct validity_cell cells[6] = {{0, 0, true, -1, 1}, {1, 0, true, -3, 2}, {2, 0, false, 0, 0},
                                     {0, 1, true, -1, 1}, {1, 1, true, -3, 2}, {2, 1, false, 0, 0}};
    const struct validity_region r = {3, 2, cells};
    double low, high;
    assert_float_equal(validity_region_at(&r, 0.25, 0.5, &low, &high), 1, 1e-12);
    assert_true(fabs(low + 1.5) < 1e-12 && fabs(high - 1.25) < 1e-12);
    const double weight = validity_region_at(&r, 1.75, 0, &low, &high);
    assert_float_equal(weight, 0.25, 1e-12);
    assert_true(fabs(low / weight + 3) < 1e-12 && fabs(high / weight - 2) < 1e-12);
    assert_float_equal(validity_region_at(&r, -5, 9, &low, &high), 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_written_file_reads_back_to_the_same_bits),
        cmocka_unit_test(moves_on_the_axis_read_back_the_same),
        cmocka_unit_test(bad_lines_are_refused_with_file_and_line),
        cmocka_unit_test(truncated_and_overlong_files_are_refused),
        cmocka_unit_test(ranges_are_interpolated_between_valid_cells),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
