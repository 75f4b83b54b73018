/* plan_move.h - a camera move of the taxonomy, from its regions of valid viewpoints (thesis 3.4). */
#ifndef REMODEL_PLAN_MOVE_H
#define REMODEL_PLAN_MOVE_H

#include "stages/plan_path/ends.h"
#include "stages/plan_path/image_effects.h"

/* What a person should know about the film; the figures are the path's scores, too. */
struct move_notes {
    struct move_ends ends;
    struct ends_notes chosen;
    double aperture; /* the widest; 0: none was asked for, or it cannot open */
    double blur;     /* that it makes of what is infinitely far, px */
    bool stands_still;
    double size_error;  /* of the subject, against what was promised, relative; 0 where nothing is */
    double place_error; /* of the subject that an end points at, px */
};

/* The frames, with aperture and focus, and the scores; layers gets the effect's own layers, none for most. subjects: as
 * they were sampled with; empty if the move needs none. path and layers are empty on entry, and on failure left so.
 * ST_DATA: the regions have no place; the scene has no depth. Same bits for any number of threads. */
enum status plan_move(struct camera_path *path, struct effects *layers, struct move_notes *notes,
                      const struct layer_scene *scene, const struct validity *v, const struct subject_list *subjects,
                      const struct plan_params *params, struct err *err);

#endif
