/* plan_move.h - a camera move of the taxonomy, planned within its regions of valid viewpoints [Colburn 2014, 3.4]. */
#ifndef REMODEL_PLAN_MOVE_H
#define REMODEL_PLAN_MOVE_H

#include "stages/plan_path/ends.h"
#include "stages/plan_path/image_effects.h"

/* Properties of a planned move, for the log; the numbers are also the path's scores. */
struct move_notes {
    struct move_ends ends;
    struct ends_notes chosen;
    double aperture;    /* widest diameter, scene units; 0: no focus effect, or the aperture cannot open */
    double blur;        /* widest circle of confusion of an infinitely far point, px */
    bool is_static;     /* the camera does not move */
    double size_error;  /* relative error of the size that a subject should keep; 0 for other moves */
    double place_error; /* distance of a subject from the frame's centre at the end that points at it, px */
};

/* Fills path with the frames, their aperture and focus, and the scores; fills layers with the effect's layers, of which
 * most effects have none. subjects: those given to sample_validity; empty if the move needs none. path and layers are
 * empty on entry and, on failure, on return. ST_USAGE: the effect does not suit the subjects. ST_DATA: a region has no
 * valid cell; the scene has no depth. Same bits for any number of threads. */
enum status plan_move(struct camera_path *path, struct effects *layers, struct move_notes *notes,
                      const struct layer_scene *scene, const struct validity *v, const struct subject_list *subjects,
                      const struct plan_params *params, struct err *err);

#endif
