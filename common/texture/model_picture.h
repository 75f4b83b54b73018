/* model_picture.h - a picture of a model under photographic texture, and what each of its pixels comes from. */
#ifndef REMODEL_MODEL_PICTURE_H
#define REMODEL_MODEL_PICTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"

/* What a pixel comes from; the numbers are those of the channel `made`. */
enum picture_made {
    MADE_NOTHING,     /* nothing is there, or nothing is known */
    MADE_PHOTO,       /* the photo's own pixel */
    MADE_ORIGINAL,    /* a texel that the viewpoint's own photo shows */
    MADE_WARPED,      /* a texel from another photo */
    MADE_SYNTHESISED, /* a texel that no photo shows clean, or the nearest texel of a face beyond what is baked */
    MADE_COLOUR,      /* a colour: default, or given by the edit */
    MADE_OUTDOORS,    /* what lies outside, by direction */
    MADE_CLUTTER,     /* furniture, from a view's layers */
    MADE_UNSURE,      /* the shell, where the depth was not confident enough to say whether clutter stands there */
    MADE_COUNT,
};

/* {0} is the empty state; everything is owned. */
struct model_picture {
    int width, height;
    float *rgb;    /* 3 a pixel, radiance, scene-linear; 0 where MADE_NOTHING */
    float *z;      /* depth of the model's face along the camera's axis, model units; 0: none */
    uint32_t *id;  /* of that face's name in model.txt, 0: none. Panes of glass are looked through */
    uint8_t *made; /* enum picture_made */
    bool has_camera;
    struct camera lens; /* of has_camera: what drew the picture, ... */
    struct pose pose;   /* ... cam_from_model */
};

/* Makes empty planes, or reuses those of the same size. */
enum status model_picture_resize(struct model_picture *p, int width, int height, struct err *err);
void model_picture_release(struct model_picture *p);
void model_picture_set_camera(struct model_picture *p, const struct camera *lens, const struct pose *cam_from_model);
/* R G B half, Z float, id and made uint; R G B below 0, of colours outside of Rec.709, become 0. camera: in the scene's
 * frame, for the EXR's attributes. The lens and the pose in the model's frame, if they are set, become attributes
 * remodel:lens, remodel:lens0, ..., remodel:pose. */
enum status model_picture_write(const struct model_picture *p, const struct view *camera, const char *path,
                                const struct provenance *prov, struct err *err);
enum status model_picture_read(struct model_picture *p, const char *path, struct provenance *prov, struct err *err);

#endif
