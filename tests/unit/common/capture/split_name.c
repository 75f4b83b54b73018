/* split_name.c - names of the pictures of a multi-lens camera. split_photos.c of import_photos tests their number. */
#include "tests/unit/scratch.h"

#include "common/capture/split_name.h"

static const struct split_size size = {12, 2};

static void a_name_that_was_made_is_read(void **state)
{
    (void)state;
    struct split_name name;
    char *text = split_name_make("IMG_1", 12, 2);
    assert_string_equal(text, "IMG_1_c12r2.png");
    assert_true(split_name_read(&name, text, size));
    assert_true(name.column == 12 && name.row == 2 && name.photo_length == strlen("IMG_1"));
    free(text);
}

static void folders_and_extensions_do_not_matter(void **state)
{
    (void)state;
    static const char *const texts[] = {"a_b.c/IMG_c3r1", "a_b.c/IMG_c3r1.jpg", "a_b.c/IMG_c3r1.png"};
    for (int i = 0; i < 3; i++) {
        struct split_name name;
        assert_true(split_name_read(&name, texts[i], size));
        assert_true(name.column == 3 && name.row == 1 && name.photo_length == strlen("a_b.c/IMG"));
    }
}

static void other_names_are_refused(void **state)
{
    (void)state;
    static const char *const bad[] = {
        "",           "IMG.png",      "IMG_c1.png",   "IMG_c1r.png", "IMG_cr1.png", "IMG_c0r1",
        "IMG_c01r1",  "IMG_c1r02",    "IMG_c13r1",    "IMG_c1r3",    "IMG_c123r1",  "IMG_c1r1_",
        "IMG_c1r1a",  "IMG_C1R1.png", "IMG_r1c1.png", "c1r1.png",    "IMG_c1 r1",   "IMG_c-1r1",
        "IMG_c1r1/a", "IMG_c1r1.d/a", "IMG_c1r1 .",   "IMG_c+1r1.p", "IMG_xc1r1.p", "_",
        "IMG_c"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct split_name name;
        assert_false(split_name_read(&name, bad[i], size));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_name_that_was_made_is_read),
        cmocka_unit_test(folders_and_extensions_do_not_matter),
        cmocka_unit_test(other_names_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
