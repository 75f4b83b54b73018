/* fuzz_picture_record.c - reader of records of pictures: any bytes give shares from 0 to 100 %, or an error with the
 * file. What was read is written, and read again. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/texture/picture_record.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check(const struct picture_record *r)
{
    if (r->width < 1 || r->height < 1 || !(r->exposure > 0) || !(r->changed >= 0 && r->changed <= 100)) abort();
    for (int k = 0; k < MADE_COUNT; k++)
        if (!(r->shares[k] >= 0 && r->shares[k] <= 100)) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct picture_record record;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (picture_record_read(&record, path, NULL, &err)) {
        if (!strstr(err.text, path) || record.width || record.height) abort();
    } else {
        check(&record);
        if (picture_record_write(&record, path, NULL, &err) || picture_record_read(&record, path, NULL, &err)) abort();
        check(&record);
    }
    unlink(path);
    return 0;
}
