/* ledger.c - a ledger is read back as it was written, notices a change of its own, and keeps the entry that a file has;
 * inputs of products are found in texts and in pictures. */
#include "stages/verify/ledger_file.h"

#include "tests/unit/scratch.h"

#include "common/base/cli.h"
#include "common/base/ledger.h"
#include "common/image/exr.h"
#include "stages/verify/ledger_gather.h"
#include "stages/verify/product_inputs.h"

#define ONE "11111111111111111111111111111111"
#define TWO "22222222222222222222222222222222"

static void entries_are_read_back_by_path(void **state)
{
    struct ledger l = {0}, again = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(ledger_append(&l, ONE, "rectify", "out/t/b \"c\".exr", &err), err);
    assert_ok(ledger_append(&l, TWO, LEDGER_PHOTO, "a.jpg", &err), err);
    assert_ok(ledger_sort(&l, &err), err);
    assert_string_equal(l.entries[0].path, "a.jpg");
    assert_ok(ledger_write(&l, scratch_path("ledger.txt"), &err), err);
    assert_ok(ledger_read(&again, scratch_path("ledger.txt"), &err), err);
    assert_int_equal(again.count, 2);
    const struct ledger_entry *e = ledger_find(&again, "out/t/b \"c\".exr");
    assert_non_null(e);
    assert_string_equal(e->hash, ONE);
    assert_string_equal(e->maker, "rectify");
    assert_false(ledger_is_given(e));
    assert_true(ledger_is_given(ledger_find(&again, "a.jpg")));
    assert_null(ledger_find(&again, "b"));
    ledger_release(&l);
    ledger_release(&again);
}

static void a_changed_ledger_is_refused(void **state)
{
    struct ledger l = {0};
    struct err err = ERR_INIT;
    (void)state;
    scratch_write("changed.txt", "remodel-ledger 1\n" ONE " rectify a\nend " TWO "\n");
    assert_int_equal(ledger_read(&l, scratch_path("changed.txt"), &err), ST_DATA);
    assert_non_null(strstr(err.text, "changed.txt was changed since a run wrote it"));
    ledger_release(&l);
    err = (struct err)ERR_INIT;
    scratch_write("short.txt", "remodel-ledger 1\n" ONE " rectify a\n");
    assert_int_equal(ledger_read(&l, scratch_path("short.txt"), &err), ST_DATA);
    assert_non_null(strstr(err.text, "short.txt:"));
    ledger_release(&l);
}

static void a_missing_ledger_is_empty(void **state)
{
    struct ledger l = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(ledger_read(&l, scratch_path("none.txt"), &err), err);
    assert_int_equal(l.count, 0);
}

static void a_line_without_its_end_is_left_out(void **state)
{
    struct ledger l = {0};
    struct err err = ERR_INIT;
    (void)state;
    scratch_write("lines.txt", ONE " rectify a\n" TWO " rec");
    assert_ok(ledger_add_lines(&l, scratch_path("lines.txt"), &err), err);
    assert_int_equal(l.count, 1);
    ledger_release(&l);
}

/* Of the entries of one path that which the file has is kept; without a file none is; the newest if all agree. */
static void the_entry_that_the_file_has_is_kept(void **state)
{
    struct cli_list none = {0};
    struct ledger l = {0};
    struct err err = ERR_INIT;
    char hash[HASH_TEXT], text[5 * FILE_PATH], path[FILE_PATH];
    (void)state;
    assert_ok(outfile_make_folders(scratch_path("s/log/ledger"), &err), err);
    scratch_write("s/a.txt", "whole\n");
    scratch_write("s/log/run.txt", "not a product\n");
    hash_bytes(hash, "whole\n", 6);
    snprintf(path, sizeof path, "%s", scratch_path("s"));
    snprintf(text, sizeof text,
             "%s old %s/a.txt\n" ONE " new %s/a.txt\n" ONE " new %s/gone.txt\n" ONE " new %s/log/run.txt\n", hash, path,
             path, path, path);
    scratch_write("s/log/ledger/p.txt", text);
    assert_ok(ledger_gather(&(struct ledger_gather_in){.shared = path, .given = &none, .photos = &none}, &err), err);
    assert_ok(ledger_read(&l, scratch_path("s/log/ledger.txt"), &err), err);
    assert_int_equal(l.count, 1);
    assert_string_equal(l.entries[0].hash, hash);
    assert_string_equal(l.entries[0].maker, "old");
    assert_int_not_equal(access(scratch_path("s/log/ledger/p.txt"), F_OK), 0);
    ledger_release(&l);
}

