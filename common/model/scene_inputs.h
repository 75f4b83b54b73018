/* scene_inputs.h - what most stages read of a scene: cameras, lenses, the frame of the room's model, the model itself.
 *
 *   const struct scene_files files = {.views = views, .axes = axes};
 *   if (scene_inputs_read(&in, SCENE_CAMERAS | SCENE_LENSES | SCENE_AXES, &files, prov, err)) ... */
#ifndef REMODEL_SCENE_INPUTS_H
#define REMODEL_SCENE_INPUTS_H

#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"
#include "common/model/model_axes.h"
#include "common/model/model_plan.h"
#include "common/model/solid_mesh.h"

enum scene_part {
    SCENE_CAMERAS = 1, /* without sparse points and observations */
    SCENE_POINTS = 2,  /* cameras with them */
    SCENE_LENSES = 4,
    SCENE_AXES = 8,
    SCENE_MODEL_VIEWS = 16, /* with axes: moves the cameras to the frame of the room's model */
    SCENE_MESH = 32,
    SCENE_PLAN = 64
};

struct scene_files {                /* of parts that are not wanted NULL */
    const char *views;              /* folder */
    const char *axes, *mesh, *plan; /* axes.txt, model.txt, plan.txt */
};

/* {0} is the empty state; everything is owned. */
struct scene_inputs {
    struct camera_set set;
    struct lens_list lenses;
    struct model_axes axes;
    struct solid_mesh mesh;
    struct model_plan plan;
};

/* wanted: a sum of enum scene_part. The files are recorded in prov, which may be NULL. The caller releases `in` in each
 * case. */
enum status scene_inputs_read(struct scene_inputs *in, unsigned wanted, const struct scene_files *files,
                              struct provenance *prov, struct err *err);
void scene_inputs_release(struct scene_inputs *in);

#endif
