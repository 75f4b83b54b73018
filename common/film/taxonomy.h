/* taxonomy.h - which 3D pan & scan effects there are, and which of them suit a scene (thesis 3.3, table 3.1).
 *
 *   subjects  moves                                          image effects
 *   0         establishing_dolly, establishing_dolly_out     none
 *   1         dolly_in, dolly_out, dolly_zoom,               narrow_dof, widen_dof; saturate, desaturate, brighten, dim
 *             dolly_zoom_in
 *   2         dolly                                          pull_focus, narrow_dof, widen_dof, where the subjects'
 *                                                            depths differ by DOF_DEPTH_RATIO
 * A move for n subjects also serves more of them. An effect is called MOVE, MOVE+FOCUS, MOVE+TONE or MOVE+FOCUS+TONE:
 * `dolly_in+narrow_dof`. saturate and brighten act on the subject, desaturate and dim on all but the subject. */
#ifndef REMODEL_TAXONOMY_H
#define REMODEL_TAXONOMY_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"
#include "common/film/subject_list.h"

enum move {
    MOVE_ESTABLISHING_DOLLY,
    MOVE_ESTABLISHING_DOLLY_OUT,
    MOVE_DOLLY_IN,
    MOVE_DOLLY_OUT,
    MOVE_DOLLY_ZOOM,    /* back, while the lens zooms in */
    MOVE_DOLLY_ZOOM_IN, /* forward, while it zooms out */
    MOVE_DOLLY,
    MOVE_COUNT
};

enum focus_effect {
    FOCUS_ALL,
    FOCUS_NARROW, /* the depth of field narrows to the subject */
    FOCUS_WIDEN,
    FOCUS_PULL, /* from one subject to the other */
    FOCUS_COUNT
};

enum tone_effect { TONE_NONE, TONE_SATURATE, TONE_DESATURATE, TONE_BRIGHTEN, TONE_DIM, TONE_COUNT };

struct film_effect {
    enum move move;
    enum focus_effect focus;
    enum tone_effect tone;
};

#define EFFECT_NAME_SIZE 64
#define DOF_DEPTH_RATIO  1.25 /* of two subjects' depths, from which focus tells them apart */

/* What of a scene decides on its effects. */
struct scene_subjects {
    int count;          /* moves use two at most */
    double depth_ratio; /* of the farther to the nearer of the first two; 1 if there are fewer */
};
struct scene_subjects scene_subjects_of(const struct subject_list *list);

int move_subjects(enum move move); /* how many it needs */
void film_effect_name(const struct film_effect *e, char name[EFFECT_NAME_SIZE]);
/* ST_USAGE: what is wrong with the name, and the nearest one that is known. */
enum status film_effect_parse(struct film_effect *e, const char *name, struct err *err);
/* ST_USAGE with a sentence if the effect is in no row of the table, or needs what the scene does not have. */
enum status film_effect_check(const struct film_effect *e, const struct scene_subjects *scene, struct err *err);

#define FILM_EFFECTS_MOST 64
/* Every legal effect of a scene, in the order of the table: each move alone, and with each image effect by itself.
 * Returns how many. */
int film_effects_list(struct film_effect list[FILM_EFFECTS_MOST], const struct scene_subjects *scene);
/* One from the table's row for as many subjects as the scene has (two at most), by chance; never one with a tone. */
struct film_effect film_effect_draw(const struct scene_subjects *scene, uint64_t seed);

#endif
