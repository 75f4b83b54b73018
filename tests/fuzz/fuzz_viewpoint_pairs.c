/* fuzz_viewpoint_pairs.c - reader of pairs.txt: any bytes give shares from 0 to 1 of named photos, or an error. What
 * was read is written, and read again as it is. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/texture/viewpoint_pairs.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct viewpoint_pairs pairs, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (viewpoint_pairs_read(&pairs, path, NULL, &err)) {
        if (!strstr(err.text, path) || pairs.list || pairs.count) abort();
        unlink(path);
        return 0;
    }
    for (int i = 0; i < pairs.count; i++) {
        const struct viewpoint_pair *p = &pairs.list[i];
        if (!(p->t >= 0 && p->t <= 1) || viewpoint_pairs_find(&pairs, p->frame) != p) abort();
    }
    if (!viewpoint_pairs_write(&pairs, path, NULL, &err)) { /* refused: names that are too long to quote */
        if (viewpoint_pairs_read(&again, path, NULL, &err) || again.count != pairs.count) abort();
        for (int i = 0; i < again.count; i++) {
            const struct viewpoint_pair *a = &again.list[i], *p = &pairs.list[i];
            if (strcmp(a->frame, p->frame) || strcmp(a->photos[0], p->photos[0]) || strcmp(a->photos[1], p->photos[1]))
                abort();
            if (a->t < p->t || a->t > p->t) abort();
        }
        viewpoint_pairs_release(&again);
    }
    viewpoint_pairs_release(&pairs);
    unlink(path);
    return 0;
}
