/* frame_name.c - names of the frames of clips. */
#include "tests/unit/scratch.h"

#include "common/capture/frame_name.h"

static void a_name_that_was_made_is_read(void **state)
{
    static const int numbers[] = {0, 7, 123456, 12345678};
    (void)state;
    for (int i = 0; i < 4; i++) {
        char *text = frame_name_make("IMG_1", numbers[i]);
        assert_int_equal(frame_name_clip(text), strlen("IMG_1"));
        *strrchr(text, '.') = 0;
        assert_int_equal(frame_name_clip(text), strlen("IMG_1"));
        if (!i) assert_string_equal(text, "IMG_1_f000000");
        free(text);
    }
}

static void other_names_are_none(void **state)
{
    static const char *const others[] = {"",
                                         "IMG_1.png",
                                         "IMG_f1.png",
                                         "_f000001.png",
                                         "IMG_f000001.jpg",
                                         "IMG_f00000a",
                                         "IMG_f000001.png2",
                                         "IMG_F000001.png",
                                         "f000001.png",
                                         "IMG_f"};
    (void)state;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (frame_name_clip(others[i])) fail_msg("%s was taken for a frame", others[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_name_that_was_made_is_read),
        cmocka_unit_test(other_names_are_none),
    };
    return cmocka_run_group_tests_name("frame_name", tests, NULL, NULL);
}
