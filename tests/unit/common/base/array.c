/* array.c - growing arrays. */
#include "tests/unit/scratch.h"

#include <stdint.h>

#include "common/base/array.h"

static void appended_items_are_kept(void **state)
{
    int *items = NULL;
    struct err err = ERR_INIT;

    (void)state;
    for (int i = 0; i < 1000; i++) {
        assert_ok(array_append(&items, (size_t)i, sizeof *items, "numbers", &err), err);
        items[i] = i;
    }
    for (int i = 0; i < 1000; i++) assert_int_equal(items[i], i);
    free(items);
}

static void reserving_at_least_doubles(void **state)
{
    double *items = NULL;
    size_t capacity = 0;
    struct err err = ERR_INIT;

    (void)state;
    assert_ok(array_reserve(&items, &capacity, 3, sizeof *items, "numbers", &err), err);
    assert_int_equal(capacity, 3);
    assert_ok(array_reserve(&items, &capacity, 3, sizeof *items, "numbers", &err), err);
    assert_int_equal(capacity, 3);
    items[2] = 2.5;
    assert_ok(array_reserve(&items, &capacity, 4, sizeof *items, "numbers", &err), err);
    assert_int_equal(capacity, 6);
    assert_ok(array_reserve(&items, &capacity, 100, sizeof *items, "numbers", &err), err);
    assert_int_equal(capacity, 100);
    assert_true(items[2] == 2.5);
    free(items);
}

static void a_failed_allocation_keeps_the_items(void **state)
{
    double *items = NULL;
    size_t capacity = 0;
    struct err err = ERR_INIT, none = ERR_INIT;

    (void)state;
    assert_ok(array_reserve(&items, &capacity, 1, sizeof *items, "numbers", &none), none);
    items[0] = 7;
    assert_int_equal(array_reserve(&items, &capacity, SIZE_MAX / 4, sizeof *items, "numbers", &err), ST_NOMEM);
    assert_non_null(strstr(err.text, "numbers"));
    assert_int_equal(capacity, 1);
    assert_true(items[0] == 7);
    free(items);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(appended_items_are_kept),
        cmocka_unit_test(reserving_at_least_doubles),
        cmocka_unit_test(a_failed_allocation_keeps_the_items),
    };
    return cmocka_run_group_tests_name("array", tests, NULL, NULL);
}
