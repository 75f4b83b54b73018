/* bracket_views.c - grouping of photos by exposure: views, their names, errors. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/import_photos/bracket_views.h"

#define GOOD "tests/fuzz/corpus/photo/rgb.jpg"

static char photos[300], records[300], scene[300];

/* Three empty folders. */
static int fresh(void **state)
{
    static int number;
    (void)state;
    snprintf(photos, sizeof photos, "%s/%d-photos", scratch, ++number);
    snprintf(records, sizeof records, "%s/%d-records", scratch, number);
    snprintf(scene, sizeof scene, "%s/%d-scene", scratch, number);
    return mkdir(photos, 0777) || mkdir(records, 0777) || mkdir(scene, 0777);
}

static void put(const char *name)
{
    char path[1024];
    unsigned char bytes[4096];
    FILE *in = fopen(GOOD, "rb");
    assert_non_null(in);
    size_t size = fread(bytes, 1, sizeof bytes, in);
    fclose(in);
    snprintf(path, sizeof path, "%s/%s", photos, name);
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(bytes, 1, size, out), size);
    assert_int_equal(fclose(out), 0);
}

static void put_text(const char *folder, const char *name, const char *text)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    assert_true(fputs(text, out) >= 0);
    assert_int_equal(fclose(out), 0);
}

static void file_is(const char *name, const char *wanted)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", records, name);
    assert_file_text(path, wanted);
}

struct import {
    struct photo_scan scan;
    struct bracket_views views;
    struct err err;
};

static void import_release(struct import *im)
{
    bracket_views_release(&im->views);
    photo_scan_release(&im->scan);
}

/* name and seconds of each photo, or SECONDS@TAKEN; NULL: unknown. */
static enum status import(struct import *im, const char *const (*shots)[2], int count, const char *brackets,
                          const char *exclude)
{
    struct photo_params params = PHOTO_PARAMS_DEFAULT;
    bool used[1] = {false};
    *im = (struct import){.err = ERR_INIT};
    strcpy(params.brackets, brackets);
    for (int i = 0; i < count; i++) put(shots[i][0]);
    photo_scan_folder(&im->scan, photos, &im->err);
    if (!im->err.status && exclude) photo_scan_exclude(&im->scan, exclude);
    if (!im->err.status) photo_scan_check(&im->scan, records, &im->err);
    for (int i = 0; !im->err.status && i < im->scan.count; i++)
        for (int k = 0; k < count; k++)
            if (!strcmp(im->scan.photos[i].file, shots[k][0]) && shots[k][1]) {
                char *end;
                im->scan.photos[i].record.info.seconds = strtod(shots[k][1], &end);
                if (*end == '@') im->scan.photos[i].record.info.taken = strtod(end + 1, NULL);
            }
    if (!im->err.status)
        bracket_views_find(&im->views, &im->scan, scene, &params, &exclude, exclude ? 1 : 0, used, &im->err);
    return im->err.status;
}

static const char *const cycle[9][2] = {{"v1_e0.jpg", "0.1"}, {"v1_e1.jpg", "0.4"}, {"v1_e2.jpg", "1.6"},
                                        {"v2_e0.jpg", "0.1"}, {"v2_e1.jpg", "0.4"}, {"v2_e2.jpg", "1.6"},
                                        {"v3_e0.jpg", "0.1"}, {"v3_e1.jpg", "0.4"}, {"v3_e2.jpg", "1.6"}};

