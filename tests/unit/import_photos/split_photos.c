/* split_photos.c - photographs of multi-lens cameras: layout of the pictures, their content, when they are cut
 * again. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/import_photos/split_list.h"
#include "stages/import_photos/split_photos.h"

static const struct photo_params defaults = PHOTO_PARAMS_DEFAULT;

/* -------------------------------------------------------------------------------------------------------- the grid */

static void a_grid_is_parsed_as_columns_x_rows(void **state)
{
    static const char *const bad[] = {"",      "3",    "3x",   "x3",    "0x3",   "3x0",  "03x2", "3x02", "3X3",
                                      "3x3x3", "3x3 ", " 3x3", "100x2", "2x100", "-3x3", "3*3",  "1e1x2"};
    struct split_grid g;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(split_grid_parse(&g, "3x2", &defaults, &err), err);
    assert_true(g.columns == 3 && g.rows == 2 && !g.border && !g.gap && !g.dark);
    assert_ok(split_grid_parse(&g, "1x99", &defaults, &err), err);
    assert_true(g.columns == 1 && g.rows == 99);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        err = (struct err)ERR_INIT;
        assert_int_equal(split_grid_parse(&g, bad[i], &defaults, &err), ST_USAGE);
        assert_err(err, ST_USAGE, "COLUMNSxROWS");
    }
    err = (struct err)ERR_INIT;
    assert_int_equal(split_grid_parse(&g, "1x1", &defaults, &err), ST_USAGE);
    assert_err(err, ST_USAGE, "cuts nothing");
}

static void dark_lines_and_a_gap_exclude_each_other(void **state)
{
    struct photo_params p = PHOTO_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    (void)state;
    p.split_gap = 4;
    assert_ok(photo_params_check(&p, &err), err);
    p.split_dark = 20;
    assert_int_equal(photo_params_check(&p, &err), ST_USAGE);
    assert_err(err, ST_USAGE, "split_gap = 4");
}

/* A grey photo of 8 or 16 bits. */
static void make_photo(struct photo *p, int width, int height, int bits, uint16_t value)
{
    *p = (struct photo){.info = {.width = width, .height = height, .bits = bits, .orientation = 1}};
    p->samples = malloc((size_t)width * (size_t)height * 3 * sizeof *p->samples);
    assert_non_null(p->samples);
    for (int i = 0; i < width * height * 3; i++) p->samples[i] = value;
}

static void fill(struct photo *p, int x0, int y0, int x1, int y1, uint16_t value)
{
    for (int y = y0; y < y1; y++)
        for (int i = 3 * x0; i < 3 * x1; i++) p->samples[y * p->info.width * 3 + i] = value;
}

static void an_even_division_spreads_remainder_pixels(void **state)
{
    struct photo p;
    struct split_layout l;
    struct err err = ERR_INIT;
    (void)state;
    make_photo(&p, 100, 64, 8, 90);
    assert_ok(split_layout_find(&l, &(struct split_grid){4, 2, 0, 0, 0}, &p, "p", &err), err);
    assert_true(l.width == 25 && l.height == 32 && l.x[3] == 75 && l.y[1] == 32 && !l.over_width && !l.over_height);
    assert_ok(split_layout_find(&l, &(struct split_grid){3, 3, 0, 0, 0}, &p, "p", &err), err);
    assert_true(l.width == 33 && l.height == 21 && l.x[1] == 33 && l.x[2] == 66 && l.over_width == 1);
    assert_true(l.over_height == 1);
    assert_ok(split_layout_find(&l, &(struct split_grid){3, 1, 5, 6, 0}, &p, "p", &err), err);
    assert_true(l.width == 26 && l.height == 54 && l.x[0] == 5 && l.x[1] == 37 && l.x[2] == 69 && l.y[0] == 5);
    for (int columns = 1; columns <= 5; columns++) /* no picture is outside, none overlaps another */
        for (int border = 0; border < 4; border++)
            for (int gap = 0; gap < 4; gap++) {
                assert_ok(split_layout_find(&l, &(struct split_grid){columns, 2, border, gap, 0}, &p, "p", &err), err);
                for (int i = 0; i < columns; i++)
                    assert_true(l.x[i] >= border && (i ? l.x[i] >= l.x[i - 1] + l.width + gap : l.x[0] == border));
                assert_true(l.x[columns - 1] + l.width <= 100 - border);
            }
    const struct split_grid narrow[] = {{7, 1, 0, 0, 0}, {1, 5, 0, 0, 0}, {2, 1, 60, 0, 0}, {2, 1, 0, 100000, 0}};
    for (size_t i = 0; i < sizeof narrow / sizeof *narrow; i++) {
        err = (struct err)ERR_INIT;
        assert_int_equal(split_layout_find(&l, &narrow[i], &p, "p.png", &err), ST_DATA);
        assert_err(err, ST_DATA, "wanted at least 16");
    }
    photo_release(&p);
}

