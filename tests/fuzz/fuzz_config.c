/* fuzz_config.c - config files: any input gives parameters that print and read back unchanged, or an error. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "common/base/param.h"
#include "tests/fuzz/fuzz.h"

#define TRY_PARAMS(X)                                      \
    X(planes, int, 128, 2, 4096, "", "an integer")         \
    X(gain, double, 1.0, -1e300, 1e300, "x", "a number")   \
    X(metric, choice, "ad", 0, 0, "ad|census", "a choice") \
    X(note, text, "", 0, 0, "", "free text")

struct try_params {
    TRY_PARAMS(PARAM_FIELD)
};
#define PARAM_STRUCT struct try_params
static const struct param try_table[] = {TRY_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static enum status read_bytes(struct try_params *p, const void *bytes, size_t size, struct err *err)
{
    char path[64];
    const int fd = memfd_create("config", 0);

    if (fd < 0 || write(fd, bytes, size) != (ssize_t)size) abort();
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    const enum status st = params_read_file(try_table, p, "try", path, err);
    close(fd);
    return st;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct try_params p = {TRY_PARAMS(PARAM_DEFAULT)}, q = {TRY_PARAMS(PARAM_DEFAULT)};
    struct err err = ERR_INIT;
    char *text = NULL;
    size_t length = 0;

    if (read_bytes(&p, data, size, &err)) {
        if (err.status != ST_USAGE || !err.text[0]) abort();
        return 0;
    }
    FILE *to = open_memstream(&text, &length);
    if (!to) abort();
    params_print(try_table, &p, "try", to);
    fclose(to);
    if (read_bytes(&q, text, length, &err) || memcmp(&p, &q, sizeof p)) abort();
    free(text);
    return 0;
}
