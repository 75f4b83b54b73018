/* fuzz_view_record.c - reader of the faces that a view shows: any bytes give a valid list, or an error that names the
 * file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/trace_ids/view_record.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct view_record r;
    struct err err = ERR_INIT;
    char path[FUZZ_PATH];

    fuzz_file(path, data, size);
    if (view_record_read(&r, path, NULL, &err)) {
        if (r.faces || r.count || !strstr(err.text, path)) abort();
    }
    for (int i = 0; i < r.count; i++) {
        const struct seen_face *f = &r.faces[i];
        if (f->id < 1 || (i && f->id <= f[-1].id) || f->pixels < 1 || f->clean < 0 || f->clean > f->pixels) abort();
        if (!(f->distance > 0 && isfinite(f->distance) && f->cosine >= 0 && f->cosine <= 1)) abort();
    }
    view_record_release(&r);
    unlink(path);
    return 0;
}