static void a_cycle_of_exposures_makes_views(void **state)
{
    struct import im;
    (void)state;
    assert_ok(import(&im, cycle, 9, "auto", NULL), im.err);
    assert_true(im.views.bracketed);
    assert_int_equal(im.views.count, 3);
    assert_string_equal(im.views.views[1].id, "v2");
    assert_int_equal(im.views.views[1].count, 3);
    assert_int_equal(im.views.views[1].middle, 1);
    assert_true(fabs(im.views.white - 0.4) <= 1e-12);
    assert_ok(bracket_views_write(&im.views, &im.scan, records, &im.err), im.err);
    file_is("photos.mk", "PHOTO_IDS := v1 v2 v3\nBRACKETED := yes\n");
    file_is("list.txt", "v1 v1.jpg\nv2 v2.jpg\nv3 v3.jpg\n");
    file_is("brackets.txt", "# VIEW FILE FILE ... from the shortest exposure on\nv1 v1_e0.jpg v1_e1.jpg v1_e2.jpg\n"
                            "v2 v2_e0.jpg v2_e1.jpg v2_e2.jpg\nv3 v3_e0.jpg v3_e1.jpg v3_e2.jpg\n");
    struct photo_list list;
    assert_ok(photo_list_read(&list, records, &im.err), im.err);
    assert_int_equal(list.photos[0].bracket_count, 3);
    assert_string_equal(list.photos[0].brackets[2].file, "v1_e2.jpg");
    assert_true(fabs(list.photos[0].brackets[2].exposure - 1.6) <= 1e-12);
    assert_true(fabs(list.photos[0].info.seconds - 0.4) <= 1e-12);
    photo_list_release(&list);
    import_release(&im);
    import_release(&im);
}

/* A running counter: numbers are ordered by value, and the stem that all views share cannot be their name. */
static void views_with_equal_stems_are_named_after_their_first_photo(void **state)
{
    static const char *const shots[6][2] = {{"IMG_8.jpg", "1"},  {"IMG_9.jpg", "0.5"},  {"IMG_10.jpg", "2"},
                                            {"IMG_11.jpg", "1"}, {"IMG_12.jpg", "0.5"}, {"IMG_13.jpg", "2"}};
    struct import im;
    (void)state;
    assert_ok(import(&im, shots, 6, "auto", NULL), im.err);
    assert_int_equal(im.views.count, 2);
    assert_string_equal(im.views.views[0].id, "IMG_11");
    assert_string_equal(im.views.views[1].id, "IMG_8");
    assert_string_equal(im.scan.photos[im.views.views[1].photos[0]].file, "IMG_9.jpg"); /* the shortest */
    import_release(&im);
}

/* Views and files in another order give the same records. */
static void the_order_in_brackets_txt_does_not_matter(void **state)
{
    struct import im;
    char *text[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        char path[400];
        put_text(
            scene, "brackets.txt",
            i ? "b v2_e2.jpg v2_e0.jpg v2_e1.jpg\na v1_e1.jpg v1_e2.jpg v1_e0.jpg\nc v3_e2.jpg v3_e1.jpg v3_e0.jpg\n"
              : "a v1_e0.jpg v1_e1.jpg v1_e2.jpg\nb v2_e0.jpg v2_e1.jpg v2_e2.jpg\nc v3_e0.jpg v3_e1.jpg v3_e2.jpg\n");
        assert_ok(import(&im, cycle, 9, "auto", NULL), im.err);
        assert_int_equal(im.views.count, 3);
        assert_ok(bracket_views_write(&im.views, &im.scan, records, &im.err), im.err);
        import_release(&im);
        snprintf(path, sizeof path, "%s/b.txt", records);
        text[i] = scratch_read(path);
    }
    assert_string_equal(text[0], text[1]);
    free(text[0]);
    free(text[1]);
}

/* The ids of the view's photos, from the shortest exposure on. */
static void assert_view(const struct import *im, const char *id, const char *files)
{
    for (int i = 0; i < im->views.count; i++) {
        const struct bracket_view *view = &im->views.views[i];
        char text[400] = "";
        if (strcmp(view->id, id) != 0) continue;
        for (int k = 0; k < view->count; k++) {
            size_t n = strlen(text);
            snprintf(text + n, sizeof text - n, "%s%s", k ? " " : "", im->scan.photos[view->photos[k]].file);
        }
        assert_string_equal(text, files);
        return;
    }
    fail_msg("no view %s", id);
}

