/* lit_scene.h - annotations in photographs as lamps, openings and points of the model.
 *
 * Model frame. A pixel means the first surface of the model, without its panes, on the pixel's ray. */
#ifndef REMODEL_LIT_SCENE_H
#define REMODEL_LIT_SCENE_H

#include "common/gather/light_list.h"
#include "common/light/model_rays.h"
#include "common/model/scene_inputs.h"
#include "stages/fit_lights/annotations.h"

/* {0} is the empty state; everything is owned. */
struct lit_model {
    struct model_rays rays; /* without glass */
    struct scene_inputs in; /* cameras, lenses, axes, plan */
};
void lit_model_release(struct lit_model *m);

enum { LINE_POINTS = 161 }; /* of a line */

/* A point whose radiance the views show. Points of a line are evenly spaced from its first to its second pixel. */
struct lit_point {
    struct vec3 at, normal;
    int lamp;                  /* of the list of lamps */
    int note;                  /* index of its annotation; of a place that nobody marked, that of its lamp */
    int mark;                  /* of the list of marks */
    enum annotation_kind kind; /* NOTE_LIT, NOTE_UNLIT or NOTE_LINE */
    double along;              /* of a line, 0 to 1 */
};

/* Points of one annotation, or of a patch of a face that a lamp lights. */
struct lit_mark {
    int note, face; /* face: of a place that nobody marked; -1: a person marked it */
    int on;         /* the face on which its points lie; -1: none */
    int like;       /* a place on a face that a person marked: the mark whose material it is; otherwise -1 */
};

struct lit_scene {
    struct light_list lights; /* lamps in the order of the annotations; radiance 0 until fitted */
    int *lamp_notes;          /* the annotation of each lamp */
    struct lit_point *points;
    struct lit_mark *marks;
    int point_count, mark_count;
};

/* notes may be NULL: then there are only the plan's windows. grid: points along a side of a rectangle; places: rays of
 * a lamp without radiance, each of which adds the point that it hits: on any face for a lamp without marks, otherwise
 * on faces whose marks are of one material. The caller releases s. A lamp
 * or a mark whose pixels mean nothing is left out with a warning. ST_DATA with file and line: an unknown opening. */
enum status lit_scene_resolve(struct lit_scene *s, const struct annotation_list *notes, const struct lit_model *model,
                              int grid, int places, struct err *err);
void lit_scene_release(struct lit_scene *s);

#endif
