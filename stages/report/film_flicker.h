/* film_flicker.h - how steady a film is: what changes between a frame and the next at one place of a surface.
 *
 * It needs no truth: the frames' depth and cameras say where a pixel's place is in the next frame. */
#ifndef REMODEL_FILM_FLICKER_H
#define REMODEL_FILM_FLICKER_H

#include <stdbool.h>
#include <stddef.h>

#include "common/capture/camera_path.h"

struct flicker_picture { /* a frame; owned */
    struct view camera;
    float *luminance, *z; /* w * h; z: 0 unknown */
};

struct flicker_values { /* relative differences; owned */
    float *values;
    size_t count, capacity;
};

/* Adds abs(Y' - Y) / max(min(Y, Y'), 0.01) of every `step`th pixel in both directions whose place the next frame shows:
 * Y' is interpolated between four pixels within 2 % of its depth. */
enum status film_flicker_add(struct flicker_values *v, const struct flicker_picture *frame,
                             const struct flicker_picture *next, int step, struct err *err);
/* The part `fraction` of the values is not larger; 0 without values. Sorts them. */
double film_flicker_quantile(struct flicker_values *v, double fraction);
void film_flicker_release(struct flicker_values *v);

/* Percentiles 50 and 95 over 12 pairs of neighbouring frames of O/FILM/frames, spread over the film. *known: false if a
 * frame is missing, has no depth, or fits no camera of the path. ST_NOMEM; ST_IO: a trouble that passes
 * (passing.h). */
enum status film_flicker_measure(double *middle, double *high, bool *known, const struct camera_path *path,
                                 const char *folder, const char *film, struct err *err);

#endif
