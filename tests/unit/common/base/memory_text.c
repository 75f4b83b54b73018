/* texts that are written to memory */
#include "common/base/memory_text.h"

#include <stdlib.h>
#include <string.h>

#include "tests/unit/scratch.h"

static void a_text_is_complete(void **state)
{
    struct memory_text m = {0};
    struct err err = ERR_INIT;

    (void)state;
    assert_int_equal(memory_text_open(&m, "a text", &err), ST_OK);
    for (int i = 0; i < 100000; i++) fprintf(m.to, "%d\n", i);
    fputc('\0', m.to);
    assert_int_equal(memory_text_close(&m, "a text", &err), ST_OK);
    assert_int_equal(m.size, 588891);
    char *at = m.text;
    for (int i = 0; i < 100000; i++) assert_int_equal(strtol(at, &at, 10), i);
    assert_string_equal(at, "\n");
    memory_text_release(&m);
    memory_text_release(&m);
}

static void nothing_is_an_empty_text(void **state)
{
    struct memory_text m = {0};
    struct err err = ERR_INIT;

    (void)state;
    assert_int_equal(memory_text_open(&m, "a text", &err), ST_OK);
    assert_int_equal(memory_text_close(&m, "a text", &err), ST_OK);
    assert_int_equal(m.size, 0);
    assert_string_equal(m.text, "");
    memory_text_release(&m);
}

static void what_does_not_fit_is_an_error(void **state)
{
    struct memory_text m = {0};
    struct err err = ERR_INIT;

    (void)state;
    assert_int_equal(memory_text_open(&m, "a text", &err), ST_OK);
    fputs("begun", m.to);
    fflush(m.to);
    /* as if its buffer were full and could not grow */
    free(m.text);
    m.text = NULL;
    m.size = m.room = SIZE_MAX - 8;
    fputs("a longer text", m.to);
    assert_int_equal(memory_text_close(&m, "a text", &err), ST_NOMEM);
    assert_null(m.text);
    assert_non_null(strstr(err.text, "not enough memory for a text"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_text_is_complete),
        cmocka_unit_test(nothing_is_an_empty_text),
        cmocka_unit_test(what_does_not_fit_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