/* The counter wraps between two exposures of a view, with one clock of whole seconds and one with sub-seconds. */
static void views_follow_the_clock_not_the_counter(void **state)
{
    static const char *const seconds[9][2] = {
        {"DSC_9995.JPG", "0.02@1000"}, {"DSC_9996.JPG", "0.005@1000"}, {"DSC_9997.JPG", "0.08@1001"},
        {"DSC_9998.JPG", "0.02@1060"}, {"DSC_9999.JPG", "0.005@1060"}, {"DSC_0001.JPG", "0.08@1060"},
        {"DSC_0002.JPG", "0.02@1120"}, {"DSC_0003.JPG", "0.005@1120"}, {"DSC_0004.JPG", "0.08@1121"}};
    static const char *const parts[9][2] = {
        {"DSC_9995.JPG", "0.02@1000.1"}, {"DSC_9996.JPG", "0.005@1000.3"}, {"DSC_9997.JPG", "0.08@1000.5"},
        {"DSC_9998.JPG", "0.02@1060.0"}, {"DSC_9999.JPG", "0.005@1060.2"}, {"DSC_0001.JPG", "0.08@1060.4"},
        {"DSC_0002.JPG", "0.02@1120.4"}, {"DSC_0003.JPG", "0.005@1120.6"}, {"DSC_0004.JPG", "0.08@1120.8"}};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct import im;
        fresh(NULL);
        assert_ok(import(&im, i ? parts : seconds, 9, "auto", NULL), im.err);
        assert_int_equal(im.views.count, 3);
        assert_view(&im, "DSC_9995", "DSC_9996.JPG DSC_9995.JPG DSC_9997.JPG");
        assert_view(&im, "DSC_9998", "DSC_9999.JPG DSC_9998.JPG DSC_0001.JPG");
        assert_view(&im, "DSC_0002", "DSC_0003.JPG DSC_0002.JPG DSC_0004.JPG");
        import_release(&im);
    }
}

/* Without times the order is that of names; so it is where only names give a complete cycle. */
static void views_follow_the_names_where_the_clock_does_not_help(void **state)
{
    const char *shots[9][2];
    struct import im;
    (void)state;
    memcpy(shots, cycle, sizeof shots);
    shots[0][1] = "0.1@1000"; /* one time alone says nothing */
    assert_ok(import(&im, (const char *const(*)[2])shots, 9, "auto", NULL), im.err);
    assert_view(&im, "v1", "v1_e0.jpg v1_e1.jpg v1_e2.jpg");
    import_release(&im);
    static const char *const clocks[9][2] = {/* two cameras with clocks of their own */
                                             {"a1.jpg", "0.1@10"}, {"a2.jpg", "0.4@12"}, {"a3.jpg", "1.6@14"},
                                             {"b1.jpg", "0.1@11"}, {"b2.jpg", "0.4@13"}, {"b3.jpg", "1.6@15"},
                                             {"c1.jpg", "0.1@70"}, {"c2.jpg", "0.4@71"}, {"c3.jpg", "1.6@72"}};
    fresh(NULL);
    assert_ok(import(&im, clocks, 9, "auto", NULL), im.err);
    assert_int_equal(im.views.count, 3);
    assert_view(&im, "b1", "b1.jpg b2.jpg b3.jpg");
    import_release(&im);
}

static void views_may_have_bases_of_their_own(void **state)
{
    static const char *const shots[12][2] = {
        {"i01.jpg", "0.0166667"}, {"i02.jpg", "0.0041667"}, {"i03.jpg", "0.0666667"}, {"i04.jpg", "0.0333333"},
        {"i05.jpg", "0.0083333"}, {"i06.jpg", "0.125"},     {"i07.jpg", "0.008"},     {"i08.jpg", "0.002"},
        {"i09.jpg", "0.0333333"}, {"i10.jpg", "0.0125"},    {"i11.jpg", "0.003125"},  {"i12.jpg", "0.05"}};
    struct import im;
    (void)state;
    assert_ok(import(&im, shots, 12, "auto", NULL), im.err);
    assert_int_equal(im.views.count, 4);
    assert_view(&im, "i04", "i05.jpg i04.jpg i06.jpg");
    assert_true(fabs(im.views.white - 0.0125) < 1e-9); /* the median of the middle exposures, the shorter one */
    import_release(&im);
    assert_int_equal(import(&im, shots, 11, "yes", NULL), ST_DATA);
    assert_err(im.err, ST_DATA, "(the first; others have the same steps) in order of file name");
    assert_contains(im.err.text, "i10.jpg (1/80 s), i11.jpg (1/320 s), i12.jpg (no exposure time).");
    import_release(&im);
}

