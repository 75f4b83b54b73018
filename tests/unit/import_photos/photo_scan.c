/* photo_scan.c - folders of photos: ids for any names, exclusion, unusable photos, and which records are rewritten. */
#include "tests/unit/scratch.h"

#include "stages/import_photos/photo_scan.h"

#define GOOD  "tests/fuzz/corpus/photo/rgb.jpg"
#define OTHER "tests/fuzz/corpus/photo/rgb8.png"
#define CUT   "tests/fuzz/corpus/photo/cut.jpg"
#define CMYK  "tests/fuzz/corpus/photo/cmyk.jpg"
#define HEIC  "tests/fuzz/corpus/photo/rgb.heic"
#define TEXT  "tests/fuzz/corpus/photo/text.png"

static char photos[300], records[300];

/* Two empty folders. */
static int fresh(void **state)
{
    static int number;
    (void)state;
    snprintf(photos, sizeof photos, "%s/%d-photos", scratch, ++number);
    snprintf(records, sizeof records, "%s/%d-records", scratch, number);
    return mkdir(photos, 0777);
}

static void put(const char *name, const char *from)
{
    char path[1024];
    unsigned char bytes[4096];
    FILE *in = fopen(from, "rb");
    assert_non_null(in);
    size_t size = fread(bytes, 1, sizeof bytes, in);
    fclose(in);
    snprintf(path, sizeof path, "%s/%s", photos, name);
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(bytes, 1, size, out), size);
    assert_int_equal(fclose(out), 0);
}

static void assert_exists(const char *name, bool there)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", records, name);
    if ((access(path, F_OK) == 0) != there) fail_msg("%s is %sthere", path, there ? "not " : "");
}

static const char *id_of(const struct photo_scan *scan, const char *file)
{
    for (int i = 0; i < scan->count; i++)
        if (!strcmp(scan->photos[i].file, file)) return scan->photos[i].id;
    return "(not there)";
}

static enum status import(struct photo_scan *scan, const char *exclude, struct err *err)
{
    photo_scan_folder(scan, photos, err);
    if (!err->status && exclude) assert_true(photo_scan_exclude(scan, exclude) > 0);
    if (!err->status && !photo_scan_check(scan, records, err)) photo_scan_write(scan, records, err);
    return err->status;
}

static void ids_are_safe_and_unique(void **state)
{
    const char *const names[][2] = {
        {"1341847980.722988.jpg", "1341847980_722988"},
        {"IMG 1.jpg", "IMG_1"},
        {"two  blanks & 'quotes' \"too\".jpeg", "two_blanks_quotes_too_"},
        {"#hash$dollar.png", "_hash_dollar"},
        {"--out.jpg", "_out"},
        {"-.jpg", "photo_jpg"}, /* shares "photo" with the next two */
        {"\xe6\xa9\x8b.jpg", "photo_jpg-2"},
        {"photo.png", "photo_png"},
        {"Z\xc3\xbcrich.JPG", "Z_rich"},
        {"list.jpg", "list_jpg"},       /* list.txt is taken */
        {"offsets.jpg", "offsets_jpg"}, /* so is ids/offsets.txt */
        {"same.jpg", "same_jpg"},
        {"same.JPG", "same_JPG"},
        {"same.png", "same_png"},
        {"a b.jpg", "a_b_jpg-2"}, /* "a_b_jpg" is a photo's own name */
        {"a+b.jpg", "a_b_jpg-3"},
        {"a_b_jpg.png", "a_b_jpg"},
        {"x.jpg.jpg", "x_jpg"},
        {"name\nwith line break.jpg", "name_with_line_break"},
    };
    struct photo_scan scan = {0};
    struct err err = ERR_INIT;
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) put(names[i][0], GOOD);
    put(".hidden.jpg", GOOD);
    put(".DS_Store", TEXT);
    put("notes.txt", TEXT);
    put("jpg", TEXT);
    put("clip.jpg.mp4", TEXT);
    char sub[400];
    snprintf(sub, sizeof sub, "%s/sub.jpg", photos);
    assert_int_equal(mkdir(sub, 0777), 0);

    assert_ok(photo_scan_folder(&scan, photos, &err), err);
    assert_int_equal(scan.count, sizeof names / sizeof *names);
    assert_int_equal(scan.left.count, 5);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        assert_string_equal(id_of(&scan, names[i][0]), names[i][1]);
    for (int i = 1; i < scan.count; i++) assert_true(strcmp(scan.photos[i - 1].id, scan.photos[i].id) < 0);
    photo_scan_release(&scan);
    photo_scan_release(&scan);
    photo_scan_release(NULL);
}

