/* place_pixels.h - what the files that place things by pixels share; everything else includes place.h or
 * place_line.h. */
#ifndef REMODEL_BUILD_MODEL_PLACE_PIXELS_H
#define REMODEL_BUILD_MODEL_PLACE_PIXELS_H

#include "stages/build_model/place/place.h"

#define PLACE_MIN_COSINE 0.02 /* between a ray and a plane's normal for an intersection */

struct visible_point { /* in a rectangle */
    const struct placed_point *point;
    double distance;
    float angle; /* the solid angle of a unit of its surface */
    float u, v;  /* in the rectangle, 0 .. 1 */
    int cell;
};

/* By a photo's id or a view's name. ST_DATA: unknown. */
enum status place_find_photo(const struct placer_photo **found, const struct placer *placer, const char *view,
                             const char *path, int line, struct err *err);

/* The ray through a pixel, in the model's frame. False: the lens has none. */
bool place_pixel_ray(struct vec3 *ray, const struct placer_photo *c, double x, double y);

/* ST_DATA: that. */
enum status place_no_ray(const struct placer_photo *c, double x, double y, const char *path, int line, struct err *err);

#endif
