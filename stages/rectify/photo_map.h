/* photo_map.h - where the pixels of a view lie in the photo. Both cameras have the same centre. */
#ifndef REMODEL_PHOTO_MAP_H
#define REMODEL_PHOTO_MAP_H

#include <stddef.h>

#include "common/capture/camera_set.h"

enum { PHOTO_MAP_KNOTS = 8 };

struct photo_point { /* the projection of a view's pixel in the photo, px */
    double u, v;     /* NAN: outside the lens */
};

struct photo_map {
    const struct camera *lens;
    struct mat3 photo_from_view;
    const struct view *view;
    size_t row, knots; /* numbers that a row of projections, and of its knots, holds */
    /* weights of four knots, and of every other one, at each pixel from the second to the third */
    double cubic[2][4][2 * PHOTO_MAP_KNOTS];
};

/* The projections of a row's pixels and of the one after the last. */
struct map_row {
    double *u, *v;
};

void photo_map_init(struct photo_map *m, const struct camera *lens, const struct mat3 *photo_from_view,
                    const struct view *view);
struct photo_point photo_map_point(const struct photo_map *m, int x, int y);
/* Projects a row of pixels. row, knots: memory of m->row and m->knots numbers for each of u and v. */
void photo_map_row(const struct photo_map *m, int y, const struct map_row *row, const struct map_row *knots);

#endif