static enum left_reason reason_of(const struct photo_scan *scan, const char *file)
{
    for (int i = 0; i < scan->left.count; i++)
        if (!strcmp(scan->left.files[i].file, file)) return scan->left.files[i].reason;
    return LEFT_REASONS;
}

/* What a file holds decides, not its name; what is not used has its reason. */
static void files_are_known_by_their_content(void **state)
{
    static const struct {
        const char *file, *from, *id; /* id NULL: left out */
        enum left_reason reason;
    } cases[] = {
        {"a.jfif", GOOD, "a", 0},
        {"b.jpe", GOOD, "b", 0},
        {"c.HEIC", GOOD, "c", 0},
        {"d.heic", HEIC, "d", 0},
        {"e", GOOD, "e", 0},
        {"f.mpo", GOOD, "f_mpo", 0},
        {"f", OTHER, "f_photo", 0},
        {"1341847980.722988", GOOD, "1341847980_722988", 0},
        {"g.webp", "tests/fuzz/corpus/photo/rgb.webp", "g", 0},
        {"h.jxl", "tests/fuzz/corpus/photo/rgb.jxl", "h", 0},
        {"i.avif", "tests/fuzz/corpus/photo/rgb.avif", "i", 0},
        {"j.png", TEXT, "j", 0}, /* unusable: it has a photo's name */
        {"k.jpg", GOOD, "k", 0},
        {"l.jpg", HEIC, "l", 0}, /* no JPEG, and no twin of its own */
        {"k.heic", HEIC, NULL, LEFT_DOUBLE},
        {"k.CR2", TEXT, NULL, LEFT_DOUBLE},
        {"k.jpg_original", GOOD, NULL, LEFT_BACKUP},
        {"k.THM", GOOD, NULL, LEFT_BACKUP},
        {"._k.jpg", GOOD, NULL, LEFT_HIDDEN},
        {"k.MOV", TEXT, NULL, LEFT_VIDEO},
        {"k.gif", "tests/fuzz/corpus/photo/gif.jpg", NULL, LEFT_PICTURE},
        {"k.xmp", TEXT, NULL, LEFT_OTHER},
    };
    struct photo_scan scan = {0};
    struct err err = ERR_INIT;
    char path[400];
    int used = 0;
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) put(cases[i].file, cases[i].from);
    snprintf(path, sizeof path, "%s/cam1", photos);
    assert_int_equal(mkdir(path, 0777), 0);
    put("cam1/l.jpg", GOOD);
    snprintf(path, sizeof path, "%s/empty", photos);
    assert_int_equal(mkdir(path, 0777), 0);
    assert_ok(photo_scan_folder(&scan, photos, &err), err);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        used += cases[i].id != NULL;
        if (cases[i].id && strcmp(id_of(&scan, cases[i].file), cases[i].id) != 0)
            fail_msg("%s: id %s, wanted %s", cases[i].file, id_of(&scan, cases[i].file), cases[i].id);
        if (!cases[i].id) assert_int_equal(reason_of(&scan, cases[i].file), cases[i].reason);
    }
    assert_int_equal(scan.count, used);
    assert_int_equal(reason_of(&scan, "cam1"), LEFT_FOLDER);
    assert_int_equal(reason_of(&scan, "empty"), LEFT_OTHER);
    photo_scan_release(&scan);
}

