/* base64.c - base64 follows RFC 4648. */
#include "common/base/base64.h"

#include "tests/unit/scratch.h"

static void base64_matches_the_rfc(void **state)
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
        base64_write(to, PAIRS[i][0], strlen(PAIRS[i][0]));
        fclose(to);
        assert_string_equal(text, PAIRS[i][1]);
        free(text);
    }
}

/* The file is longer than the reader's buffer. */
static void a_file_is_encoded_like_its_bytes(void **state)
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
    base64_write(to, bytes, SIZE);
    fclose(to);
    to = open_memstream(&streamed, &length);
    assert_int_equal(base64_write_file(to, path, &err), ST_OK);
    fclose(to);
    assert_string_equal(streamed, whole);
    remove(path);
    assert_int_equal(base64_write_file(stdout, path, &err), ST_IO);
    free(bytes);
    free(whole);
    free(streamed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(base64_matches_the_rfc),
        cmocka_unit_test(a_file_is_encoded_like_its_bytes),
    };
    return cmocka_run_group_tests_name("base64", tests, scratch_make, scratch_remove);
}
