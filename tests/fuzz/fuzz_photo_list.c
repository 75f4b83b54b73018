/* fuzz_photo_list.c - a photo's record: what is read is written and read back the same, or a sentence says why not. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/photo_list.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[] = "/tmp/remodel-fuzz-XXXXXX", path[64];
    struct photo_record record, again;
    struct err err = ERR_INIT;

    if (!mkdtemp(folder)) abort();
    snprintf(path, sizeof path, "%s/a.txt", folder);
    FILE *fp = fopen(path, "wb");
    if (!fp || fwrite(data, 1, size, fp) != size || fclose(fp)) abort();
    enum status st = photo_record_read(&record, folder, "a", &err);
    if (st && (st != err.status || record.id || !strstr(err.text, path))) abort();
    if (!st && !photo_record_write(&record, folder, &err)) {
        if (photo_record_read(&again, folder, "a", &err) || strcmp(record.file, again.file) ||
            strcmp(record.hash, again.hash) || memcmp(&record.info, &again.info, sizeof record.info))
            abort();
        photo_record_release(&again);
    }
    photo_record_release(&record);
    unlink(path);
    rmdir(folder);
    return 0;
}
