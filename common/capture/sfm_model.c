/* sfm_model.c - structure-from-motion models: what the readers of all formats share. */
#include "common/capture/sfm_model.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/capture/sfm_model_parts.h"

enum status sfm_append(void *array, int count, size_t item_size, const char *what, struct err *err)
{
    if (count == INT_MAX) return err_set(err, ST_DATA, "there are more than %d %s.", count, what);
    return array_append(array, (size_t)count, item_size, what, err);
}

void *sfm_shrink(void *array, int count, size_t item_size)
{
    if (count == 0) {
        free(array);
        return NULL;
    }
    void *p = realloc(array, (size_t)count * item_size);
    return p ? p : array;
}

bool sfm_normalize_rotation(struct quat *q)
{
    double square = q->w * q->w + q->x * q->x + q->y * q->y + q->z * q->z;
    if (!isfinite(square) || !(square > 1e-200)) return false;
    if (fabs(square - 1) > 1e-15) {
        double n = sqrt(square);
        *q = (struct quat){q->w / n, q->x / n, q->y / n, q->z / n};
    }
    return true;
}

struct image_entry {
    struct sfm_image image;
    int idx;
};

static int compare_names(const void *a, const void *b)
{
    const struct image_entry *x = a, *y = b;
    int order = strcmp(x->image.name, y->image.name);
    return order ? order : (x->idx > y->idx) - (x->idx < y->idx);
}

enum status sfm_sort_images(struct sfm_model *m, int **old_idx, struct err *err)
{
    size_t n = (size_t)m->image_count;
    struct image_entry *sorted = calloc(n + 1, sizeof *sorted);
    int *new_idx = calloc(n + 1, sizeof *new_idx);
    *old_idx = calloc(n + 1, sizeof **old_idx);
    if (!sorted || !new_idx || !*old_idx) {
        err_nomem(err, "images", n * sizeof *sorted);
    } else {
        for (size_t i = 0; i < n; i++) sorted[i] = (struct image_entry){m->images[i], (int)i};
        qsort(sorted, n, sizeof *sorted, compare_names);
        for (size_t i = 0; i < n; i++) {
            m->images[i] = sorted[i].image;
            (*old_idx)[i] = sorted[i].idx;
            new_idx[sorted[i].idx] = (int)i;
        }
        for (int i = 0; i < m->point_count; i++)
            for (int k = 0; k < m->points[i].track_count; k++)
                m->points[i].track[k].image_idx = new_idx[m->points[i].track[k].image_idx];
    }
    free(sorted);
    free(new_idx);
    return err->status;
}

enum status sfm_set_track(struct sfm_point *p, const struct sfm_track *track, int count, struct err *err)
{
    if (!count) return ST_OK;
    p->track = malloc((size_t)count * sizeof *p->track);
    if (!p->track) return err_nomem(err, "a track", (size_t)count * sizeof *p->track);
    memcpy(p->track, track, (size_t)count * sizeof *p->track);
    p->track_count = count;
    return ST_OK;
}

void sfm_model_release(struct sfm_model *m)
{
    if (!m) return;
    for (int i = 0; i < m->image_count; i++) {
        free(m->images[i].name);
        free(m->images[i].observations);
    }
    for (int i = 0; i < m->point_count; i++) free(m->points[i].track);
    free(m->cameras);
    free(m->images);
    free(m->points);
    *m = (struct sfm_model){0};
}
