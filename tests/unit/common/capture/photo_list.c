/* photo_list.c - records of photographs: round trip, files kept if nothing changed, errors with file and line. */
#include "tests/unit/scratch.h"

#include "common/capture/photo_list.h"

#define CORPUS "tests/fuzz/corpus/photo_list"

static struct photo_record sample(char *id, char *file)
{
    struct photo_record r = {.id = id, .file = file, .hash = "0123456789abcdef0123456789abcdef"};
    r.info = (struct photo_info){
        640, 480, 8, 6, 5.85, 35, 1 / 250.0, 2.8, 400, "MAKE", "a \"quoted\" \\ model", 1714564922.35, "", false};
    return r;
}

static void make_old(const char *path)
{
    struct timespec old[2] = {{1000, 0}, {1000, 0}};
    assert_int_equal(utimensat(AT_FDCWD, path, old, 0), 0);
}

static bool is_old(const char *path)
{
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    return info.st_mtime == 1000;
}

static void a_record_round_trips(void **state)
{
    char id[] = "IMG_1", file[] = " a \"b\" \\ #$'c.jpg ";
    struct photo_record r = sample(id, file), in;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(photo_record_write(&r, scratch, &err), err);
    assert_ok(photo_record_read(&in, scratch, "IMG_1", NULL, &err), err);
    assert_string_equal(in.id, id);
    assert_string_equal(in.file, file);
    assert_string_equal(in.hash, r.hash);
    assert_memory_equal(&in.info, &r.info, sizeof r.info);
    photo_record_release(&in);
    photo_record_release(&in);
    photo_record_release(NULL);

    strcpy(r.info.colour, "Display P3 \"x\"");
    assert_ok(photo_record_write(&r, scratch, &err), err);
    assert_ok(photo_record_read(&in, scratch, "IMG_1", NULL, &err), err);
    assert_memory_equal(&in.info, &r.info, sizeof r.info);
    photo_record_release(&in);
    r.info.colour[0] = 0;
    assert_ok(photo_record_write(&r, scratch, &err), err);

    make_old(scratch_path("IMG_1.txt"));
    assert_ok(photo_record_write(&r, scratch, &err), err);
    assert_true(is_old(scratch_path("IMG_1.txt")));
    r.hash[0] = 'f';
    assert_ok(photo_record_write(&r, scratch, &err), err);
    assert_false(is_old(scratch_path("IMG_1.txt")));
    make_old(scratch_path("IMG_1.txt"));
    r.file[strlen(r.file) - 1] = 0; /* the new text is the beginning of the old one, or vice versa */
    assert_ok(photo_record_write(&r, scratch, &err), err);
    assert_false(is_old(scratch_path("IMG_1.txt")));

    file[0] = '\n';
    assert_int_equal(photo_record_write(&r, scratch, &err), ST_DATA);
    assert_err(err, ST_DATA, "line break");
}

static void a_list_round_trips(void **state)
{
    char a[] = "a", b[] = "b-2", c[] = "c_", file_a[] = "z z.jpg", file_b[] = "y.png", file_c[] = "x.JPG";
    struct photo_record records[] = {sample(a, file_a), sample(b, file_b), sample(c, file_c)};
    struct photo_list list = {records, 3}, in;
    struct err err = ERR_INIT;
    (void)state;
    for (int i = 0; i < 3; i++) assert_ok(photo_record_write(&records[i], scratch, &err), err);
    assert_ok(photo_list_write(&list, scratch, &err), err);
    assert_file_text(scratch_path("list.txt"), "a \"z z.jpg\"\nb-2 y.png\nc_ x.JPG\n");
    assert_file_text(scratch_path("photos.mk"), "PHOTO_IDS := a b-2 c_\n");
    assert_ok(photo_list_read(&in, scratch, &err), err);
    assert_int_equal(in.count, 3);
    assert_int_equal(photo_list_find_id(&in, "a"), 0);
    assert_int_equal(photo_list_find_id(&in, "c_"), 2);
    assert_int_equal(photo_list_find_id(&in, "b"), -1);
    assert_int_equal(photo_list_find_file(&in, "y.png"), 1);
    assert_int_equal(photo_list_find_file(&in, "y"), -1);
    photo_list_release(&in);
    photo_list_release(&in);
    photo_list_release(NULL);

    make_old(scratch_path("list.txt"));
    make_old(scratch_path("photos.mk"));
    assert_ok(photo_list_write(&list, scratch, &err), err);
    assert_true(is_old(scratch_path("list.txt")) && is_old(scratch_path("photos.mk")));
    list.count = 2;
    assert_ok(photo_list_write(&list, scratch, &err), err);
    assert_false(is_old(scratch_path("list.txt")) || is_old(scratch_path("photos.mk")));
}

