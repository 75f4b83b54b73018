/* given_points.c - see given_points.h.
 *
 * Points are judged after the images are matched to photos: a model of 400 photos, of which the scene has 11, may have
 * points that these 11 do not share. */
#include "stages/sfm/given_points.h"

#include <stdlib.h>

#include "common/capture/photo_match.h"

/* Adds a point to the counts of the photos that observe it, if these are at least two. last[]: the last point that was
 * counted for each photo, so that a photo counts once. */
static void count_point(struct point_support *s, int *shared, int *last, const struct sfm_point *p, int number,
                        const int *photo_of)
{
    int photos = 0;
    for (int k = 0; k < p->track_count; k++) {
        const int photo = photo_of[p->track[k].image_idx];
        if (photo < 0 || last[photo] == number) continue;
        last[photo] = number;
        photos++;
    }
    if (photos < 2) return;
    s->shared++;
    for (int k = 0; k < p->track_count; k++) {
        const int photo = photo_of[p->track[k].image_idx];
        if (photo < 0 || last[photo] != number) continue;
        last[photo] = -1;
        shared[photo]++;
    }
}

enum status given_points_count(struct point_support *s, const struct sfm_model *m, const struct photo_list *photos,
                               struct err *err)
{
    const size_t count = (size_t)photos->count + 1;
    int *photo_of = calloc((size_t)m->image_count + 1, sizeof *photo_of);
    int *shared = calloc(count, sizeof *shared), *last = calloc(count, sizeof *last);
    bool *placed = calloc(count, sizeof *placed);
    *s = (struct point_support){0};
    if (!photo_of || !shared || !last || !placed) err_nomem(err, "photos", count * sizeof *shared);
    for (int i = 0; !err->status && i < m->image_count; i++) {
        photo_of[i] = photo_list_match(photos, m->images[i].name);
        if (photo_of[i] >= 0) placed[photo_of[i]] = true;
    }
    for (int i = 0; !err->status && i < photos->count; i++) last[i] = -1;
    for (int i = 0; !err->status && i < m->point_count; i++) count_point(s, shared, last, &m->points[i], i, photo_of);
    for (int i = 0; !err->status && i < photos->count; i++) {
        s->placed += placed[i];
        s->supported += placed[i] && shared[i] >= MIN_SHARED_POINTS;
    }
    free(photo_of);
    free(shared);
    free(last);
    free(placed);
    return err->status;
}

bool given_points_suffice(const struct point_support *s) { return s->placed < 2 || 2 * s->supported >= s->placed; }
