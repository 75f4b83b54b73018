/* clutter_scene.h - the views of a scene as sources of clutter: which are kept in memory, and which a camera needs. */
#ifndef REMODEL_RENDER_CLUTTER_SCENE_H
#define REMODEL_RENDER_CLUTTER_SCENE_H

#include "common/clutter/clutter_view.h"
#include "common/clutter/pane_fronts.h"
#include "common/layers/layer_visibility.h"
#include "stages/render_model/clutter.h"

enum { CLUTTER_VIEWS = 12 }; /* the most that a picture is drawn from */

struct clutter_source { /* a view of the set */
    struct clutter_view view;
    bool loaded;
    uint64_t used;            /* number of the picture that needed it last */
    struct provenance inputs; /* its files, once they were read */
};

struct clutter_scene {
    char *views, *depth, *ids, *things; /* folders; owned. things: NULL: none are known */
    size_t budget, bytes;               /* of memory: allowed, and held by the sources */
    const struct camera_set *set;
    struct model_axes axes;
    const struct model_rays *walls; /* the unedited model; NULL: nothing is hidden */
    struct pane_fronts panes;
    struct clutter_source *sources; /* one per view; owned */
    uint64_t picture;               /* number of the present one */
    struct drawn_view drawn[CLUTTER_VIEWS];
};

/* The views that a picture is drawn from, in the order of the set. */
struct clutter_choice {
    int view[CLUTTER_VIEWS];
    float fade[CLUTTER_VIEWS]; /* in (0, 1]: falls to 0 as the view leaves the choice */
    int count;
};

/* Chooses the views that see these points best, from about where the camera is, with no wall between.
 * All in the scene's frame. most: at most
 * CLUTTER_VIEWS. */
enum status clutter_choose_for(struct clutter_choice *choice, const struct clutter_scene *s, struct vec3 camera,
                               const struct vec3 *points, int count, int most, struct err *err);

/* Chooses the views that see best what the camera may see. camera: scene frame; z: width * height depths of the shell
 * in scene units, scaled by `scale`, 0: none. most: at most CLUTTER_VIEWS. */
enum status clutter_choose(struct clutter_choice *choice, const struct clutter_scene *s, const struct view *camera,
                           const float *z, double scale, int most, struct err *err);

/* Whether the unedited model hides a point from a place; both in the scene's frame. Panes hide nothing. */
bool clutter_is_hidden(const struct clutter_scene *s, struct vec3 from, struct vec3 point);

/* How much worse a view shows the point than the camera's own place would: the angle between the two rays, in radians
 * while it is small (the chord of the unit circle), with a fee for distance. */
double clutter_penalty(struct vec3 point, struct vec3 camera, struct vec3 view);

/* Reads the views of the choice that are not in memory; drops others, those first that were not used longest. */
enum status clutter_load(struct clutter_scene *scene, const struct clutter_choice *choice, struct provenance *prov,
                         struct err *err);

/* What clutter gives each pixel of a picture. {0} is the empty state; everything is owned. */
struct clutter_layer {
    float *rgba;  /* premultiplied; A: how much of the pixel is clutter, up to 1 */
    float *z;     /* its depth, scene units; 0: none */
    float *doubt; /* A if all depths were sure */
};
enum status clutter_layer_init(struct clutter_layer *l, int width, int height, struct err *err);
void clutter_layer_release(struct clutter_layer *l);

/* Draws the clutter of the loaded views of the choice; see clutter_blend.c. camera: in the scene's frame. shell: the
 * depth that hides what is behind it, model units, 0: none. */
enum status clutter_blend(struct clutter_layer *to, const float *shell, struct clutter_scene *scene,
                          const struct clutter_choice *choice, const struct view *camera,
                          const struct clutter_filter *filter, struct err *err);

#endif
