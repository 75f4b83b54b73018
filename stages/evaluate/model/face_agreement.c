/* face_agreement.c - faces of a model and of a truth, matched by plane and outline.
 *
 * A table counts, over all pictures, the pixels n(t, m) that show true face t and model face m, and sums the distances
 * d of their true points from the plane of m. The faces match if their normals agree, sum d / n(t, m) is small (the
 * plane), and n(t, m) is a large part of min(sum_m n(t, m), sum_t n(t, m)) (the outline). Then a pixel agrees if its
 * two faces match. Pixels near an edge are left out, by the exact distance transform of [Felzenszwalb 2012], because
 * there the picture of a slightly displaced model differs without being wrong. */
#include "stages/evaluate/model/face_agreement.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/math/distance.h"

#define MIN_COSINE 0.98480775301220802 /* cos 10 degrees */

static size_t pair_index(const struct face_agreement *a, int t, int m)
{
    return (size_t)t * (size_t)a->model_faces + (size_t)m;
}

enum status face_agreement_init(struct face_agreement *a, int true_faces, int model_faces, struct err *err)
{
    *a = (struct face_agreement){.true_faces = true_faces, .model_faces = model_faces};
    const size_t pairs = (size_t)true_faces * (size_t)model_faces;
    a->true_normals = calloc((size_t)true_faces, sizeof *a->true_normals);
    a->model_normals = calloc((size_t)model_faces, sizeof *a->model_normals);
    a->counted = calloc((size_t)true_faces, sizeof *a->counted);
    a->pairs = calloc(pairs, sizeof *a->pairs);
    if (a->true_normals && a->model_normals && a->counted && a->pairs) return ST_OK;
    return err_nomem(err, "pairs of faces", pairs * sizeof *a->pairs);
}

/* Whether the pixel to the right of or below pixel (x, y) shows another face. */
static bool edge_after(const struct face_pixels *p, size_t i, size_t step)
{
    return p->truth[i] != p->truth[i + step] || p->model[i] != p->model[i + step];
}

/* squared[i]: the squared distance of pixel i from the nearest pixel beside an edge. */
static enum status edge_distances(float *squared, const struct face_pixels *p, struct err *err)
{
    const size_t width = (size_t)p->width, pixels = width * (size_t)p->height;
    uint8_t *inside = malloc(pixels);
    if (!inside) return err_nomem(err, "edges", pixels);
    for (size_t i = 0; i < pixels; i++) inside[i] = 1;
    for (size_t i = 0; i < pixels; i++) {
        if ((i + 1) % width && edge_after(p, i, 1)) inside[i] = inside[i + 1] = 0;
        if (i + width < pixels && edge_after(p, i, width)) inside[i] = inside[i + width] = 0;
    }
    distance_squared(squared, inside, p->width, p->height, err);
    free(inside);
    return err->status;
}

enum status face_agreement_add(struct face_agreement *a, const struct face_pixels *p, struct err *err)
{
    const size_t pixels = (size_t)p->width * (size_t)p->height;
    struct face_counts counts = {0};
    float *squared = malloc(pixels * sizeof *squared);
    if (!squared) return err_nomem(err, "distances from edges", pixels * sizeof *squared);
    counts.pixels = calloc((size_t)a->true_faces * (size_t)a->model_faces, sizeof *counts.pixels);
    if (counts.pixels)
        edge_distances(squared, p, err);
    else
        err_nomem(err, "pixels of faces", pixels);
    for (size_t i = 0; !err->status && i < pixels; i++) {
        const uint32_t t = p->truth[i], m = p->model[i];
        if (t >= (uint32_t)a->true_faces || m >= (uint32_t)a->model_faces)
            err_set(err, ST_DATA, "found id %u, wanted one of faces.txt, at most %d.", t, a->true_faces - 1);
        if (err->status || !(squared[i] > EDGE_DISTANCE * EDGE_DISTANCE)) continue;
        const size_t k = pair_index(a, (int)t, (int)m);
        counts.pixels[k]++;
        counts.all++;
        a->pairs[k].pixels++;
        if (t && m) a->pairs[k].distance += p->distance[i];
    }
    if (!err->status) array_append(&a->pictures, (size_t)a->picture_count, sizeof counts, "pictures", err);
    if (err->status)
        free(counts.pixels);
    else
        a->pictures[a->picture_count++] = counts;
    free(squared);
    return err->status;
}

/* Both faces look towards the camera that sees them; the normal of a two-sided one may point the other way. */
static bool parallel(struct vec3 a, struct vec3 b)
{
    const double lengths = vec3_length(a) * vec3_length(b);
    return !(lengths > 0) || fabs(vec3_dot(a, b)) >= MIN_COSINE * lengths;
}

bool faces_match(const struct face_agreement *a, int t, int m)
{
    const struct face_pair *p = &a->pairs[pair_index(a, t, m)];
    uint64_t of_true = 0, of_model = 0;
    if (!t || !m) return t == m;
    if (!p->pixels || !parallel(a->true_normals[t], a->model_normals[m])) return false;
    if (!(p->distance <= MATCH_DISTANCE * (double)p->pixels)) return false;
    for (int k = 0; k < a->model_faces; k++) of_true += a->pairs[pair_index(a, t, k)].pixels;
    for (int k = 0; k < a->true_faces; k++) of_model += a->pairs[pair_index(a, k, m)].pixels;
    const uint64_t smaller = of_true < of_model ? of_true : of_model;
    return (double)p->pixels >= MATCH_SHARE * (double)smaller;
}

struct face_shares face_shares_of(const struct face_agreement *a, int picture)
{
    struct face_shares s = {.worst = -1};
    uint64_t most = 0;
    const int first = picture < 0 ? 0 : picture, last = picture < 0 ? a->picture_count - 1 : picture;
    for (int i = first; i <= last; i++) s.all += a->pictures[i].all;
    for (int t = 0; t < a->true_faces; t++) {
        uint64_t wrong = 0;
        for (int m = 0; a->counted[t] && m < a->model_faces; m++) {
            uint64_t n = 0;
            for (int i = first; i <= last; i++) n += a->pictures[i].pixels[pair_index(a, t, m)];
            if (!n) continue;
            const bool match = faces_match(a, t, m);
            s.counted += n;
            s.agreeing += match ? n : 0;
            wrong += match ? 0 : n;
        }
        if (wrong > most) {
            most = wrong;
            s.worst = t;
        }
    }
    return s;
}

void face_agreement_release(struct face_agreement *a)
{
    for (int i = 0; i < a->picture_count; i++) free(a->pictures[i].pixels);
    free(a->pictures);
    free(a->true_normals);
    free(a->model_normals);
    free(a->counted);
    free(a->pairs);
    *a = (struct face_agreement){0};
}
