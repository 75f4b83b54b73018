/* epipolar.h - epipolar lines between two pictures, directed towards nearer points.
 *
 * They come from the photos' cameras, including lenses, if known; else from a fundamental matrix; else there are none.
 * Film pixels, centres at +0.5. */
#ifndef REMODEL_MORPH_EPIPOLAR_H
#define REMODEL_MORPH_EPIPOLAR_H

#include <stdbool.h>

#include "common/capture/camera.h"
#include "stages/morph_views/film_format.h"

enum epipolar_kind { EPIPOLAR_NONE, EPIPOLAR_FUNDAMENTAL, EPIPOLAR_POSED };

struct posed_photo {
    struct camera lens; /* of the stored photo */
    struct mat3 photo_from_world;
    struct vec3 translation; /* p_photo = photo_from_world p + translation */
    double near, far;        /* depth range of the scene; far may be infinity */
};

struct pair_geometry {
    enum epipolar_kind kind;
    /* EPIPOLAR_FUNDAMENTAL: p2' F p1 = 0; the relative pose, for a guessed focal length, only directs the lines */
    double fundamental[9], rotation[9], translation[3], focal;
    int width, height;
    /* EPIPOLAR_POSED */
    struct posed_photo photos[2];
    const struct film_picture *films[2];
};

/* (dx, dy): unit vector towards nearer points; the signed distance of a point (u, v) from the line is dx v - dy u +
 * c. */
struct epipolar_line {
    float dx, dy, c;
};

/* Epipolar line of film pixel (x, y) of picture `from` (0, 1) in the other picture. Through a distorting lens it is a
 * curve: `at`, a point {u, v} of the other picture, selects the tangent near it; NULL selects the chord between the
 * images of the farthest and the nearest depth. False: unknown, also for a pure rotation. */
bool epipolar_line_at(const struct pair_geometry *g, int from, double x, double y, const double *at,
                      struct epipolar_line *line);

#endif
