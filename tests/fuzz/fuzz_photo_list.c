/* fuzz_photo_list.c - a photo's record, and the list of photos: any bytes give values that can be written and read
 * back, or an error. Every input is read as the record of photo a, and as the list beside valid records of a and b. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/capture/photo_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *fp = fopen(path, "wb");
    if (!fp || (size && fwrite(bytes, 1, size, fp) != size) || fclose(fp)) abort();
}

static void check_list(const char *folder, const uint8_t *data, size_t size)
{
    static const char *const names[] = {"a.txt", "b.txt", "list.txt", "photos.mk"};
    static const char *const files[] = {"a.jpg", "\"b c.jpg\""};
    char paths[4][FUZZ_PATH + 64], text[300];
    struct photo_list list, again;
    struct err err = ERR_INIT;

    for (int i = 0; i < 4; i++) snprintf(paths[i], sizeof paths[i], "%s/%s", folder, names[i]);
    for (int i = 0; i < 2; i++) {
        snprintf(text, sizeof text,
                 "remodel-photo 2\nfile %s\nhash 0123456789abcdef0123456789abcdef\nsize 640 480\nbits 8\norientation "
                 "1\nexif 0 0 0 0 0\ncamera \"\" \"\"\ntaken 0\n",
                 files[i]);
        write_file(paths[i], text, strlen(text));
    }
    write_file(paths[2], data, size);
    enum status st = photo_list_read(&list, folder, &err);
    if (st && (st != err.status || !strstr(err.text, folder) || list.photos)) abort();
    if (!st) {
        if (list.count < 1 || list.count > 2 || photo_list_find_id(&list, list.photos[0].id) != 0) abort();
        if (photo_list_write(&list, folder, &err) || photo_list_read(&again, folder, &err)) abort();
        if (again.count != list.count || strcmp(again.photos[0].file, list.photos[0].file)) abort();
        photo_list_release(&again);
        photo_list_release(&list);
    }
    for (int i = 0; i < 4; i++) unlink(paths[i]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[FUZZ_PATH], path[FUZZ_PATH + 64];
    struct photo_record record, again;
    struct err err = ERR_INIT;

    fuzz_folder(folder);
    snprintf(path, sizeof path, "%s/a.txt", folder);
    write_file(path, data, size);
    enum status st = photo_record_read(&record, folder, "a", NULL, &err);
    if (st && (st != err.status || record.id || !strstr(err.text, path))) abort();
    if (!st && !photo_record_write(&record, folder, &err)) {
        if (photo_record_read(&again, folder, "a", NULL, &err) || strcmp(record.file, again.file) ||
            strcmp(record.hash, again.hash) || memcmp(&record.info, &again.info, sizeof record.info))
            abort();
        photo_record_release(&again);
    }
    photo_record_release(&record);
    check_list(folder, data, size);
    rmdir(folder);
    return 0;
}
