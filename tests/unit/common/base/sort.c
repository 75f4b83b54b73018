/* sort.c - tests of the median of numbers. */
#include "common/base/sort.h"

#include "tests/unit/scratch.h"

static void a_median_of_an_even_number_is_a_mean(void **state)
{
    double odd[] = {5, 1, 3}, even[] = {4, 1, 2, 9};
    (void)state;
    assert_true(sort_median(odd, 3) == 3);
    assert_true(sort_median(even, 4) == 3);
    assert_true(sort_median(even, 1) == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_median_of_an_even_number_is_a_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
