/* outdoors.h - what lies outside of a model, by direction: out/SCENE/outdoors/outdoors.exr, made by bake_outdoors.
 *
 * An equirectangular picture in the model's frame: column x + 0.5 of W is the azimuth 2 pi (x + 0.5) / W - pi, counted
 * from +x towards +y; row y + 0.5 of H the elevation pi / 2 - pi (y + 0.5) / H, z up. R G B half, radiance,
 * scene-linear; A half: 1 where some picture shows the direction, 0 where it is guessed from those that are; source
 * uint: 0 guessed, 1 a lighting reference image, 2 a photograph. How far things outside are is unknown: whatever is
 * looked up here moves with the camera as if it were infinitely far away. */
#ifndef REMODEL_OUTDOORS_H
#define REMODEL_OUTDOORS_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/provenance.h"
#include "common/math/vec.h"

enum outdoors_source { OUTDOORS_GUESSED, OUTDOORS_REFERENCE, OUTDOORS_PHOTO };

/* {0} is the empty state. */
struct outdoors {
    int width, height; /* width = 2 height */
    float *rgb;        /* 3 a pixel; owned */
    uint8_t *source;   /* enum outdoors_source; owned */
};

/* A black picture of 2 height x height px, all of it guessed. ST_DATA: height is not 1 to 8192. */
enum status outdoors_init(struct outdoors *o, int height, struct err *err);
void outdoors_release(struct outdoors *o);
/* The unit direction at a place of the picture; pixel (x, y) has its centre at (x + 0.5, y + 0.5). */
struct vec3 outdoors_direction(const struct outdoors *o, double x, double y);
/* ST_DATA: a width other than twice the height, a missing channel, a negative radiance, an unknown source. */
enum status outdoors_read(struct outdoors *o, const char *path, struct provenance *prov, struct err *err);
enum status outdoors_write(const struct outdoors *o, const char *path, const struct provenance *prov, struct err *err);
/* Where a direction falls in the picture. */
struct outdoors_place {
    size_t pixels[4];    /* left and right of the upper row, then of the lower one */
    float right, bottom; /* how far it lies towards them, 0 to 1 */
};

/* For a direction of any length. Asks for the memory there, so that a look at several places waits once. o is not
 * empty. */
struct outdoors_place outdoors_find(const struct outdoors *o, struct vec3 direction);
/* The radiance there, bilinear; returns the source of the nearest pixel. */
enum outdoors_source outdoors_look(float rgb[3], const struct outdoors *o, const struct outdoors_place *place);
/* The radiance from a direction of any length, bilinear; returns the source of the nearest pixel. An empty `outdoors`
 * gives 0 and OUTDOORS_GUESSED. */
enum outdoors_source outdoors_sample(float rgb[3], const struct outdoors *o, struct vec3 direction);

#endif