static void a_process_writes_what_it_commits(void **state)
{
    struct outfile f = {0};
    struct cli_list none = {0};
    struct ledger l = {0};
    struct err err = ERR_INIT;
    char hash[HASH_TEXT], shared[FILE_PATH];
    (void)state;
    assert_ok(outfile_make_folders(scratch_path("w/log/ledger"), &err), err);
    assert_int_equal(setenv("REMODEL_LEDGER", scratch_path("w/log/ledger"), 1), 0);
    assert_ok(outfile_open(&f, scratch_path("w/p.txt"), &err), err);
    fputs("product\n", f.fp);
    assert_ok(outfile_commit(&f, &err), err);
    unsetenv("REMODEL_LEDGER");
    snprintf(shared, sizeof shared, "%s", scratch_path("w"));
    assert_ok(ledger_gather(&(struct ledger_gather_in){.shared = shared, .given = &none, .photos = &none}, &err), err);
    assert_ok(ledger_read(&l, scratch_path("w/log/ledger.txt"), &err), err);
    assert_int_equal(l.count, 1);
    hash_bytes(hash, "product\n", 8);
    assert_string_equal(l.entries[0].hash, hash);
    ledger_release(&l);
}

static void inputs_of_a_text_are_its_first_comments(void **state)
{
    static const char text[] = "# remodel rectify 0.1.0\n# key = 1\n# input views/a.exr " ONE
                               "\n# input \"two words\" " TWO "\n# input short 123\nhead 1\n# input later " ONE "\n";
    struct product_inputs in;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(product_inputs_read(&in, text, sizeof text - 1, &err), err);
    assert_int_equal(in.count, 2);
    assert_string_equal(in.items[0].name, "views/a.exr");
    assert_string_equal(in.items[0].hash, ONE);
    assert_string_equal(in.items[1].name, "two words");
    product_inputs_release(&in);
}

static void inputs_of_a_picture_are_in_its_header(void **state)
{
    struct provenance prov = {.stage = "test", .version = "0"};
    struct exr_image im = {0};
    struct exr_plane *plane;
    struct file_bytes file = {0};
    struct product_inputs in;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(provenance_add_hash(&prov, "views/a.exr", ONE, &err), err);
    assert_ok(provenance_add_hash(&prov, "two words", TWO, &err), err);
    assert_ok(exr_image_init(&im, 2, 2, &err), err);
    assert_ok(exr_add_plane(&im, "Z", EXR_FLOAT, &plane, &err), err);
    assert_ok(exr_write(&im, scratch_path("a.exr"), &prov, &err), err);
    assert_ok(file_bytes_read(&file, scratch_path("a.exr"), &err), err);
    assert_ok(product_inputs_read(&in, file.bytes, file.size, &err), err);
    assert_int_equal(in.count, 2);
    assert_string_equal(in.items[0].name, "views/a.exr");
    assert_string_equal(in.items[1].name, "two words");
    assert_string_equal(in.items[1].hash, TWO);
    product_inputs_release(&in);
    file_bytes_release(&file);
    exr_image_release(&im);
    provenance_release(&prov);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(entries_are_read_back_by_path),
        cmocka_unit_test(a_changed_ledger_is_refused),
        cmocka_unit_test(a_missing_ledger_is_empty),
        cmocka_unit_test(a_line_without_its_end_is_left_out),
        cmocka_unit_test(the_entry_that_the_file_has_is_kept),
        cmocka_unit_test(a_process_writes_what_it_commits),
        cmocka_unit_test(inputs_of_a_text_are_its_first_comments),
        cmocka_unit_test(inputs_of_a_picture_are_in_its_header),
    };
    return cmocka_run_group_tests_name("ledger", tests, scratch_make, scratch_remove);
}