static void long_names_give_short_unique_ids(void **state)
{
    char name[256];
    struct photo_scan scan = {0};
    struct err err = ERR_INIT;
    (void)state;
    for (int i = 0; i < 3; i++) {
        memset(name, 'n', sizeof name);
        snprintf(name + 240, 16, "%d.jpg", i);
        put(name, GOOD);
    }
    assert_ok(import(&scan, NULL, &err), err);
    for (int i = 0; i < scan.count; i++) assert_true(strlen(scan.photos[i].id) < 120);
    photo_scan_release(&scan);
}

static void excluded_photos_rename_no_others(void **state)
{
    struct photo_scan scan = {0};
    struct err err = ERR_INIT;
    (void)state;
    put("a b.jpg", GOOD);
    put("c.jpg", GOOD);
    put("c.png", OTHER);
    put("d.jpg", GOOD);
    put("e.jpg", GOOD);
    assert_ok(photo_scan_folder(&scan, photos, &err), err);
    assert_int_equal(photo_scan_exclude(&scan, "a_b"), 1);
    assert_int_equal(photo_scan_exclude(&scan, "a b"), 1);
    assert_int_equal(photo_scan_exclude(&scan, "c"), 2);
    assert_int_equal(photo_scan_exclude(&scan, "c.png"), 1);
    assert_int_equal(photo_scan_exclude(&scan, "d.png"), 0);
    assert_int_equal(photo_scan_exclude(&scan, ""), 0);
    photo_scan_release(&scan);

    /* an excluded photo changes no other id, is not read, and its record is removed */
    put("c.png", CUT);
    assert_ok(import(&scan, "c_png", &err), err);
    photo_scan_release(&scan);
    assert_exists("c_jpg.txt", true);
    assert_exists("c_png.txt", false);
    assert_ok(import(&scan, "c", &err), err);
    photo_scan_release(&scan);
    assert_exists("c_jpg.txt", false);
}

static void only_changed_files_are_rewritten(void **state)
{
    const char *const products[] = {"list.txt", "photos.mk", "a.txt", "b.txt", "c.txt"};
    const struct timespec old[2] = {{1000, 0}, {1000, 0}};
    char paths[5][400];
    struct stat info;
    struct photo_scan scan = {0};
    struct err err = ERR_INIT;
    (void)state;
    put("a.jpg", GOOD);
    put("b.png", OTHER);
    put("c.jpg", GOOD);
    for (int round = 0; round < 4; round++) {
        /* first run, no change, changed content, changed set */
        if (round == 2) put("b.png", "tests/fuzz/corpus/photo/rgba8.png");
        assert_ok(import(&scan, round == 3 ? "c" : NULL, &err), err);
        photo_scan_release(&scan);
        for (int i = 0; i < 5; i++) {
            const bool fresh_list = round == 0 || (round == 3 && i < 2), fresh_record = round == 2 && i == 3;
            snprintf(paths[i], sizeof paths[i], "%s/%s", records, products[i]);
            if (round == 3 && i == 4) {
                assert_int_not_equal(stat(paths[i], &info), 0);
                continue;
            }
            assert_int_equal(stat(paths[i], &info), 0);
            assert_int_equal(info.st_mtime != 1000, fresh_list || fresh_record);
            assert_int_equal(utimensat(AT_FDCWD, paths[i], old, 0), 0);
        }
    }
    assert_int_equal(count_entries(photos), 3);
}

