/* face_offsets.c - the median over views of what each says of a face, and how far they differ.
 *
 * Views count alike, because their errors come from their cameras and their matching, not from how many pixels they
 * have. */
#include "stages/trace_ids/face_offsets.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/log.h"
#include "common/base/textfile.h"
#include "common/math/numbers.h"
#include "common/product/product.h"

#define MIN_VIEWS   3
#define MIN_SURE    200   /* pixels of sure depth that a view needs to say something of a face */
#define MIN_SPREADS 2.0   /* and ... */
#define MIN_PART    0.004 /* ... part of the model's height, above which an offset is reported */
#define MAX_REPORTS 8

struct face_offset {
    int id, views;
    double offset, spread; /* model units */
};

enum status face_offsets_add(struct face_offsets *o, const struct view_record *record, struct err *err)
{
    for (int i = 0; i < record->count; i++) {
        const struct seen_face *s = &record->faces[i];
        if (s->sure < MIN_SURE) continue;
        if (array_append(&o->items, (size_t)o->count, sizeof *o->items, "offsets of faces", err)) return err->status;
        o->items[o->count++] = (struct view_offset){s->id, s->offset};
    }
    return ST_OK;
}

static int compare_items(const void *pa, const void *pb)
{
    const struct view_offset *a = pa, *b = pb;
    if (a->id != b->id) return a->id < b->id ? -1 : 1;
    return (a->offset > b->offset) - (a->offset < b->offset);
}

static int compare_offsets(const void *pa, const void *pb)
{
    const struct face_offset *a = pa, *b = pb;
    const double x = fabs(a->offset), y = fabs(b->offset);
    if (x != y) return x > y ? -1 : 1;
    return (a->id > b->id) - (a->id < b->id);
}

static int compare_doubles(const void *pa, const void *pb)
{
    const double a = *(const double *)pa, b = *(const double *)pb;
    return (a > b) - (a < b);
}

/* items: of one face, in order of offset; scratch: room for their number. */
static struct face_offset summarize(const struct view_offset *items, int count, double scale, double *scratch)
{
    const double median = items[count / 2].offset;
    for (int i = 0; i < count; i++) scratch[i] = fabs(items[i].offset - median);
    qsort(scratch, (size_t)count, sizeof *scratch, compare_doubles);
    return (struct face_offset){items[0].id, count, scale * median, scale * scratch[count / 2]};
}

/* The name of the face with an id. */
static const char *name_of(const struct solid_mesh *mesh, int id)
{
    for (int i = 0; i < mesh->name_count; i++)
        if (mesh->names[i].id == id) return mesh->names[i].name;
    return "?";
}

static void report(const struct face_offset *f, int count, const struct model_rays *model,
                   const struct model_axes *axes)
{
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < model->mesh.vertex_count; i++) {
        low = fmin(low, model->mesh.vertices[i].p.z);
        high = fmax(high, model->mesh.vertices[i].p.z);
    }
    int reported = 0;
    for (int i = 0; i < count && reported < MAX_REPORTS; i++) {
        const double size = fabs(f[i].offset);
        if (!(size > MIN_SPREADS * f[i].spread && size > MIN_PART * (high - low))) continue;
        log_warn("%s: the photos say that it is %.3g%s %s than the model (%d views, half within %.2g)",
                 name_of(&model->mesh, f[i].id), axes->metric ? 100 * size : size,
                 axes->metric ? " cm" : " model units", f[i].offset > 0 ? "farther" : "nearer", f[i].views,
                 axes->metric ? 100 * f[i].spread : f[i].spread);
        reported++;
    }
}

enum status face_offsets_write(struct face_offsets *o, const struct model_rays *model, const struct model_axes *axes,
                               const char *path, const struct provenance *prov, struct err *err)
{
    struct face_offset *faces = calloc((size_t)o->count + 1, sizeof *faces);
    double *scratch = malloc(((size_t)o->count + 1) * sizeof *scratch);
    struct outfile f = {0};
    int count = 0;
    if (!faces || !scratch) err_nomem(err, "offsets of faces", (size_t)o->count * sizeof *faces);
    if (!err->status && o->count) qsort(o->items, (size_t)o->count, sizeof *o->items, compare_items);
    for (int i = 0, end; !err->status && i < o->count; i = end) {
        for (end = i; end < o->count && o->items[end].id == o->items[i].id;) end++;
        if (end - i >= MIN_VIEWS) faces[count++] = summarize(&o->items[i], end - i, axes->scale, scratch);
    }
    if (!err->status) qsort(faces, (size_t)count, sizeof *faces, compare_offsets);
    if (!err->status && !product_begin(&f, PRODUCT_FACE_OFFSETS, path, prov, err)) {
        char quoted[FILE_PATH];
        for (int i = 0; i < count; i++)
            if (!textfile_quote(name_of(&model->mesh, faces[i].id), quoted, sizeof quoted, err))
                fprintf(f.fp, "face %s %d %.6g %.6g\n", quoted, faces[i].views, faces[i].offset, faces[i].spread);
        if (!err->status) outfile_commit(&f, err);
    }
    outfile_discard(&f);
    if (!err->status) report(faces, count, model, axes);
    free(faces);
    free(scratch);
    return err->status;
}

void face_offsets_release(struct face_offsets *o)
{
    if (!o) return;
    free(o->items);
    *o = (struct face_offsets){0};
}
