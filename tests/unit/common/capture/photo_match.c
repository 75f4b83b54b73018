/* photo_match.c - matching of images of a model to photographs: by file, by file in a folder, by id. */
#include "tests/unit/scratch.h"

#include "common/capture/photo_match.h"

static char texts[][32] = {"IMG_1",      "IMG_1.JPG", "IMG_10",   "IMG 10.jpg", "b",
                           "left/b.png", "b-2",       "b.tar.gz", "v1",         "v1.0.jpg"};

static struct photo_record records[] = {
    {.id = texts[0], .file = texts[1]}, {.id = texts[2], .file = texts[3]}, {.id = texts[4], .file = texts[5]},
    {.id = texts[6], .file = texts[7]}, {.id = texts[8], .file = texts[9]},
};
static const struct photo_list photos = {records, 5};

static void names_are_matched_to_photos(void **state)
{
    static const struct {
        const char *name;
        int photo;
    } cases[] = {
        {"IMG_1.JPG", 0}, /* the file */
        {"IMG 10.jpg", 1},
        {"left/b.png", 2},
        {"images/IMG_1.JPG", 0}, /* the file in another folder */
        {"/abs/olute/IMG 10.jpg", 1},
        {"C:\\photos\\IMG_1.JPG", 0},
        {"mixed\\and/IMG_1.JPG", 0},
        {"IMG_1", 0}, /* the id, with or without an extension or a folder */
        {"IMG_10.png", 1},
        {"undistorted/b-2.tiff", 3},
        {"b", 2},
        {"v1.png", 4},
        {"b.tar.gz", 3}, /* the file name has priority over the id b */
        {"IMG 10", 1},   /* the file up to extensions, whose id has no blank */
        {"x/IMG 10.png", 1},
        {"IMG_", -1}, /* beginnings and extensions of names do not match */
        {"IMG_100.jpg", -1},
        {"IMG_1.JPG.png", -1},
        {"img_1.jpg", -1},
        {"b.png.png", -1},
        {"IMG_1.JPG/", -1},
        {".jpg", -1},
        {"", -1},
        {"/", -1},
        {".", -1},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if (photo_list_match(&photos, cases[i].name) != cases[i].photo)
            fail_msg("\"%s\" is photo %d", cases[i].name, photo_list_match(&photos, cases[i].name));
}

static void the_whole_name_has_priority_over_its_last_part(void **state)
{
    char names[][16] = {"a", "x/p.jpg", "b", "p.jpg", "p", "q.jpg"};
    struct photo_record both[] = {
        {.id = names[0], .file = names[1]}, {.id = names[2], .file = names[3]}, {.id = names[4], .file = names[5]}};
    const struct photo_list list = {both, 3};
    (void)state;
    assert_int_equal(photo_list_match(&list, "x/p.jpg"), 0);
    assert_int_equal(photo_list_match(&list, "y/p.jpg"), 1);
    assert_int_equal(photo_list_match(&list, "p.jpg"), 1); /* the file p.jpg, not the photo whose id is p */
    assert_int_equal(photo_list_match(&list, "p.png"), 2);
}

static void an_empty_list_matches_nothing(void **state)
{
    const struct photo_list none = {0};
    (void)state;
    assert_int_equal(photo_list_match(&none, "a.jpg"), -1);
    assert_int_equal(photo_list_match(&none, ""), -1);
}

static void a_bracketed_view_matches_its_middle_exposure(void **state)
{
    char files[][16] = {"v_e0.jpg", "v_e1.jpg", "v", "v.jpg"};
    struct bracket brackets[] = {{.file = files[0]}, {.file = files[1]}};
    struct photo_record view = {
        .id = files[2], .file = files[3], .brackets = brackets, .bracket_count = 2, .middle = 1};
    const struct photo_list list = {&view, 1};
    (void)state;
    assert_int_equal(photo_list_match(&list, "v.jpg"), 0);
    assert_int_equal(photo_list_match(&list, "images/v_e1.jpg"), 0);
    assert_int_equal(photo_list_match(&list, "v_e0.jpg"), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bracketed_view_matches_its_middle_exposure),
        cmocka_unit_test(names_are_matched_to_photos),
        cmocka_unit_test(the_whole_name_has_priority_over_its_last_part),
        cmocka_unit_test(an_empty_list_matches_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
