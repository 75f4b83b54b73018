/* geometry.h - where in one picture a point of the other may be: its epipolar line, and which way along it is nearer.
 *
 * From the cameras of the photos, lenses included, where there are any; else from a fundamental matrix; or nothing is
 * known. Film pixels, centres at +0.5. */
#ifndef REMODEL_MORPH_GEOMETRY_H
#define REMODEL_MORPH_GEOMETRY_H

#include <stdbool.h>

#include "common/capture/camera.h"
#include "stages/morph_views/film.h"

enum geometry_kind { GEOMETRY_NONE, GEOMETRY_FUNDAMENTAL, GEOMETRY_POSED };

struct posed_photo {
    struct camera lens; /* of the stored photo */
    struct mat3 photo_from_world;
    struct vec3 translation; /* p_photo = photo_from_world p + translation */
    double near, far;        /* depths between which a point may lie; far may be infinity */
};

struct geometry {
    enum geometry_kind kind;
    /* GEOMETRY_FUNDAMENTAL: p2' F p1 = 0; a rotation and translation for a guessed focal length tell near from far */
    double fundamental[9], rotation[9], translation[3], focal;
    int width, height;
    /* GEOMETRY_POSED */
    struct posed_photo photos[2];
    const struct film_picture *films[2];
};

/* The line of film pixel (x, y) of picture `from` (0, 1) in the other: the unit vector towards what is nearer, and the
 * distance of a point (u, v) there from the line, dx (v - v0) - dy (u - u0) = dx v - dy u + c. False: not known; a
 * rotation has no lines. Through a lens that distorts it is a curve: with `at`, a point {u, v} of the other picture,
 * its tangent near there, otherwise (NULL) the chord from the farthest to the nearest place. */
struct epipolar_line {
    float dx, dy, c;
};
bool geometry_line(const struct geometry *g, int from, double x, double y, const double *at,
                   struct epipolar_line *line);

#endif
