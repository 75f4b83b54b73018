/* taxonomy.c - tests of effect names and of the effects that suit a number of subjects. */
#include "common/film/taxonomy.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const struct scene_subjects none = {0, 1}, one = {1, 1}, near_two = {2, 1.1}, two = {2, 2}, five = {5, 2};

static bool listed(const struct scene_subjects *scene, const char *name)
{
    struct film_effect list[MAX_FILM_EFFECTS];
    const int count = film_effects_list(list, scene);
    char found[EFFECT_NAME_SIZE];
    for (int i = 0; i < count; i++) {
        film_effect_name(&list[i], found);
        if (!strcmp(found, name)) return true;
    }
    return false;
}

static void each_number_of_subjects_has_its_effects(void **state)
{
    (void)state;
    struct film_effect list[MAX_FILM_EFFECTS];
    assert_int_equal(film_effects_list(list, &none), 2);
    assert_int_equal(film_effects_list(list, &one), 2 + 4 * 7); /* the move alone, two focus effects, four tones */
    assert_int_equal(film_effects_list(list, &near_two), 2 + 4 * 7 + 1);
    assert_int_equal(film_effects_list(list, &two), 2 + 4 * 7 + 4);
    assert_int_equal(film_effects_list(list, &five), 2 + 4 * 7 + 4);
    assert_true(listed(&none, "establishing_dolly_out") && !listed(&none, "dolly_in"));
    assert_true(listed(&one, "dolly_zoom+dim") && listed(&one, "dolly_out+widen_dof") && !listed(&one, "dolly"));
    assert_true(listed(&two, "dolly+pull_focus") && !listed(&two, "dolly+dim") &&
                !listed(&near_two, "dolly+narrow_dof"));
}

static void names_are_read_back(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    for (int m = 0; m < MOVE_COUNT; m++)
        for (int f = 0; f < FOCUS_COUNT; f++)
            for (int t = 0; t < TONE_COUNT; t++) {
                const struct film_effect e = {(enum camera_move)m, (enum focus_effect)f, (enum tone_effect)t};
                struct film_effect back;
                char name[EFFECT_NAME_SIZE];
                film_effect_name(&e, name);
                assert_true(strlen(name) < EFFECT_NAME_SIZE - 1);
                assert_int_equal(film_effect_parse(&back, name, &err), ST_OK);
                assert_true(back.move == e.move && back.focus == e.focus && back.tone == e.tone);
            }
}

static void unknown_names_are_refused(void **state)
{
    (void)state;
    static const char *const bad[][2] = {
        {"", "not a known move"},
        {"doly_in", "did you mean dolly_in?"},
        {"dolly_in+", "not a known image effect"},
        {"dolly_in+narow_dof", "did you mean narrow_dof?"},
        {"dolly_in+dim+narrow_dof", "in this order"},
        {"dolly_in+dim+dim", "in this order"},
        {"dolly_in+narrow_dof+dim+dim", "in this order"},
        {"+dim", "not a known move"},
        {"dolly_in_and_a_name_that_is_much_longer_than_any_name_of_an_effect_may_be", "not a known move"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct err err = ERR_INIT;
        struct film_effect e;
        assert_int_equal(film_effect_parse(&e, bad[i][0], &err), ST_USAGE);
        if (!strstr(err.text, bad[i][1])) fail_msg("\"%s\": %s", bad[i][0], err.text);
    }
}

static void effects_that_do_not_suit_the_scene_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        const struct scene_subjects *scene;
        const char *words;
    } bad[] = {
        {"dolly_in", &none, "needs 1 subject,"},     {"dolly", &one, "needs 2 subjects"},
        {"establishing_dolly+dim", &two, "without"}, {"dolly_in+pull_focus", &two, "only dolly has two"},
        {"dolly+dim", &two, "not with two"},         {"dolly+pull_focus", &near_two, "a factor of 1.1"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct err err = ERR_INIT;
        struct film_effect e;
        assert_int_equal(film_effect_parse(&e, bad[i].name, &err), ST_OK);
        assert_int_equal(film_effect_check(&e, bad[i].scene, &err), ST_USAGE);
        if (!strstr(err.text, bad[i].words)) fail_msg("\"%s\": %s", bad[i].name, err.text);
    }
}

static void random_choice_covers_the_row_without_tones(void **state)
{
    (void)state;
    static const struct {
        const struct scene_subjects *scene;
        int subjects, kinds;
    } rows[] = {{&none, 0, 2}, {&one, 1, 12}, {&near_two, 2, 1}, {&two, 2, 4}, {&five, 2, 4}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        bool seen[MOVE_COUNT][FOCUS_COUNT] = {{false}};
        int kinds = 0;
        for (uint64_t seed = 0; seed < 400; seed++) {
            const struct film_effect e = film_effect_draw(rows[r].scene, seed),
                                     again = film_effect_draw(rows[r].scene, seed);
            assert_true(e.tone == TONE_NONE && film_move_subjects(e.move) == rows[r].subjects);
            assert_true(again.move == e.move && again.focus == e.focus);
            kinds += !seen[e.move][e.focus];
            seen[e.move][e.focus] = true;
        }
        assert_int_equal(kinds, rows[r].kinds);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_number_of_subjects_has_its_effects),
        cmocka_unit_test(names_are_read_back),
        cmocka_unit_test(unknown_names_are_refused),
        cmocka_unit_test(effects_that_do_not_suit_the_scene_are_refused),
        cmocka_unit_test(random_choice_covers_the_row_without_tones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
