/* outdoors_picture.h - a picture that may show the outdoors: a view or a lighting reference image, and where it
 * does. */
#ifndef REMODEL_OUTDOORS_PICTURE_H
#define REMODEL_OUTDOORS_PICTURE_H

#include "common/capture/lens_list.h"
#include "common/light/model_rays.h"
#include "common/model/model_axes.h"

/* What a sample is good for, best last. */
enum outdoors_state { SHOWS_NOTHING, SHOWS_CLIPPED, SHOWS_OUTDOORS };

/* Which pixels are left out. */
struct outdoors_limits {
    double edge;        /* px: those within this distance of what is not outdoors */
    double max_clutter; /* those of a view with this clutter or more; 1: none */
};

/* {0} is the empty state. */
struct outdoors_picture {
    char *name; /* owned */
    int photo;  /* pictures of the same photo have the same gain */
    bool reference;
    int order;  /* of pictures that measure a direction, those of the highest order show it */
    char *path; /* owned; of the picture */
    char *ids;  /* owned; of the view's ids, NULL: a reference image */
    struct camera lens;
    struct mat3 cam_from_model;
    struct vec3 center; /* model frame */
    /* of its part that shows the outdoors, set by outdoors_picture_load() */
    struct vec3 axis;    /* of a cone around the rays */
    double cone;         /* cosine of the cone's half angle */
    double coverage;     /* steradians, about */
    float *rgb, *facing; /* per pixel; owned */
    uint8_t *state;
};

/* Sets lens and pose of a view, which is in the model's frame, and copies the names. */
enum status outdoors_picture_of_view(struct outdoors_picture *p, const struct view *view, const char *path,
                                     const char *ids, struct err *err);
/* Reads lens and pose of a lighting reference image. *placed: whether it has them. */
enum status outdoors_picture_of_reference(struct outdoors_picture *p, const char *path, const struct model_axes *axes,
                                          bool *placed, struct err *err);
void outdoors_picture_release(struct outdoors_picture *p);

/* Traces the picture's rays against the model without panes and, if some leave it, reads the picture. *shows: whether
 * some pixel shows the outdoors; if not, nothing is kept. normals: of the faces, by id of their names; reference images
 * need none. Same bits for any number of threads. */
enum status outdoors_picture_load(struct outdoors_picture *p, bool *shows, const struct model_rays *model,
                                  const struct vec3 *normals, const struct outdoors_limits *limits,
                                  struct provenance *prov, struct err *err);
void outdoors_picture_unload(struct outdoors_picture *p);

/* The colour in a direction (model frame, unit length), bilinear. *facing (may be NULL): how squarely the ray passes
 * the opening, 0 to 1. */
enum outdoors_state outdoors_picture_sample(float rgb[3], float *facing, const struct outdoors_picture *p,
                                            struct vec3 direction);

#endif
