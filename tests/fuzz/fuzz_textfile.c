/* fuzz_textfile.c - the text reader: any input gives words that can be quoted and read back, or an error. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "common/base/textfile.h"
#include "tests/fuzz/fuzz.h"

static enum status open_bytes(struct textfile *t, const void *bytes, size_t size, struct err *err)
{
    char path[64];
    const int fd = memfd_create("text", 0);

    if (fd < 0 || write(fd, bytes, size) != (ssize_t)size) abort();
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    textfile_open(t, path, err);
    close(fd);
    return err->status;
}

static void check_quoting(const char *word)
{
    const size_t size = 2 * strlen(word) + 4;
    char *quoted = malloc(size), *again;
    struct textfile t;
    struct err err = ERR_INIT;

    if (!quoted) abort();
    if (textfile_quote(word, quoted, size, &err)) {
        if (!strpbrk(word, "\r\n")) abort();
    } else if (open_bytes(&t, quoted, strlen(quoted), &err) || !textfile_next_raw(&t) ||
               textfile_word(&t, "word", &again, &err) || strcmp(word, again) || textfile_end(&t, &err)) {
        abort();
    } else {
        textfile_release(&t);
    }
    free(quoted);
}

/* The first byte selects how words are read. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct textfile t;
    struct err err = ERR_INIT;
    const int mode = size ? data[0] : 0;
    enum status st;
    int64_t i;
    double x;
    char *word;

    if (open_bytes(&t, data, size, &err)) {
        if (!err.text[0]) abort();
        return 0;
    }
    while (mode & 1 ? textfile_next_raw(&t) : textfile_next(&t)) {
        st = ST_OK;
        err = (struct err)ERR_INIT;
        for (int k = 0; !st && textfile_more(&t); k++) {
            switch ((mode >> 1) * k % 4) {
            case 0:
                if (!(st = textfile_word(&t, "a word", &word, &err))) check_quoting(word);
                break;
            case 1:
                st = textfile_int(&t, "an integer", -100, 100, &i, &err);
                break;
            case 2:
                st = textfile_double(&t, "a number", &x, &err);
                break;
            case 3:
                if (!(st = textfile_rest(&t, "the rest", &word, &err))) check_quoting(word);
                break;
            }
        }
        if (!st) st = textfile_end(&t, &err);
        if (st && !err.text[0]) abort();
    }
    textfile_release(&t);
    return 0;
}