static void exposures_of_all_views_may_be_equal(void **state)
{
    static const char *const four[] = {"0.0041667", "0.0166667", "0.0166667", "0.0666667"};
    char names[16][8];
    const char *shots[16][2];
    struct import im;
    struct photo_list list;
    (void)state;
    for (int i = 0; i < 16; i++) {
        snprintf(names[i], sizeof names[i], "%02d.jpg", i);
        shots[i][0] = names[i];
        shots[i][1] = four[i % 4];
    }
    assert_ok(import(&im, (const char *const(*)[2])shots, 16, "auto", NULL), im.err);
    assert_int_equal(im.views.count, 4);
    assert_view(&im, "04", "04.jpg 05.jpg 06.jpg 07.jpg");
    assert_ok(bracket_views_write(&im.views, &im.scan, records, &im.err), im.err);
    assert_ok(photo_list_read(&list, records, &im.err), im.err);
    assert_true(list.photos[1].brackets[1].exposure == list.photos[1].brackets[2].exposure);
    photo_list_release(&list);
    import_release(&im);
}

static void photos_without_a_cycle_stay_single(void **state)
{
    static const char *const few[4][2] = {{"a.jpg", "1"}, {"b.jpg", "2"}, {"c.jpg", "1"}, {"d.jpg", "2"}};
    static const char *const same[6][2] = {{"a.jpg", "1"}, {"b.jpg", "1"}, {"c.jpg", "1"},
                                           {"d.jpg", "1"}, {"e.jpg", "1"}, {"f.jpg", "1"}};
    static const char *const wild[8][2] = {{"a.jpg", "1"}, {"b.jpg", "2"},   {"c.jpg", "1"}, {"d.jpg", "1"},
                                           {"e.jpg", "2"}, {"f.jpg", "0.5"}, {"g.jpg", "1"}, {"h.jpg", "3"}};
    static const char *const untimed[6][2] = {{"a.jpg", NULL}, {"b.jpg", NULL}, {"c.jpg", NULL},
                                              {"d.jpg", NULL}, {"e.jpg", NULL}, {"f.jpg", NULL}};
    const struct {
        const char *const (*shots)[2];
        int count;
    } cases[] = {{few, 4}, {same, 6}, {wild, 8}, {untimed, 6}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct import im;
        fresh(NULL);
        assert_ok(import(&im, cases[i].shots, cases[i].count, "auto", NULL), im.err);
        assert_false(im.views.bracketed);
        import_release(&im);
    }
    struct import im;
    fresh(NULL);
    assert_ok(import(&im, few, 4, "yes", NULL), im.err);
    assert_int_equal(im.views.count, 2);
    import_release(&im);
    fresh(NULL);
    assert_int_equal(import(&im, wild, 3, "yes", NULL), ST_DATA);
    assert_err(im.err, ST_DATA, "form no cycle");
    import_release(&im);
    fresh(NULL);
    assert_ok(import(&im, cycle, 9, "no", NULL), im.err);
    assert_false(im.views.bracketed);
    import_release(&im);
}

static void photos_of_incomplete_cycles_are_named(void **state)
{
    const char *shots[9][2];
    struct import im;
    (void)state;
    memcpy(shots, cycle, sizeof shots);
    shots[8][1] = NULL;
    assert_int_equal(import(&im, (const char *const(*)[2])shots, 9, "yes", NULL), ST_DATA);
    assert_err(im.err, ST_DATA, "brackets of 1/10 s, 0.4 s, 1.6 s in order of file name");
    assert_contains(im.err.text, "v3_e0.jpg (1/10 s), v3_e1.jpg (0.4 s), v3_e2.jpg (no exposure time).");
    assert_contains(im.err.text, "EXCLUDE = v3_e0 v3_e1 v3_e2");
    import_release(&im);
    assert_ok(import(&im, (const char *const(*)[2])shots, 9, "auto", NULL), im.err); /* 6 of 9 may be chance */
    assert_false(im.views.bracketed);
    import_release(&im);

    fresh(NULL);
    assert_int_equal(import(&im, cycle, 7, "auto", NULL), ST_DATA);
    assert_err(im.err, ST_DATA, "belong to no complete one: v3_e0.jpg (1/10 s).");
    import_release(&im);
}

