/* keyframed_film.h - a film of keyframed shots and planned moves in sequence [Colburn 2014, 3.4.4].
 *
 * A shot's first and last frame show its first and last key. Two shots are separated by a cut, or connected by a join:
 * a transition that continues the velocities of both shots, cubic in position and orientation and monotone in
 * everything else. Focal lengths are interpolated as logarithms. */
#ifndef REMODEL_KEYFRAMED_FILM_H
#define REMODEL_KEYFRAMED_FILM_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/capture/camera_path.h"
#include "common/film/effects.h"

struct film_settings {
    const char *name;             /* of the film, for path.txt */
    const struct camera_set *set; /* the scene's views */
    const struct vec3 *ups;       /* each view's upright direction in its own camera; NULL: (0, -1, 0) */
    struct view lens;             /* size and principal point, and the focal length if none is keyed (film_lens.h) */
    struct vec3 up;               /* upright direction in the world */
    double fps;
    bool rest;         /* shots of keys start and end at rest */
    const char *moves; /* folder of the planned moves, parallax/; NULL: none */
};

/* Computes the film described by `file` (docs/formats.md) and its effect layers: first those of its moves, from
 * moves/EFFECT/effects.txt, over each move's own time, then the file's own. path and layers are empty on entry and, on
 * failure, on return. Adds each file that it reads to prov, which may be NULL. Score "shot_N": the second at which shot
 * N begins. */
enum status keyframed_path(struct camera_path *path, struct effects *layers, const char *file,
                           const struct film_settings *film, struct provenance *prov, struct err *err);

#endif
