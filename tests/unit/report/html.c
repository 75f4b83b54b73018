/* html.c - text of any bytes is escaped. */
#include "stages/report/html.h"

#include "tests/unit/scratch.h"

static void expect_escaped(const char *in, size_t size, const char *wanted)
{
    char *text = NULL;
    size_t length;
    FILE *to = open_memstream(&text, &length);
    html_bytes(to, in, size);
    fclose(to);
    assert_string_equal(text, wanted);
    free(text);
}

#define REPLACED "\xef\xbf\xbd"

static void markup_is_escaped(void **state)
{
    (void)state;
    expect_escaped("a&b<c>\"d'", 9, "a&amp;b&lt;c&gt;&quot;d&#39;");
    expect_escaped("</script><img onerror=x>", 24, "&lt;/script&gt;&lt;img onerror=x&gt;");
    expect_escaped("a\tb\nc", 5, "a\tb\nc");
    expect_escaped("", 0, "");
}

static void utf8_is_kept_and_other_bytes_are_replaced(void **state)
{
    (void)state;
    expect_escaped("\xc3\xa9 \xe2\x82\xac \xf0\x9f\x93\xb7", 11, "\xc3\xa9 \xe2\x82\xac \xf0\x9f\x93\xb7");
    expect_escaped("\xe9t\xe9", 3, REPLACED "t" REPLACED);         /* Latin-1 */
    expect_escaped("\xc0\xbc", 2, REPLACED REPLACED);              /* an overlong < */
    expect_escaped("\xed\xa0\x80", 3, REPLACED REPLACED REPLACED); /* a surrogate */
    expect_escaped("\xf4\x90\x80\x80", 4, REPLACED REPLACED REPLACED REPLACED);
    expect_escaped("a\xe2\x82", 3, "a" REPLACED REPLACED); /* cut off */
    expect_escaped("a\0b\x1b[31m\x7f\r", 10, "a" REPLACED "b" REPLACED "[31m" REPLACED REPLACED);
    expect_escaped("\xc2\x85\xef\xbf\xbe", 5, REPLACED REPLACED); /* a C1 control, a noncharacter */
}

static void formatted_text_is_escaped(void **state)
{
    char *text = NULL;
    size_t length;
    FILE *to = open_memstream(&text, &length);
    (void)state;
    html_printf(to, "%s = %d", "<x>", 3);
    fclose(to);
    assert_string_equal(text, "&lt;x&gt; = 3");
    free(text);
}

static void bytes_of_an_address_are_encoded(void **state)
{
    char *text = NULL;
    size_t length;
    FILE *to = open_memstream(&text, &length);
    (void)state;
    html_address(to, "../a-b_c.~@1/50% \"<\xc3\xa9>?#&'");
    fclose(to);
    assert_string_equal(text, "../a-b_c.~@1/50%25%20%22%3C%C3%A9%3E%3F%23%26%27");
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(markup_is_escaped),
        cmocka_unit_test(utf8_is_kept_and_other_bytes_are_replaced),
        cmocka_unit_test(formatted_text_is_escaped),
        cmocka_unit_test(bytes_of_an_address_are_encoded),
    };
    return cmocka_run_group_tests_name("html", tests, scratch_make, scratch_remove);
}
