/* fuzz_face_index.c - reader of the index from faces to views: any bytes give lists of valid views, or an error that
 * names the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/texture/face_index.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void load(struct face_index *index, int face)
{
    struct face_views list;
    struct err err = ERR_INIT;
    if (face_index_load(&list, index, face, &err)) {
        if (list.views || list.count || !strstr(err.text, index->path)) abort();
        return;
    }
    for (int i = 0; i < list.count; i++) {
        const struct face_view *v = &list.views[i];
        if (!v->name || v->pixels < 1 || v->clean < 0 || v->clean > v->pixels) abort();
        if (!(v->distance > 0 && isfinite(v->distance) && v->cosine >= 0 && v->cosine <= 1)) abort();
    }
    face_views_release(&list);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct face_index index;
    struct err err = ERR_INIT;
    char path[FUZZ_PATH];

    fuzz_file(path, data, size);
    if (face_index_open(&index, path, NULL, &err)) {
        if (index.path || !strstr(err.text, path)) abort();
    } else {
        for (int face = 0; face < 20; face++) load(&index, face);
        face_index_close(&index);
    }
    unlink(path);
    return 0;
}
