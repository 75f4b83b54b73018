/* relit_picture.h - a photograph in the light of a state of lamps, blinds and sky: a sum of parts (relit_light.h). */
#ifndef REMODEL_LEVELS_RELIT_PICTURE_H
#define REMODEL_LEVELS_RELIT_PICTURE_H

#include "stages/light_levels/relit_light.h"

/* What a state brings to the places of photographs. {0} is the empty state; owned. */
struct relit_sum {
    float *light;    /* 3 of each place, in the unit of the photographs, or without a scale in lx */
    float *texture;  /* in which they were photographed; not owned */
    double *lamps;   /* factor of each lamp */
    double *windows; /* of each window's outdoors, by how bright they were photographed */
    double *blinds;  /* the part of the sun that each window lets through */
    double sun;      /* of a surface that faces it, in the unit of light */
    struct vec3 to_sun;
    int shade;
};

/* ST_DATA: the state has a lamp, a window or a sky that r does not have, or adds light in two units without a scale.
 * The caller releases s in each case. */
enum status relit_sum_make(struct relit_sum *s, const struct relit_light *r, const struct light_state *state,
                           struct err *err);
void relit_sum_release(struct relit_sum *s);

/* By what each channel of a pixel's photographed radiance is multiplied. */
void relit_sum_quotient(double to[3], const struct relit_sum *s, const struct relit_light *r,
                        const struct relit_photo *p, int x, int y);

/* The picture, 3 bytes a pixel. *exposure, times that of the photograph: 0 becomes the one at which the room is well
 * exposed. ST_DATA: a damaged JPEG. */
enum status relit_picture_draw(unsigned char *rgb, const struct relit_light *r, const struct relit_photo *p,
                               const struct relit_sum *s, double *exposure, struct err *err);

/* What --from asks for: a picture of the folder's photo in a state, a PNG. */
struct relit_picture_files {
    const char *from, *states, *out; /* states NULL: those that every scene has */
    const char *state;               /* its name, or its words as in states.txt */
    const char *photo;
    double exposure;
};
enum status relit_picture_make(const struct relit_picture_files *f, struct err *err);

#endif
