/* panorama_name.c - names of the views of panoramas. */
#include "tests/unit/scratch.h"

#include "common/capture/panorama_name.h"

static void a_name_that_was_made_is_read(void **state)
{
    (void)state;
    for (int i = 0; i < PANORAMA_VIEWS; i++) {
        int yaw = -1;
        char *text = panorama_name_make("R0010_1", i);
        assert_int_equal(panorama_name_read(&yaw, text), strlen("R0010_1"));
        assert_int_equal(yaw, 60 * i);
        assert_true(panorama_name_same(text, "R0010_1_yaw180.png"));
        assert_false(panorama_name_same(text, "R0010_2_yaw180.png"));
        free(text);
    }
}

static void other_names_are_none(void **state)
{
    static const char *const others[] = {"",
                                         "a.png",
                                         "a_yaw.png",
                                         "a_yaw00.png",
                                         "a_yaw0600.png",
                                         "_yaw060.png",
                                         "a_yaw061.png",
                                         "a_yaw360.png",
                                         "a_yaw060.jpg",
                                         "a_yaw060.png2",
                                         "a_p060.png"};
    (void)state;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        int yaw;
        if (panorama_name_read(&yaw, others[i])) fail_msg("%s was taken for a view", others[i]);
        assert_false(panorama_name_same(others[i], others[i]));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_name_that_was_made_is_read),
        cmocka_unit_test(other_names_are_none),
    };
    return cmocka_run_group_tests_name("panorama_name", tests, NULL, NULL);
}