static void exposures_txt_overrides_exif(void **state)
{
    struct import im;
    (void)state;
    put_text(photos, "exposures.txt", "v1_e2.jpg 3.2 0 0 2\nv1_e0.jpg 7\n");
    put_text(scene, "exposures.txt", "v1_e0.jpg 0.1\n");
    assert_ok(import(&im, cycle, 9, "auto", NULL), im.err);
    assert_int_equal(im.views.count, 3); /* 3.2 s through a filter of 2 is 1.6 s; the line of 7 s is overridden */
    import_release(&im);

    /* a line of a photo comes before the line of all, and that only fills what EXIF leaves out */
    put_text(photos, "exposures.txt", "");
    put_text(scene, "exposures.txt", "* 99 8 100\nv1_e0.jpg 0.1 0 200 4\n");
    assert_ok(import(&im, cycle, 9, "no", NULL), im.err);
    assert_ok(bracket_views_take_exposures(&im.scan, scene, &im.err), im.err);
    for (int i = 0; i < 9; i++) {
        const struct photo_info *info = &im.scan.photos[i].record.info;
        const bool first = !strcmp(im.scan.photos[i].file, "v1_e0.jpg");
        assert_true(info->iso == (first ? 50 : 100) && info->f_number == 8 && info->seconds < 99);
    }
    import_release(&im);

    put_text(scene, "exposures.txt", "v9.jpg 0.1\n");
    assert_int_equal(import(&im, cycle, 9, "auto", NULL), ST_DATA);
    assert_err(im.err, ST_DATA, "exposures.txt:1: found v9.jpg, wanted the name of a photo in");
    import_release(&im);

    put_text(scene, "exposures.txt", "v1_e0.jpg 0.1 8 100\n"); /* f-number and ISO of the others are unknown */
    put_text(scene, "brackets.txt",
             "a v1_e0.jpg v1_e1.jpg v1_e2.jpg\nb v2_e0.jpg v2_e1.jpg v2_e2.jpg\n"
             "c v3_e0.jpg v3_e1.jpg v3_e2.jpg\n");
    assert_int_equal(import(&im, cycle, 9, "auto", NULL), ST_DATA);
    assert_err(im.err, ST_DATA, "the f-number of v1_e0.jpg is known, but not that of v1_e1.jpg");
    import_release(&im);
}

static void invalid_lists_are_rejected(void **state)
{
    static const char *const cases[][2] = {
        {"a v1_e0.jpg v1_e1.jpg v1_e2.jpg\nb v2_e0.jpg v2_e1.jpg v2_e2.jpg\nc v3_e0.jpg v3_e1.jpg\n",
         "has no view with v3_e2.jpg (1 of the photos in"},
        {"a v1_e0.jpg v1_e9.jpg\n", "brackets.txt:1: found v1_e9.jpg, wanted the name of a photo in"},
        {"a v1_e0.jpg v2_e0.jpg v1_e1.jpg v1_e2.jpg\nb v2_e1.jpg v2_e2.jpg\nc v3_e0.jpg v3_e1.jpg v3_e2.jpg\n",
         "view a: v1_e0.jpg and v2_e0.jpg have the same exposure (1/10 s)"},
    };
    struct import im;
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        put_text(scene, "brackets.txt", cases[i][0]);
        assert_int_equal(import(&im, cycle, 9, "auto", NULL), ST_DATA);
        assert_err(im.err, ST_DATA, cases[i][1]);
        import_release(&im);
    }
    const char *shots[9][2];
    memcpy(shots, cycle, sizeof shots);
    shots[4][1] = NULL;
    put_text(scene, "brackets.txt",
             "a v1_e0.jpg v1_e1.jpg v1_e2.jpg\nb v2_e0.jpg v2_e1.jpg v2_e2.jpg\n"
             "c v3_e0.jpg v3_e1.jpg v3_e2.jpg\n");
    assert_int_equal(import(&im, (const char *const(*)[2])shots, 9, "auto", NULL), ST_DATA);
    assert_err(im.err, ST_DATA, "view b: the exposure time of v2_e1.jpg is not known");
    assert_contains(im.err.text, "write a line \"v2_e1.jpg SECONDS\" into exposures.txt");
    import_release(&im);
}

