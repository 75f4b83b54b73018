/* fuzz_split_list.c - split.txt: any bytes give photos with as many pictures as the grid has, which can be written and
 * read back, or an error. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/import_photos/split_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check_file(const char *file)
{
    if (!*file || *file == '.' || strchr(file, '/')) abort();
}

static void check_same(const struct split_photo *p, const struct split_photo *q)
{
    if (strcmp(p->file, q->file) || strcmp(p->hash, q->hash) || p->width != q->width || p->height != q->height) abort();
    for (int k = 0; k < p->count; k++) {
        const struct split_cut *c = &p->cuts[k], *d = &q->cuts[k];
        if (strcmp(c->file, d->file) || strcmp(c->hash, d->hash) || c->x != d->x || c->y != d->y) abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct split_list list, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (split_list_read(&list, path, &err)) {
        if (!strstr(err.text, path) || list.photos) abort();
    } else {
        for (int i = 0; i < list.count; i++) {
            const struct split_photo *p = &list.photos[i];
            if (p->count != list.grid.columns * list.grid.rows || p->width < 1 || p->height < 1) abort();
            check_file(p->file);
            for (int k = 0; k < p->count; k++) check_file(p->cuts[k].file);
        }
        if (!split_list_write(&list, path, &err)) { /* it fails for names with characters that cannot be written */
            if (split_list_read(&again, path, &err) || again.count != list.count) abort();
            for (int i = 0; i < list.count; i++) check_same(&list.photos[i], &again.photos[i]);
            split_list_release(&again);
        } else if (err.status != ST_DATA) {
            abort();
        }
        split_list_release(&list);
    }
    unlink(path);
    return 0;
}
