/* sample.h - samples the valid viewpoints of each end of a move (thesis 3.4.2, "Valid viewpoint sampling").
 *
 * A grid of places across the views, and at each of them the z at which viewpoints begin and cease to be valid, both
 * ways from z = 0: in steps that double as long as they stay valid and halve where they do not, until a step is no
 * longer than the tolerance. A place that is not valid at z = 0 has no z. Where fewer than a quarter of the places are
 * valid, the grid is drawn together around the origin by halves. Moves on the axis have one place, the origin.
 *
 * f is the views' mean focal length, or longer: photos held by hand do not fill a film's frame from places between
 * them. The zoom is the one with most valid places at z = 0 for what zooming in gives up, at most max_zoom. */
#ifndef REMODEL_SAMPLE_VALIDITY_SAMPLE_H
#define REMODEL_SAMPLE_VALIDITY_SAMPLE_H

#include "common/film/validity.h"
#include "stages/sample_validity/validity_params.h"

/* How far limits found in small pictures are from those found in pictures of the film's size, or of 1200 px if the film
 * is larger. */
struct sampling_error {
    int limits;   /* compared */
    int within;   /* of them no more than a step apart */
    double worst; /* in steps */
};

struct sampling_notes {
    const char *center_view; /* the set's */
    struct sampling_error error;
    long renders;                  /* pictures drawn */
    bool none[2];                  /* an end without any valid place: the camera stands at the origin there */
    double asked_h, asked_outside; /* the limits that were asked for; v->limits are wider where no place kept them */
};

/* v is empty on entry; on failure it is left empty. ST_DATA with a sentence: the scene has no depth; no viewpoint is
 * valid; a subject is not in front. Same bits for any number of threads. */
enum status validity_sample(struct validity *v, struct sampling_notes *notes, const struct layer_scene *scene,
                            const struct vec3 *ups, const struct subject_list *subjects,
                            const struct film_effect *effect, const struct validity_params *params, struct err *err);

#endif
