/* level_views.h - illuminance of the surfaces that photographs show, in false colours with isolines. */
#ifndef REMODEL_LEVEL_VIEWS_H
#define REMODEL_LEVEL_VIEWS_H

#include "common/base/cli.h"
#include "common/capture/photo_camera.h"
#include "stages/light_levels/level_sums.h"

struct level_view_files {
    const char *views;     /* folder of cameras and views; NULL: no pictures */
    const char *pictures;  /* folder of an edit's pictures, which stand for the views where there are any; or NULL */
    const char *relit;     /* folder of an edit's relit pictures, which count before those; or NULL */
    struct cli_list names; /* photos; owned */
};

/* A photograph, upright and smaller, and what its pixels show of the model. */
struct level_view {
    const char *name; /* of the photo */
    int width, height;
    struct vec3 from; /* the camera, in the model's frame */
    struct level_pixel {
        float ray[3];     /* unit direction in the model's frame */
        float away;       /* distance of the surface */
        int surface;      /* the face; below -1: -2 - patch of furniture; -1: nothing; NO_PHOTO: beyond the photo */
    } * pixels;           /* owned */
    unsigned char *photo; /* sRGB, 3 bytes a pixel; owned */
    bool relit;           /* it is in the light that the edit makes */
};
enum { NO_PHOTO = -2147483647 - 1 };

/* {0} is the empty state; everything is owned. */
struct level_views {
    struct scene_cameras {
        struct camera_set set;
        struct lens_list lenses;
    } cameras;
    struct level_view *list;
    int count;
    bool relit; /* all of them, in the light that the edit makes */
};

/* Traces the photos. ST_DATA: an unknown one. The caller releases v in each case. */
enum status level_views_make(struct level_views *v, const struct level_view_files *files, const struct model_axes *axes,
                             const struct level_light *light, struct provenance *prov, struct err *err);
void level_views_release(struct level_views *v);

/* What the pictures of a state show. */
struct level_views_state {
    const char *name, *unit;
    double factors[2]; /* of the sums in the unit of the photographs, and of those in lx */
    const struct state_weights *weights;
};

/* The value at each pixel of a view, NAN where nothing is known; patches: of level_views_patches(). */
void level_views_values(float *values, const struct level_view *v, const struct level_light *light,
                        const double *patches, const struct level_views_state *state);
/* The values of all patches, without the direct light of a sun that has a ray of its own. ST_NOMEM. */
enum status level_views_patches(double *patches, const struct level_light *light, const struct level_views_state *state,
                                struct err *err);
/* A view's values as colours over the darkened photograph, 3 bytes a pixel. */
struct level_scale;
void level_views_paint(unsigned char *rgb, const struct level_view *v, const float *values,
                       const struct level_scale *scale);

/* Writes OUT/STATE.PHOTO.svg for each. */
enum status level_views_draw(const struct level_views *v, const struct level_light *light,
                             const struct level_views_state *state, const char *out, struct err *err);

#endif
