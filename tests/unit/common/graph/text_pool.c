/* text_pool.c - texts kept once. */
#include "tests/unit/scratch.h"

#include "common/graph/text_pool.h"

static void a_text_is_kept_once(void **state)
{
    struct text_pool pool = {0};
    struct err err = ERR_INIT;
    char text[32] = "out/garden/views/a.exr";

    (void)state;
    const char *first = text_pool_keep(&pool, text, &err);
    assert_string_equal(first, "out/garden/views/a.exr");
    assert_ptr_equal(text_pool_keep(&pool, "out/garden/views/a.exr", &err), first);
    text[0] = 'O';
    assert_ptr_not_equal(text_pool_keep(&pool, text, &err), first);
    assert_string_equal(first, "out/garden/views/a.exr");
    assert_int_equal(pool.count, 2);
    text_pool_release(&pool);
    text_pool_release(&pool);
}

static void many_texts_stay_where_they_are(void **state)
{
    enum { COUNT = 100000 };
    struct text_pool pool = {0};
    struct err err = ERR_INIT;
    static const char *kept[COUNT];
    char text[64];

    (void)state;
    for (int i = 0; i < COUNT; i++) {
        snprintf(text, sizeof text, "out/house/depth/v%06d.exr", i);
        kept[i] = text_pool_keep(&pool, text, &err);
        assert_non_null(kept[i]);
    }
    for (int i = 0; i < COUNT; i++) {
        snprintf(text, sizeof text, "out/house/depth/v%06d.exr", i);
        assert_string_equal(kept[i], text);
        assert_ptr_equal(text_pool_keep(&pool, text, &err), kept[i]);
    }
    assert_int_equal(pool.count, COUNT);
    text_pool_release(&pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_text_is_kept_once),
                                       cmocka_unit_test(many_texts_stay_where_they_are)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
