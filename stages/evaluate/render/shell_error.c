/* shell_error.c - errors of a room without its furniture.
 *
 * The two parts have sums and histograms of their own. The errors of each face are kept, so that its median is exact
 * however few pixels it has. */
#include "stages/evaluate/render/shell_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/sort.h"
#include "common/image/luminance.h"

enum status shell_error_init(struct shell_error *e, struct err *err)
{
    *e = (struct shell_error){0};
    for (int k = 0; k < SHELL_PARTS; k++)
        if (radiance_error_init(&e->all[k], err)) return err->status;
    return ST_OK;
}

static enum status grow_faces(struct shell_error *e, uint32_t id, struct err *err)
{
    if (id >= 1u << 24) return err_set(err, ST_DATA, "found id %u, wanted less than 2^24.", id);
    const int count = (int)id + 1;
    if (count <= e->face_count) return ST_OK;
    void *faces = realloc(e->faces, (size_t)count * sizeof *e->faces);
    if (!faces) return err_nomem(err, "faces", (size_t)count * sizeof *e->faces);
    e->faces = faces;
    memset(e->faces + e->face_count, 0, (size_t)(count - e->face_count) * sizeof *e->faces);
    e->face_count = count;
    return ST_OK;
}

static enum status add_sample(struct shell_error *e, const struct shell_pixels *p, size_t i, int part, struct err *err)
{
    const struct radiance_pixels *r = &p->radiance;
    double a[3], b[3];
    for (size_t c = 0; c < 3; c++) {
        a[c] = r->scale * r->found[3 * i + c];
        b[c] = r->truth[4 * i + c];
        if (r->clip > 0) a[c] = fmin(a[c], r->clip);
        if (r->clip > 0) b[c] = fmin(b[c], r->clip);
    }
    if (!(luminance_of_doubles(b) > 0)) return ST_OK;
    if (grow_faces(e, p->shell[i], err)) return err->status;
    struct shell_samples *s = &e->faces[p->shell[i]][part];
    if (array_reserve(&s->errors, &s->capacity, s->count + 1, sizeof *s->errors, "errors", err)) return err->status;
    s->errors[s->count++] =
        (float)fmin(fabs(luminance_of_doubles(a) - luminance_of_doubles(b)) / luminance_of_doubles(b), 1e30);
    return ST_OK;
}

enum status shell_error_add(struct shell_error *e, const struct shell_pixels *p, struct err *err)
{
    const size_t count = p->radiance.count;
    uint8_t *mask = malloc(count);
    if (!mask) err_nomem(err, "a mask", count);
    for (int part = 0; !err->status && part < SHELL_PARTS; part++) {
        struct radiance_pixels r = p->radiance;
        for (size_t i = 0; !err->status && i < count; i++) {
            mask[i] = p->shell[i] && (p->shell[i] != p->whole[i]) == (part == SHELL_HIDDEN);
            if (mask[i] && r.truth[4 * i + 3] > 0) add_sample(e, p, i, part, err);
        }
        r.mask = mask;
        if (!err->status) radiance_error_add(&e->all[part], &r);
    }
    free(mask);
    return err->status;
}

bool shell_face_median(struct shell_error *e, int face, int part, double *middle)
{
    struct shell_samples *s = &e->faces[face][part];
    if (s->count < MIN_FACE_PIXELS) return false;
    sort_floats(s->errors, s->count);
    *middle = 0.5 * ((double)s->errors[(s->count - 1) / 2] + s->errors[s->count / 2]);
    return true;
}

void shell_error_release(struct shell_error *e)
{
    for (int i = 0; i < e->face_count; i++)
        for (int k = 0; k < SHELL_PARTS; k++) free(e->faces[i][k].errors);
    free(e->faces);
    for (int k = 0; k < SHELL_PARTS; k++) radiance_error_release(&e->all[k]);
    *e = (struct shell_error){0};
}