static void exposures_of_a_view_must_have_one_size(void **state)
{
    struct import im;
    (void)state;
    put_text(scene, "brackets.txt", "a v1_e0.jpg v1_e1.jpg\n");
    assert_ok(import(&im, cycle, 2, "auto", NULL), im.err);
    im.scan.photos[1].record.info.width++;
    struct photo_params params = PHOTO_PARAMS_DEFAULT;
    struct bracket_views views;
    assert_int_equal(bracket_views_find(&views, &im.scan, scene, &params, NULL, 0, NULL, &im.err), ST_DATA);
    assert_err(im.err, ST_DATA, "view a: v1_e1.jpg has 17 x ");
    import_release(&im);
}

static void views_and_single_exposures_can_be_excluded(void **state)
{
    struct import im;
    (void)state;
    assert_ok(import(&im, cycle, 9, "auto", "v2"), im.err);
    assert_int_equal(im.views.count, 2);
    assert_string_equal(im.views.views[1].id, "v3");
    import_release(&im);

    put_text(scene, "brackets.txt",
             "a v1_e0.jpg v1_e1.jpg v1_e2.jpg\nb v2_e0.jpg v2_e1.jpg v2_e2.jpg\n"
             "c v3_e0.jpg v3_e1.jpg v3_e2.jpg\n");
    assert_ok(import(&im, cycle, 9, "auto", "v2_e2.jpg"), im.err);
    assert_int_equal(im.views.views[1].count, 2);
    assert_int_equal(im.views.views[1].middle, 0);
    import_release(&im);

    fresh(NULL);
    put_text(scene, "brackets.txt", "a v1_e0.jpg v1_e1.jpg v1_e2.jpg\n");
    assert_ok(import(&im, cycle, 3, "auto", NULL), im.err);
    assert_int_equal(bracket_views_write(&im.views, &im.scan, records, &im.err), ST_DATA);
    assert_err(im.err, ST_DATA, "are exposures of one view; a parallax video needs at least 2 views");
    import_release(&im);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_cycle_of_exposures_makes_views, fresh),
        cmocka_unit_test_setup(views_with_equal_stems_are_named_after_their_first_photo, fresh),
        cmocka_unit_test_setup(the_order_in_brackets_txt_does_not_matter, fresh),
        cmocka_unit_test_setup(views_follow_the_clock_not_the_counter, fresh),
        cmocka_unit_test_setup(views_follow_the_names_where_the_clock_does_not_help, fresh),
        cmocka_unit_test_setup(views_may_have_bases_of_their_own, fresh),
        cmocka_unit_test_setup(exposures_of_all_views_may_be_equal, fresh),
        cmocka_unit_test_setup(photos_without_a_cycle_stay_single, fresh),
        cmocka_unit_test_setup(photos_of_incomplete_cycles_are_named, fresh),
        cmocka_unit_test_setup(exposures_txt_overrides_exif, fresh),
        cmocka_unit_test_setup(invalid_lists_are_rejected, fresh),
        cmocka_unit_test_setup(exposures_of_a_view_must_have_one_size, fresh),
        cmocka_unit_test_setup(views_and_single_exposures_can_be_excluded, fresh),
    };
    return cmocka_run_group_tests_name("bracket_views", tests, scratch_make, scratch_remove);
}