static void all_unusable_photos_are_named(void **state)
{
    struct photo_scan scan = {0};
    struct err err = ERR_INIT;
    char link[400];
    (void)state;
    put("good 1.jpg", GOOD);
    put("good 2.png", OTHER);
    put("bad 1.jpg", GOOD);
    assert_ok(import(&scan, NULL, &err), err);
    photo_scan_release(&scan);
    assert_exists("bad_1.txt", true);

    put("bad 1.jpg", CUT);
    put("bad 2.jpg", CMYK);
    put("bad\n3.jpg", GOOD);
    snprintf(link, sizeof link, "%s/bad 4.jpg", photos);
    assert_int_equal(symlink("nowhere", link), 0);
    assert_int_equal(import(&scan, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "4 of 6 photos in ");
    assert_contains(err.text, "EXCLUDE = bad_1 bad_2 bad_3 bad_4)");
    const char *const messages[] = {"bad 1.jpg", "bad 2.jpg is a CMYK", "line break", "bad 4.jpg"};
    for (int i = 0; i < 4; i++) assert_contains(scan.photos[i].err.text, messages[i]);
    for (int i = 4; i < 6; i++) assert_int_equal(scan.photos[i].err.status, ST_OK);
    photo_scan_release(&scan);
    assert_exists("bad_1.txt", false);
    assert_exists("bad_2.txt", false);
    assert_exists("good_1.txt", true);
    assert_exists("good_2.txt", true);

    put("bad 1.jpg", GOOD); /* replaced */
    err = (struct err)ERR_INIT;
    assert_ok(photo_scan_folder(&scan, photos, &err), err);
    for (const char *name = "234"; *name; name++) {
        const char id[] = {'b', 'a', 'd', '_', *name, 0};
        assert_int_equal(photo_scan_exclude(&scan, id), 1);
    }
    assert_ok(photo_scan_check(&scan, records, &err), err);
    assert_ok(photo_scan_write(&scan, records, &err), err);
    photo_scan_release(&scan);
    assert_exists("bad_1.txt", true);
}

static void damaged_records_are_rewritten(void **state)
{
    struct photo_scan scan = {0};
    struct photo_record in;
    struct err err = ERR_INIT;
    char path[400];
    (void)state;
    put("a.jpg", GOOD);
    put("b.jpg", GOOD);
    assert_ok(import(&scan, NULL, &err), err);
    photo_scan_release(&scan);
    snprintf(path, sizeof path, "%s/a.txt", records);
    assert_int_equal(truncate(path, 20), 0);
    assert_ok(import(&scan, NULL, &err), err);
    photo_scan_release(&scan);
    assert_ok(photo_record_read(&in, records, "a", NULL, &err), err);
    assert_int_equal(in.info.width, 16);
    photo_record_release(&in);
}

static void too_few_photos_and_missing_folders_are_rejected(void **state)
{
    struct photo_scan scan = {0};
    struct err err = ERR_INIT;
    (void)state;
    put("notes.txt", TEXT);
    assert_int_equal(import(&scan, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "contains no photo; a parallax video needs at least 2");
    photo_scan_release(&scan);

    err = (struct err)ERR_INIT;
    put("a.jpg", GOOD);
    assert_int_equal(import(&scan, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "one photo;");
    photo_scan_release(&scan);
    assert_exists("list.txt", false);
    assert_exists("photos.mk", false);

    err = (struct err)ERR_INIT;
    put("b.jpg", GOOD);
    assert_int_equal(import(&scan, "a", &err), ST_DATA);
    assert_err(err, ST_DATA, "one photo besides those left out;");
    photo_scan_release(&scan);

    err = (struct err)ERR_INIT;
    assert_int_equal(photo_scan_folder(&scan, scratch_path("no-such"), &err), ST_IO);
    assert_err(err, ST_IO, "is missing");
    photo_scan_release(&scan);
    err = (struct err)ERR_INIT;
    assert_int_equal(photo_scan_folder(&scan, GOOD, &err), ST_DATA);
    assert_err(err, ST_DATA, "is not a folder");
    photo_scan_release(&scan);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(ids_are_safe_and_unique, fresh),
        cmocka_unit_test_setup(files_are_known_by_their_content, fresh),
        cmocka_unit_test_setup(long_names_give_short_unique_ids, fresh),
        cmocka_unit_test_setup(excluded_photos_rename_no_others, fresh),
        cmocka_unit_test_setup(only_changed_files_are_rewritten, fresh),
        cmocka_unit_test_setup(all_unusable_photos_are_named, fresh),
        cmocka_unit_test_setup(damaged_records_are_rewritten, fresh),
        cmocka_unit_test_setup(too_few_photos_and_missing_folders_are_rejected, fresh),
    };
    return cmocka_run_group_tests_name("photo_scan", tests, scratch_make, scratch_remove);
}
