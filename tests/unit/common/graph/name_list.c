/* name_list.c - lists of names, and those that products give. */
#include "tests/unit/scratch.h"

#include "common/graph/name_list.h"

static void words_are_added_in_order(void **state)
{
    struct name_list list = {0};
    struct err err = ERR_INIT;

    (void)state;
    assert_ok(name_list_add_words(&list, "  b\ta  b ", &err), err);
    assert_ok(name_list_add_words(&list, NULL, &err), err);
    assert_ok(name_list_add_words(&list, "", &err), err);
    assert_int_equal(list.count, 3);
    assert_string_equal(list.names[0], "b");
    assert_true(name_list_has(&list, "a"));
    assert_false(name_list_has(&list, "c"));
    name_list_sort(&list);
    assert_int_equal(list.count, 2);
    assert_string_equal(list.names[0], "a");
    assert_string_equal(list.names[1], "b");
    name_list_release(&list);
    assert_int_equal(list.count, 0);
}

static void a_list_of_a_product_is_read(void **state)
{
    struct name_list list = {0};
    struct err err = ERR_INIT;
    const char *path = scratch_write("photos.mk", "PHOTO_IDS := IMG_1 IMG-2\nPHOTO_IDS_X := no\nBRACKETED := yes\n");

    (void)state;
    assert_ok(name_list_read(&list, path, "PHOTO_IDS", &err), err);
    assert_int_equal(list.count, 2);
    assert_string_equal(list.names[1], "IMG-2");
    name_list_release(&list);
    assert_ok(name_list_read(&list, path, "VIEWS", &err), err);
    assert_ok(name_list_read(&list, scratch_path("missing.mk"), "VIEWS", &err), err);
    assert_int_equal(list.count, 0);
    name_list_release(&list);
}

static void files_of_a_folder_are_named_in_order(void **state)
{
    struct name_list list = {0};
    struct err err = ERR_INIT;

    (void)state;
    scratch_write("scene-b.txt", "");
    scratch_write("scene-a.txt", "");
    scratch_write("scene-two words.txt", "");
    scratch_write("scene-.txt", "");
    scratch_write("other.txt", "");
    assert_ok(name_list_add_files(&list, scratch, "scene-", ".txt", &err), err);
    assert_int_equal(list.count, 2);
    assert_string_equal(list.names[0], "a");
    assert_string_equal(list.names[1], "b");
    name_list_release(&list);
    assert_ok(name_list_add_files(&list, scratch_path("missing"), "", "", &err), err);
    assert_int_equal(list.count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(words_are_added_in_order),
                                       cmocka_unit_test(a_list_of_a_product_is_read),
                                       cmocka_unit_test(files_of_a_folder_are_named_in_order)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
