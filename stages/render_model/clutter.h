/* clutter.h - draws what stands in front of the model, furniture, from the views' layers [Colburn 2014, 3.6]: each
 * pixel of a view's layered depth that stands in front of the model by more than its uncertainty, at its own depth. */
#ifndef REMODEL_RENDER_CLUTTER_H
#define REMODEL_RENDER_CLUTTER_H

#include "common/light/model_rays.h"
#include "common/model/model_axes.h"
#include "common/texture/model_picture.h"
#include "stages/render_model/clutter_filter.h"

struct clutter_scene; /* the views of a scene; their layers are read when they are needed */

struct clutter_files {
    const char *views, *depth, *ids;   /* folders of O */
    const char *things;                /* the same; NULL: none are known */
    const struct model_rays *unedited; /* NULL: no walls and panes are known; must outlive the clutter */
    int memory; /* MiB of views that are kept; where they hold fewer than 12 views, pictures are made of fewer */
};

/* set: cameras in the scene's frame, which must outlive the clutter. */
enum status clutter_open(struct clutter_scene **scene, const struct clutter_files *files, const struct camera_set *set,
                         const struct model_axes *axes, struct err *err);
void clutter_close(struct clutter_scene *scene); /* NULL is allowed */

/* Draws clutter over the shell `p`, which was drawn from the same camera (model frame): pixels that it covers get its
 * colour, blended by its coverage, and MADE_CLUTTER where that is at least a half. Clutter behind the shell's z is
 * hidden. Shell pixels where depth is too unsure to tell become MADE_UNSURE. front (may be NULL): gets the depth of
 * what is seen in each pixel, model units, 0: none. views, count: indices into the set that clutter may come from,
 * nearest first; NULL: chosen here. The views that were read are added to prov (may be NULL). Same bits for any number
 * of threads. */
enum status clutter_draw(struct model_picture *p, float *front, struct clutter_scene *scene, const struct view *camera,
                         const struct clutter_filter *filter, const int *views, int count, struct provenance *prov,
                         struct err *err);

/* Flags of each pixel of a picture; may be NULL. */
struct thing_pixels {
    const uint8_t *stays; /* 1: a thing is not drawn there */
    uint8_t *shown;       /* set to 0 where a thing covers something */
};

/* Draws a thing, wherever it is before `front`, of which it becomes a part. camera: the picture's, moved as the thing
 * was, the other way. */
enum status clutter_draw_thing(struct model_picture *p, float *front, const struct thing_pixels *pixels,
                               struct clutter_scene *scene, const struct view *camera, const struct thing_shape *thing,
                               struct provenance *prov, struct err *err);

/* Draws the fused surface of a thing where a picture shows no clutter and nothing nearer. The rest as for
 * clutter_draw_thing(). */
enum status clutter_draw_surface(struct model_picture *p, float *front, struct clutter_scene *scene,
                                 const struct view *camera, const struct thing_shape *thing, struct provenance *prov,
                                 struct err *err);

#endif
