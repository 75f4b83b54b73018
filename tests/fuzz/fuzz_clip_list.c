/* fuzz_clip_list.c - frames.txt: any bytes give clips with frames, which can be written and read back, or an error. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/import_photos/clip_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check_file(const char *file)
{
    if (!*file || *file == '.' || strchr(file, '/')) abort();
}

static void check_same(const struct clip *p, const struct clip *q)
{
    if (strcmp(p->file, q->file) || strcmp(p->id, q->id) || strcmp(p->hash, q->hash) || p->width != q->width ||
        p->height != q->height || p->count != q->count)
        abort();
    for (int k = 0; k < p->count; k++) {
        const struct clip_picture *c = &p->pictures[k], *d = &q->pictures[k];
        if (strcmp(c->file, d->file) || strcmp(c->hash, d->hash) || c->frame.number != d->frame.number ||
            c->frame.seconds != d->frame.seconds)
            abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct clip_list list, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (clip_list_read(&list, path, &err)) {
        if (!strstr(err.text, path) || list.clips) abort();
    } else {
        for (int i = 0; i < list.count; i++) {
            check_file(list.clips[i].file);
            for (int k = 0; k < list.clips[i].count; k++) check_file(list.clips[i].pictures[k].file);
        }
        if (!clip_list_write(&list, path, &err)) { /* it fails for names with characters that cannot be written */
            if (clip_list_read(&again, path, &err) || again.count != list.count || again.most != list.most) abort();
            for (int i = 0; i < list.count; i++) check_same(&list.clips[i], &again.clips[i]);
            clip_list_release(&again);
        } else if (err.status != ST_DATA) {
            abort();
        }
        clip_list_release(&list);
    }
    unlink(path);
    return 0;
}