static void records_of_bracketed_views_round_trip(void **state)
{
    char id[] = "hall", file[] = "hall.jpg", dark[] = "a b.jpg", bright[] = "c.jpg";
    struct bracket brackets[] = {{dark, "0123456789abcdef0123456789abcdef", 0.003125},
                                 {bright, "ffff456789abcdef0123456789abcdef", 1.0 / 30}};
    struct photo_record r = sample(id, file);
    struct photo_list list = {&r, 1}, in;
    struct err err = ERR_INIT;
    (void)state;
    r.brackets = brackets;
    strcpy(r.info.colour, "Display P3");
    r.bracket_count = 2;
    r.middle = 1;
    r.white = 1.0 / 30;
    assert_ok(photo_record_write(&r, scratch, &err), err);
    assert_ok(photo_list_write(&list, scratch, &err), err);
    assert_file_text(scratch_path("photos.mk"), "PHOTO_IDS := hall\nBRACKETED := yes\n");
    assert_file_text(scratch_path("brackets.txt"),
                     "# VIEW FILE FILE ... from the shortest exposure on\nhall \"a b.jpg\" c.jpg\n");
    assert_ok(photo_list_read(&in, scratch, &err), err);
    assert_int_equal(in.photos[0].bracket_count, 2);
    assert_int_equal(in.photos[0].middle, 1);
    assert_string_equal(in.photos[0].info.colour, "Display P3");
    assert_true(in.photos[0].white == r.white);
    for (int i = 0; i < 2; i++) {
        assert_string_equal(in.photos[0].brackets[i].file, brackets[i].file);
        assert_string_equal(in.photos[0].brackets[i].hash, brackets[i].hash);
        assert_true(in.photos[0].brackets[i].exposure == brackets[i].exposure);
    }
    photo_list_release(&in);
}

static void invalid_lists_are_rejected(void **state)
{
    const char *const cases[][2] = {
        {"", "contains no photo"},
        {"a \"z z.jpg\"\na \"z z.jpg\"\n", "list.txt:2: found \"a\", wanted ids in order"},
        {"b-2 y.png\na y.png\n", ":2:"},
        {"a\n", "wanted file name"},
        {"a y.png\n", "wanted the file named in the record a.txt"},
        {"../a y.png\n", "letters"},
        {"-a y.png\n", "letters"},
        {"gone y.png\n", "gone.txt"},
        {"a y.png more\n", "wanted the end of the line"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct photo_list in;
        struct err err = ERR_INIT;
        scratch_write("list.txt", cases[i][0]);
        assert_int_not_equal(photo_list_read(&in, scratch, &err), ST_OK);
        assert_err(err, err.status, cases[i][1]);
        assert_true(!in.photos && !in.count);
    }
}

static void invalid_records_are_rejected(void **state)
{
    const char *const cases[][2] = {
        {"version", ":1: found \"3\", wanted the version"},
        {"short-hash", ":3:"},
        {"size-zero", ":4: found \"0\", wanted width"},
        {"bits", ":5: found \"7\", wanted bits"},
        {"missing-line", ":5: found \"orientation\", wanted a line \"bits ...\""},
        {"orientation", ":6:"},
        {"nan", ":7: found \"nan\", wanted f-number"},
        {"negative", ":7:"},
        {"extra-word", ":7:"},
        {"long-make", ":8:"},
        {"open-quote", ":8:"},
        {"negative-time", ":9: found \"a negative number\", wanted time taken"},
        {"extra-line", ":10:"},
        {"colour-cut", ":10:"},
        {"colour-long", ":10:"},
        {"brackets-cut", ": found the end of the file, wanted a line \"bracket ...\""},
        {"brackets-order", ":12: found \"b.jpg\", wanted exposures in ascending order"},
        {"brackets-middle", ":10: found \"1\", wanted index of the middle exposure, an integer from 0 to 0"},
        {"brackets-zero", ":10: found \"0\", wanted exposure of white above 0"},
        {"brackets-many", ":10: found \"1001\", wanted number of exposures"},
        {"brackets-more", ":12:"},
        {"empty", "wanted a line \"remodel-photo ...\""},
        {"cut", "cut.txt"},
        {"nul", "nul.txt"},
        {"binary", "binary.txt"},
        {"no-such", "no-such.txt"},
    };
    const char *const valid[] = {"good", "comments", "crlf", "colour"};
    struct photo_record in;
    struct err err = ERR_INIT;
    (void)state;
    for (int i = 0; i < 4; i++) {
        assert_ok(photo_record_read(&in, CORPUS, valid[i], NULL, &err), err);
        assert_string_equal(in.file, "IMG 1.jpg");
        assert_string_equal(in.info.model, "a \"quoted\" model");
        photo_record_release(&in);
    }
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        err = (struct err)ERR_INIT;
        assert_int_not_equal(photo_record_read(&in, CORPUS, cases[i][0], NULL, &err), ST_OK);
        assert_err(err, err.status, cases[i][1]);
        assert_null(in.id);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_record_round_trips),
        cmocka_unit_test(a_list_round_trips),
        cmocka_unit_test(records_of_bracketed_views_round_trip),
        cmocka_unit_test(invalid_lists_are_rejected),
        cmocka_unit_test(invalid_records_are_rejected),
    };
    return cmocka_run_group_tests_name("photo_list", tests, scratch_make, scratch_remove);
}
