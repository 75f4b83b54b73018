/* What comes from outside reaches the page escaped, whatever its bytes; base64 is RFC 4648's. */
#include "stages/report/html.h"

#include "tests/unit/scratch.h"

static void expect(const char *in, size_t size, const char *wanted)
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

static void escapes(void **state)
{
    (void)state;
    expect("a&b<c>\"d'", 9, "a&amp;b&lt;c&gt;&quot;d&#39;");
    expect("</script><img onerror=x>", 24, "&lt;/script&gt;&lt;img onerror=x&gt;");
    expect("a\tb\nc", 5, "a\tb\nc");
    expect("", 0, "");
}

static void keeps_utf8_and_replaces_the_rest(void **state)
{
    (void)state;
    expect("\xc3\xa9 \xe2\x82\xac \xf0\x9f\x93\xb7", 11, "\xc3\xa9 \xe2\x82\xac \xf0\x9f\x93\xb7");
    expect("\xe9t\xe9", 3, REPLACED "t" REPLACED);         /* Latin-1 */
    expect("\xc0\xbc", 2, REPLACED REPLACED);              /* an overlong < */
    expect("\xed\xa0\x80", 3, REPLACED REPLACED REPLACED); /* a surrogate */
    expect("\xf4\x90\x80\x80", 4, REPLACED REPLACED REPLACED REPLACED);
    expect("a\xe2\x82", 3, "a" REPLACED REPLACED); /* cut off */
    expect("a\0b\x1b[31m\x7f\r", 10, "a" REPLACED "b" REPLACED "[31m" REPLACED REPLACED);
    expect("\xc2\x85\xef\xbf\xbe", 5, REPLACED REPLACED); /* a C1 control, a noncharacter */
}

static void formats_and_escapes(void **state)
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

static void base64(void **state)
{
    static const char *const PAIRS[][2] = {{"", ""},
                                           {"f", "Zg=="},
                                           {"fo", "Zm8="},
                                           {"foo", "Zm9v"},
                                           {"foob", "Zm9vYg=="},
                                           {"fooba", "Zm9vYmE="},
                                           {"foobar", "Zm9vYmFy"},
                                           {"\xff\xfe\xfd", "//79"}};
    (void)state;
    for (size_t i = 0; i < sizeof PAIRS / sizeof *PAIRS; i++) {
        char *text = NULL;
        size_t length;
        FILE *to = open_memstream(&text, &length);
        html_base64(to, PAIRS[i][0], strlen(PAIRS[i][0]));
        fclose(to);
        assert_string_equal(text, PAIRS[i][1]);
        free(text);
    }
}

/* A file longer than the reader's buffer gives the text of its bytes in one piece. */
static void base64_of_a_file(void **state)
{
    enum { SIZE = 100001 };
    unsigned char *bytes = malloc(SIZE);
    char *whole = NULL, *streamed = NULL;
    size_t length;
    struct err err = ERR_INIT;
    (void)state;
    assert_non_null(bytes);
    for (int i = 0; i < SIZE; i++) bytes[i] = (unsigned char)(i * 7 + i / 251);
    const char *path = scratch_write_bytes("bytes", bytes, SIZE);

    FILE *to = open_memstream(&whole, &length);
    html_base64(to, bytes, SIZE);
    fclose(to);
    to = open_memstream(&streamed, &length);
    assert_int_equal(html_base64_file(to, path, &err), ST_OK);
    fclose(to);
    assert_string_equal(streamed, whole);
    remove(path);
    assert_int_equal(html_base64_file(stdout, path, &err), ST_IO);
    free(bytes);
    free(whole);
    free(streamed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(escapes),
        cmocka_unit_test(keeps_utf8_and_replaces_the_rest),
        cmocka_unit_test(formats_and_escapes),
        cmocka_unit_test(base64),
        cmocka_unit_test(base64_of_a_file),
    };
    return cmocka_run_group_tests_name("html", tests, scratch_make, scratch_remove);
}
