/* taxonomy.h - the 3D pan & scan effects and the number of subjects that each needs [Colburn 2014, 3.3, table 3.1].
 *
 *   subjects  moves                                          image effects
 *   0         establishing_dolly, establishing_dolly_out     none
 *   1         dolly_in, dolly_out, dolly_zoom,               narrow_dof, widen_dof; saturate, desaturate, brighten, dim
 *             dolly_zoom_in
 *   2         dolly                                          pull_focus, narrow_dof, widen_dof, if the subjects'
 *                                                            depths differ by a factor of DOF_DEPTH_RATIO
 * A move for n subjects also suits scenes with more. Effect names are MOVE, MOVE+FOCUS, MOVE+TONE or MOVE+FOCUS+TONE,
 * such as `dolly_in+narrow_dof`. saturate and brighten change the subject, desaturate and dim everything else. */
#ifndef REMODEL_TAXONOMY_H
#define REMODEL_TAXONOMY_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"
#include "common/film/subject_list.h"

enum camera_move {
    MOVE_ESTABLISHING_DOLLY,
    MOVE_ESTABLISHING_DOLLY_OUT,
    MOVE_DOLLY_IN,
    MOVE_DOLLY_OUT,
    MOVE_DOLLY_ZOOM,    /* moves back while the lens zooms in */
    MOVE_DOLLY_ZOOM_IN, /* moves forward while the lens zooms out */
    MOVE_DOLLY,
    MOVE_COUNT
};

enum focus_effect {
    FOCUS_ALL,    /* a pinhole: everything is in focus */
    FOCUS_NARROW, /* the aperture opens: the depth of field narrows to the subject */
    FOCUS_WIDEN,  /* the aperture closes */
    FOCUS_PULL,   /* focus moves from the first subject to the second */
    FOCUS_COUNT
};

enum tone_effect { TONE_NONE, TONE_SATURATE, TONE_DESATURATE, TONE_BRIGHTEN, TONE_DIM, TONE_COUNT };

struct film_effect {
    enum camera_move move;
    enum focus_effect focus;
    enum tone_effect tone;
};

#define EFFECT_NAME_SIZE 64
#define DOF_DEPTH_RATIO  1.25 /* smallest ratio of two subjects' depths for which focus can separate them */

/* The scene properties that decide which effects suit it. */
struct scene_subjects {
    int count;          /* moves use at most two */
    double depth_ratio; /* farther to nearer of the first two; 1 if there are fewer */
};
struct scene_subjects film_scene_subjects(const struct subject_list *list);

int film_move_subjects(enum camera_move move); /* number of subjects that the move needs */
void film_effect_name(const struct film_effect *e, char name[EFFECT_NAME_SIZE]);
/* ST_USAGE with what is wrong in the name and the nearest known name. */
enum status film_effect_parse(struct film_effect *e, const char *name, struct err *err);
/* ST_USAGE with the reason if the effect is not in the table or does not suit the scene. */
enum status film_effect_check(const struct film_effect *e, const struct scene_subjects *scene, struct err *err);

#define MAX_FILM_EFFECTS 64
/* All effects that suit a scene, in table order: each move alone and with each single image effect. Returns their
 * number. */
int film_effects_list(struct film_effect list[MAX_FILM_EFFECTS], const struct scene_subjects *scene);
/* A random effect from the table row for the scene's number of subjects (at most two), never one with a tone. The same
 * seed gives the same effect. */
struct film_effect film_effect_draw(const struct scene_subjects *scene, uint64_t seed);

#endif