/* Lines of unequal width, away from the even division, with dust on them; 8 and 16 bits. */
static void dark_lines_are_found(void **state)
{
    const struct split_grid g = {3, 2, 0, 0, 20};
    struct photo p;
    struct split_layout l;
    struct err err = ERR_INIT;
    (void)state;
    for (int bits = 8; bits <= 16; bits += 8) {
        const uint16_t grey = bits == 8 ? 90 : 90 * 257, dark = bits == 8 ? 20 : 20 * 257;
        make_photo(&p, 320, 200, bits, grey);
        fill(&p, 0, 0, 7, 200, dark); /* border on the left: 7; pictures 7..107, 113..213, 216..316 */
        fill(&p, 107, 0, 113, 200, dark);
        fill(&p, 213, 0, 216, 200, dark);
        fill(&p, 316, 0, 320, 200, dark);
        fill(&p, 0, 98, 320, 103, dark); /* pictures 0..98, 103..200: 97 rows each, the upper one from 0 */
        fill(&p, 109, 50, 110, 53, grey);
        fill(&p, 40, 0, 42, 60, dark); /* a dark object in a picture is not a line */
        assert_ok(split_layout_find(&l, &g, &p, "p", &err), err);
        assert_true(l.width == 100 && l.x[0] == 7 && l.x[1] == 113 && l.x[2] == 216);
        assert_true(l.height == 97 && l.y[0] == 0 && l.y[1] == 103);
        photo_release(&p);
    }
}

static void missing_dark_lines_are_reported(void **state)
{
    const struct split_grid g = {2, 1, 0, 0, 20};
    struct photo p;
    struct split_layout l;
    struct err err = ERR_INIT;
    (void)state;
    make_photo(&p, 200, 100, 8, 90);
    assert_int_equal(split_layout_find(&l, &g, &p, "plain.png", &err), ST_DATA);
    assert_err(err, ST_DATA, "plain.png: columns 88 to 111 contain no dark line");
    fill(&p, 89, 0, 91, 100, 0); /* a line between unequal pictures */
    err = (struct err)ERR_INIT;
    assert_int_equal(split_layout_find(&l, &g, &p, "uneven.png", &err), ST_DATA);
    assert_err(err, ST_DATA, "89 to 109 columns wide");
    fill(&p, 0, 0, 200, 100, 3);
    err = (struct err)ERR_INIT;
    assert_int_equal(split_layout_find(&l, &g, &p, "night.png", &err), ST_DATA);
    assert_err(err, ST_DATA, "leaves 0 px");
    photo_release(&p);
}

/* ----------------------------------------------------------------------------------------------------- the pictures */

static char photos[300], cuts[300];

static int fresh(void **state)
{
    static int number;
    (void)state;
    snprintf(photos, sizeof photos, "%s/%d-photos", scratch, ++number);
    snprintf(cuts, sizeof cuts, "%s/%d-cuts", scratch, number);
    return mkdir(photos, 0777);
}

