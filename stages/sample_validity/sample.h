/* sample.h - samples the valid viewpoints of each end of a move [Colburn 2014, 3.4.2]. */
#ifndef REMODEL_SAMPLE_VALIDITY_SAMPLE_H
#define REMODEL_SAMPLE_VALIDITY_SAMPLE_H

#include "common/film/validity.h"
#include "stages/sample_validity/validity_params.h"

/* Error of z limits found in small pictures, against those found in pictures of the film's size (at most 1200 px). */
struct sampling_error {
    int limits;   /* number compared */
    int within;   /* number that differ by at most one step */
    double worst; /* largest difference, in steps */
};

struct sampling_notes {
    const char *center_view; /* name; owned by the set */
    struct sampling_error error;
    long renders;     /* number of coverage pictures rendered */
    bool no_valid[2]; /* the end has no valid cell: it is placed at the origin */
    double requested_h,
        requested_outside; /* limits in the parameters; v->limits are wider if even the origin fails them */
};

/* v is empty on entry and, on failure, on return. ups: as in layout_find. ST_DATA: the scene has no depth; the origin
 * shows nothing; a subject is not in front of it. Same bits for any number of threads. */
enum status validity_sample(struct validity *v, struct sampling_notes *notes, const struct layer_scene *scene,
                            const struct vec3 *ups, const struct subject_list *subjects,
                            const struct film_effect *effect, const struct validity_params *params, struct err *err);

#endif
