/* sfm_tracks.h - whether the tracks of a model and its observations refer to each other. Not for other modules. */
#ifndef REMODEL_SFM_TRACKS_H
#define REMODEL_SFM_TRACKS_H

#include "common/capture/sfm_ids.h"
#include "common/capture/sfm_model.h"

/* The observations that tracks have listed. m: with sorted images and without points; images: their ids, sorted. */
struct track_marks {
    struct sfm_model *m;
    const struct id_list *images;
    unsigned char **listed; /* of each observation of each image; owned */
};

enum track_fault { TRACK_GOOD, TRACK_WITHOUT_IMAGE, TRACK_WITHOUT_OBSERVATION, TRACK_OF_OTHER_POINT, TRACK_TWICE };

enum status track_marks_make(struct track_marks *t, struct sfm_model *m, const struct id_list *images, struct err *err);

/* Finds the observation of a track's entry, an observation of this point that no track has listed yet, and marks it.
 * *track: set unless the image is missing. */
enum track_fault track_marks_take(struct track_marks *t, int64_t image_id, int64_t observation, int64_t point_id,
                                  struct sfm_track *track);

/* Observations that no track has listed become those of no point. */
void track_marks_clear_others(const struct track_marks *t);

void track_marks_release(struct track_marks *t);

#endif
