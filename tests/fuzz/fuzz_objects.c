/* fuzz_objects.c - objects.txt: any bytes give objects that are read back as written, or an error with the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/light/object_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check_object(const struct object *o, const struct object *again)
{
    const struct brdf *b = &o->brdf;
    if (!object_file_is_valid(o->file) || strlen(o->hash) != HASH_TEXT - 1) abort();
    if (!(b->gloss >= 0) || !(rgb_max(b->albedo) + b->gloss <= 1.001) || !(b->albedo.g >= 0)) abort();
    if (strcmp(o->name, again->name) || strcmp(o->file, again->file) || strcmp(o->hash, again->hash)) abort();
    for (int i = 0; i < 12; i++)
        if (!isfinite(o->matrix[i / 4][i % 4]) || o->matrix[i / 4][i % 4] != again->matrix[i / 4][i % 4]) abort();
    if (b->kind != again->brdf.kind || b->ks != again->brdf.ks || b->shape != again->brdf.shape) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct object_list list, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (object_list_read(&list, path, NULL, &err)) {
        if (!strstr(err.text, path) || list.items || list.count) abort();
    } else {
        if (object_list_write(&list, path, NULL, &err) || object_list_read(&again, path, NULL, &err)) abort();
        if (again.count != list.count) abort();
        for (int i = 0; i < list.count; i++) check_object(&list.items[i], &again.items[i]);
        object_list_release(&again);
        object_list_release(&list);
    }
    unlink(path);
    return 0;
}
