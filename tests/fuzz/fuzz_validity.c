/* fuzz_validity.c - regions of valid viewpoints: any bytes give regions that can be used, written and read back the
 * same, or an error message. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/film/validity.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static bool finite_vector(struct vec3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

static void use(const struct validity *v)
{
    const struct shot_setup *s = &v->shot;
    if (s->lens.width < 2 || s->lens.height < 2 || s->lens.width % 2 || s->lens.height % 2 || !(s->lens.fx > 0))
        abort();
    if (!(s->median_depth > 0) || !(s->low[0] < s->high[0]) || !(s->low[1] < s->high[1]) || !(v->step > 0)) abort();
    if (v->move.move != v->effect.move || v->limits.side < 1 || !finite_vector(s->centroid)) abort();
    for (int k = 0; k < 2; k++) {
        const struct shot_end *e = &v->move.end[k];
        const struct validity_region *r = &v->region[k];
        if ((e->focal > 0) == (e->size > 0) || r->columns < 1 || r->rows < 1 || !r->cells) abort();
        for (int i = 0; i < r->columns * r->rows; i++) {
            const struct validity_cell *c = &r->cells[i];
            if (!isfinite(c->x) || !isfinite(c->y) || !isfinite(c->low) || !(c->low <= c->high)) abort();
        }
        if (shot_end_camera(s, e, s->origin).fx < 0) abort();
    }
}

/* Numbers are written exactly, so a file reads back to the same bits. */
static bool same(const struct validity *a, const struct validity *b)
{
    if (memcmp(&a->shot.up, &b->shot.up, sizeof a->shot - offsetof(struct shot_setup, up)) || a->zoom != b->zoom ||
        a->step != b->step || memcmp(a->move.end, b->move.end, sizeof a->move.end))
        return false;
    for (int k = 0; k < 2; k++) {
        if (a->region[k].columns != b->region[k].columns || a->region[k].rows != b->region[k].rows) return false;
        for (int i = 0; i < a->region[k].columns * a->region[k].rows; i++) {
            const struct validity_cell *c = &a->region[k].cells[i], *d = &b->region[k].cells[i];
            if (c->valid != d->valid || c->low != d->low || c->high != d->high) return false;
        }
    }
    return true;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct validity v, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (validity_read(&v, path, NULL, &err)) {
        if (!strstr(err.text, path) || v.region[0].cells || v.region[1].cells) abort();
    } else {
        use(&v);
        if (validity_write(&v, path, NULL, &err) || validity_read(&again, path, NULL, &err) || !same(&v, &again))
            abort();
        validity_release(&again);
        validity_release(&v);
    }
    unlink(path);
    return 0;
}
