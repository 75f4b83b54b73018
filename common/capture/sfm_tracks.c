/* sfm_tracks.c - marks of the observations that tracks have listed: each belongs to one track. */
#include "common/capture/sfm_tracks.h"

#include <stdlib.h>

enum status track_marks_make(struct track_marks *t, struct sfm_model *m, const struct id_list *images, struct err *err)
{
    const size_t count = (size_t)m->image_count;
    *t = (struct track_marks){m, images, calloc(count + 1, sizeof *t->listed)};
    if (!t->listed) return err_nomem(err, "marks", count * sizeof *t->listed);
    for (int i = 0; i < m->image_count; i++) {
        t->listed[i] = calloc((size_t)m->images[i].observation_count + 1, 1);
        if (!t->listed[i]) return err_nomem(err, "marks", (size_t)m->images[i].observation_count);
    }
    return ST_OK;
}

enum track_fault track_marks_take(struct track_marks *t, int64_t image_id, int64_t observation, int64_t point_id,
                                  struct sfm_track *track)
{
    const int idx = id_list_find(t->images, image_id);
    if (idx < 0) return TRACK_WITHOUT_IMAGE;
    const struct sfm_image *im = &t->m->images[idx];
    const bool exists = observation >= 0 && observation < im->observation_count;
    *track = (struct sfm_track){idx, exists ? (int)observation : -1};
    if (!exists) return TRACK_WITHOUT_OBSERVATION;
    if (im->observations[observation].point_id != point_id) return TRACK_OF_OTHER_POINT;
    if (t->listed[idx][observation]) return TRACK_TWICE;
    t->listed[idx][observation] = 1;
    return TRACK_GOOD;
}

void track_marks_clear_others(const struct track_marks *t)
{
    for (int i = 0; i < t->m->image_count; i++)
        for (int k = 0; k < t->m->images[i].observation_count; k++)
            if (!t->listed[i][k]) t->m->images[i].observations[k].point_id = -1;
}

void track_marks_release(struct track_marks *t)
{
    for (int i = 0; t->listed && i < t->m->image_count; i++) free(t->listed[i]);
    free(t->listed);
    t->listed = NULL;
}
