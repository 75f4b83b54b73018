/* pixels.h - what the pixels of a picture show of an edited model, and where the light on it is gathered. */
#ifndef REMODEL_RELIGHT_PIXELS_H
#define REMODEL_RELIGHT_PIXELS_H

#include "common/relight/light_change.h"
#include "common/texture/model_picture.h"

enum pixel_kind {
    PIXEL_KEPT,    /* the outdoors, or nothing: its light stays */
    PIXEL_TEXTURE, /* a texture: radiance times the quotient of light */
    PIXEL_COLOUR,  /* a colour of the edit: albedo / pi times the light */
    PIXEL_CLUTTER, /* furniture that the model does not hold, at its own place */
    PIXEL_LAMP     /* a lamp: its radiance times what the edit makes of it */
};

/* A synthetic object in a pixel. */
struct object_pixel {
    int pixel, object;
    float cover; /* part of the pixel */
    struct gather_point point;
    struct vec3 to_viewer; /* unit */
};

/* The luminous opening of a lamp that the edit adds, in a pixel. */
struct opening_pixel {
    int pixel;
    float cover;  /* part of the pixel */
    float rgb[3]; /* radiance times that part */
};

/* {0} is the empty state; everything is owned. Pixels are in rows. */
struct pixels {
    int width, height;
    uint8_t *kind;                       /* enum pixel_kind */
    struct gather_point *before, *after; /* a normal of 0 0 0: no light is needed */
    float (*albedo)[3];                  /* of PIXEL_COLOUR; of PIXEL_LAMP: the factors of its radiance */
    int *face;                           /* index into the edited model's mesh; -1: none */
    int *from;                           /* id of the unedited face that has the texel */
    float (*texel)[3];                   /* its place there */
    bool *is_new;                        /* the unedited model has no surface there */
    struct vec3 centre;                  /* of the camera */
    struct object_pixel *objects;
    int object_count;
    struct opening_pixel *openings;
    int opening_count;
    bool is_black; /* all but nothing is drawn: all pixels are kept */
};

/* A view's own depth and clutter, for pictures of original views; NULL folders: unknown. */
struct pixel_layers {
    const char *ids, *depth; /* folders */
    const struct view *view; /* scene frame */
};

/* The picture must have a camera. layers (NULL: none): of the view that the picture is. The caller releases p in each
 * case. ST_DATA: damaged layers. */
enum status pixels_find(struct pixels *p, const struct light_change *c, const struct model_picture *picture,
                        const struct pixel_layers *layers, struct provenance *prov, struct err *err);
void pixels_release(struct pixels *p);

#endif
