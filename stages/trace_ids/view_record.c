/* view_record.c - see view_record.h. Pixels are sorted by face id with a counting sort, so that memory and time do not
 * depend on how many faces the model has beyond a count for each. */
#include "stages/trace_ids/view_record.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/sort.h"
#include "common/layers/depth_sigma.h"
#include "common/product/product.h"

#define MAX_OFFSET 0.1 /* of the face's depth */

/* The face that the photo shows at a pixel; 0: none. */
static uint32_t shown(const struct view_ids *v, int pixel) { return v->jump[pixel] > 0 ? v->id[pixel] : 0; }

/* Where the pixels of each id are in a list that is sorted by id: those of k from first[k] to first[k + 1]. */
static void sort_pixels(int *order, int *first, int ids, const struct view_ids *v, int pixels)
{
    for (int i = 0; i < pixels; i++) first[shown(v, i) + 1]++;
    for (int k = 0; k < ids; k++) first[k + 1] += first[k];
    for (int i = 0; i < pixels; i++) order[first[shown(v, i)]++] = i;
    for (int k = ids; k > 0; k--) first[k] = first[k - 1];
    first[0] = 0;
}

/* Distance of the face at a pixel, and the cosine of the angle of its ray. */
static double pixel_distance(const struct view_trace *t, const struct view_ids *ids, int pixel, double *cosine)
{
    const struct view *v = &t->view;
    const double x = (pixel % ids->width + 0.5 - v->cx) / v->fx, y = (pixel / ids->width + 0.5 - v->cy) / v->fy;
    const struct vec3 ray = {x, y, 1};
    const double length = vec3_length(ray);
    const struct vec3 n = mat3_apply(v->cam_from_world, t->model->mesh.faces[t->faces[pixel] - 1].normal);
    *cosine = fmin(1, fabs(vec3_dot(ray, n)) / length);
    return length * (double)ids->z[pixel];
}

static void measure(struct seen_face *f, const int *pixels, int count, const struct view_ids *ids,
                    const struct view_trace *t, float *distances, const struct trace_params *params)
{
    double clean = 0, cosines = 0;
    int used = 0;
    for (int i = 0; i < count; i++)
        if (ids->jump[pixels[i]] > (float)params->clean_margin) clean += 1 - (double)ids->clutter[pixels[i]];
    for (int i = 0; i < count; i++) {
        const int p = pixels[i];
        double cosine;
        if (clean > 0 && !(ids->jump[p] > (float)params->clean_margin && ids->clutter[p] < 1)) continue;
        distances[used++] = (float)pixel_distance(t, ids, p, &cosine);
        cosines += cosine;
    }
    sort_floats(distances, (size_t)used);
    f->pixels = count;
    f->clean = (int)floor(clean + 0.5);
    f->distance = (double)distances[used / 2];
    f->cosine = cosines / used;
}

/* How far the view's sure depth lies from the face. Depth that is far off shows something else. */
static void measure_offset(struct seen_face *f, const int *pixels, int count, const struct view_ids *ids,
                           const struct view_trace *t, const struct layered_depth *depth, float *offsets,
                           const struct trace_params *params)
{
    for (int i = 0; i < count; i++) {
        const int p = pixels[i];
        const uint32_t id = depth->interior.id[p];
        if (solid_face_is_pane(&t->model->mesh, (int)t->faces[p] - 1)) continue; /* shows what is behind it */
        if (!id || depth->segments[id - 1].confidence < DEPTH_SURE || ids->jump[p] <= (float)params->clean_margin)
            continue;
        const double part = (double)depth->interior.z[p] / (double)ids->z[p] - 1;
        double cosine;
        const double distance = pixel_distance(t, ids, p, &cosine);
        if (fabs(part) <= MAX_OFFSET) offsets[f->sure++] = (float)(part * distance * cosine);
    }
    sort_floats(offsets, (size_t)f->sure);
    f->offset = f->sure ? (double)offsets[f->sure / 2] : 0;
}

enum status view_record_make(struct view_record *r, const struct view_ids *ids, const struct view_trace *t,
                             const struct layered_depth *depth, const struct trace_params *params, struct err *err)
{
    const int pixels = ids->width * ids->height, count = t->model->ids;
    int *order = malloc((size_t)pixels * sizeof *order);
    int *first = calloc((size_t)count + 2, sizeof *first);
    float *distances = malloc((size_t)pixels * sizeof *distances);
    *r = (struct view_record){0};
    if (!order || !first || !distances) err_nomem(err, "faces of a view", (size_t)pixels * 8);
    if (!err->status) sort_pixels(order, first, count, ids, pixels);
    for (int id = 1; !err->status && id < count; id++) {
        if (first[id] == first[id + 1]) continue;
        if (array_append(&r->faces, (size_t)r->count, sizeof *r->faces, "faces", err)) break;
        struct seen_face *f = &r->faces[r->count++];
        *f = (struct seen_face){.id = id};
        measure(f, order + first[id], first[id + 1] - first[id], ids, t, distances, params);
        measure_offset(f, order + first[id], first[id + 1] - first[id], ids, t, depth, distances, params);
    }
    free(order);
    free(first);
    free(distances);
    if (err->status) view_record_release(r);
    return err->status;
}

void view_record_release(struct view_record *r)
{
    if (!r) return;
    free(r->faces);
    *r = (struct view_record){0};
}

enum status view_record_write(const struct view_record *r, const char *path, const struct provenance *prov,
                              struct err *err)
{
    struct outfile f = {0};
    product_begin(&f, PRODUCT_VIEW_FACES, path, prov, err);
    if (!err->status) {
        for (int i = 0; i < r->count; i++) {
            const struct seen_face *s = &r->faces[i];
            fprintf(f.fp, "face %d %d %d %.9g %.9g %d %.9g\n", s->id, s->pixels, s->clean, s->distance, s->cosine,
                    s->sure, s->offset);
        }
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

static enum status read_face(struct seen_face *f, struct textfile *t, int last, struct err *err)
{
    int64_t id, pixels, clean, sure;
    if (textfile_expect(t, "face", err) ||
        textfile_int(t, "id of a face, above the last", last + 1, INT_MAX, &id, err) ||
        textfile_int(t, "pixels", 1, INT_MAX, &pixels, err) ||
        textfile_int(t, "clean pixels", 0, pixels, &clean, err) || textfile_double(t, "distance", &f->distance, err) ||
        textfile_number(t, "cosine", 0, 1, &f->cosine, err) ||
        textfile_int(t, "pixels of sure depth", 0, pixels, &sure, err) ||
        textfile_double(t, "offset", &f->offset, err) || textfile_end(t, err))
        return err->status;
    if (!(f->distance > 0)) return textfile_wrong_number(t, f->distance, "a distance above 0", err);
    f->id = (int)id;
    f->pixels = (int)pixels;
    f->clean = (int)clean;
    f->sure = (int)sure;
    return ST_OK;
}

enum status view_record_read(struct view_record *r, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *r = (struct view_record){0};
    product_open(&t, NULL, PRODUCT_VIEW_FACES, path, prov, err);
    while (!err->status && textfile_next(&t)) {
        if (array_append(&r->faces, (size_t)r->count, sizeof *r->faces, "faces", err)) break;
        struct seen_face *f = &r->faces[r->count];
        *f = (struct seen_face){0};
        read_face(f, &t, r->count ? f[-1].id : 0, err);
        r->count++;
    }
    textfile_release(&t);
    if (err->status) view_record_release(r);
    return err->status;
}