static const char *in(const char *folder, const char *name)
{
    static char paths[4][700];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

static const struct photo_info exif = {0,   0,  0,    1, 24.5, 35, 1.0 / 60, 5.6, 400, "remodel", "nine lenses",
                                       1e9, "", false};

/* A photo of 3 x 2 pictures of 20 x 30 px; picture (x, y) has the grey value 30 + 60 x + 5 y + more. */
static void put(const char *name, int more)
{
    struct photo p;
    struct err err = ERR_INIT;
    make_photo(&p, 60, 60, 8, 0);
    for (int x = 0; x < 3; x++)
        for (int y = 0; y < 2; y++)
            fill(&p, 20 * x, 30 * y, 20 * x + 20, 30 * y + 30, (uint16_t)(30 + 60 * x + 5 * y + more));
    assert_ok(photo_write_part(in(photos, name), &p, 0, 0, 60, 60, &exif, &err), err);
    photo_release(&p);
}

static enum status split(const char *grid, const char *exclude, struct err *err)
{
    struct photo_scan scan;
    struct split_grid g;
    *err = (struct err)ERR_INIT;
    if (!split_grid_parse(&g, grid, &defaults, err)) photo_scan_folder(&scan, photos, err);
    if (!err->status && exclude) photo_scan_exclude(&scan, exclude);
    if (!err->status) split_photos(&scan, &g, cuts, err);
    photo_scan_release(&scan);
    return err->status;
}

static void assert_grey(const char *cut, int grey)
{
    struct photo p;
    struct err err = ERR_INIT;
    assert_ok(photo_read(&p, in(cuts, cut), &err), err);
    assert_true(p.info.width == 20 && p.info.height == 30);
    for (int i = 0; i < 20 * 30 * 3; i++) assert_int_equal(p.samples[i], grey);
    photo_release(&p);
}

static struct timespec time_of(const char *cut)
{
    struct stat info;
    assert_int_equal(stat(in(cuts, cut), &info), 0);
    return info.st_mtim;
}

static bool newer(const char *cut, struct timespec before)
{
    const struct timespec t = time_of(cut);
    return t.tv_sec != before.tv_sec || t.tv_nsec != before.tv_nsec;
}

static void pictures_are_cut_and_listed(void **state)
{
    struct err err;
    struct split_list list;
    (void)state;
    put("IMG 1.png", 0);
    assert_ok(split("3x2", NULL, &err), err);
    for (int x = 0; x < 3; x++)
        for (int y = 0; y < 2; y++) {
            char name[40];
            snprintf(name, sizeof name, "IMG_1_c%dr%d.png", x + 1, y + 1);
            assert_grey(name, 30 + 60 * x + 5 * y);
        }
    struct photo_info info;
    assert_ok(photo_read_info(&info, in(cuts, "IMG_1_c3r2.png"), &err), err);
    assert_true(info.focal_mm == 24.5 && info.f_number == 5.6 && info.iso == 400);
    assert_true(info.focal35_mm == round(35 * hypot(60, 60) / hypot(20, 30))); /* same angle per pixel */
    assert_string_equal(info.model, "nine lenses");
    assert_ok(split_list_read(&list, in(cuts, "split.txt"), &err), err);
    assert_int_equal(list.count, 1);
    assert_string_equal(list.photos[0].file, "IMG 1.png");
    char hash[HASH_TEXT];
    assert_ok(hash_file(hash, in(photos, "IMG 1.png"), &err), err);
    assert_string_equal(list.photos[0].hash, hash);
    assert_true(list.photos[0].width == 20 && list.photos[0].height == 30 && list.photos[0].count == 6);
    const struct split_cut *c = &list.photos[0].cuts[5];
    assert_string_equal(c->file, "IMG_1_c3r2.png");
    assert_true(c->x == 40 && c->y == 30);
    split_list_release(&list);
    split_list_release(&list);
    assert_int_equal(count_entries(cuts), 7);
}

static void only_changed_photos_are_cut_again(void **state)
{
    struct err err;
    (void)state;
    put("a.png", 0);
    put("b.png", 1);
    assert_ok(split("3x2", NULL, &err), err);
    const struct timespec a = time_of("a_c1r1.png"), b = time_of("b_c2r1.png"), list = time_of("split.txt");
    assert_ok(split("3x2", NULL, &err), err);
    assert_false(newer("a_c1r1.png", a) || newer("b_c2r1.png", b) || newer("split.txt", list));
    put("b.png", 2);
    assert_ok(split("3x2", NULL, &err), err);
    assert_false(newer("a_c1r1.png", a));
    assert_grey("b_c2r1.png", 92);
    assert_int_equal(remove(in(cuts, "a_c2r2.png")), 0); /* one removed, one damaged */
    assert_ok(split("3x2", NULL, &err), err);
    assert_grey("a_c2r2.png", 95);
    assert_int_equal(rename(in(cuts, "a_c1r1.png"), in(cuts, "a_c2r2.png")), 0);
    assert_ok(split("3x2", NULL, &err), err);
    assert_grey("a_c2r2.png", 95);
    assert_grey("a_c1r1.png", 30);
    scratch_write(in(cuts, "split.txt") + strlen(scratch) + 1, "remodel-split 1\ngrid 3"); /* truncated list */
    assert_ok(split("3x2", NULL, &err), err);
    assert_grey("a_c1r1.png", 30);
    assert_ok(split("3x1", NULL, &err), err); /* another grid */
    assert_int_equal(count_entries(cuts), 7);
    assert_int_equal(access(in(cuts, "a_c1r2.png"), F_OK), -1);
    assert_ok(split("3x2", "b", &err), err);
    assert_int_equal(count_entries(cuts), 7);
    assert_int_equal(access(in(cuts, "b_c1r1.png"), F_OK), -1);
}

static void an_unusable_photo_is_reported_and_old_pictures_stay(void **state)
{
    struct err err;
    (void)state;
    put("a.png", 0);
    put("b.png", 0);
    assert_ok(split("3x2", NULL, &err), err);
    const struct timespec list = time_of("split.txt");
    scratch_write(in(photos, "b.png") + strlen(scratch) + 1, "no picture");
    assert_int_equal(split("3x2", NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "EXCLUDE = b");
    assert_false(newer("split.txt", list));
    assert_grey("b_c1r1.png", 30);
    assert_int_equal(split("9x2", "b", &err), ST_DATA); /* pictures of 6 px */
    assert_err(err, ST_DATA, "EXCLUDE = a");
    assert_ok(split("3x2", "b", &err), err);
    remove(in(photos, "a.png"));
    assert_int_equal(split("3x2", "b", &err), ST_DATA);
    assert_err(err, ST_DATA, "no photo besides those left out");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_grid_is_parsed_as_columns_x_rows),
        cmocka_unit_test(dark_lines_and_a_gap_exclude_each_other),
        cmocka_unit_test(an_even_division_spreads_remainder_pixels),
        cmocka_unit_test(dark_lines_are_found),
        cmocka_unit_test(missing_dark_lines_are_reported),
        cmocka_unit_test_setup(pictures_are_cut_and_listed, fresh),
        cmocka_unit_test_setup(only_changed_photos_are_cut_again, fresh),
        cmocka_unit_test_setup(an_unusable_photo_is_reported_and_old_pictures_stay, fresh),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
