/* film.h - a film of keys and planned moves, one after the other (thesis 3.4.4).
 *
 * A shot's first and last frame show its first and last key. Between two shots there is a cut, the next frame, or a
 * join: a transition whose velocities are those of the shots' ends, cubic in place and orientation, monotone in all
 * else. Focal length goes by its logarithm. */
#ifndef REMODEL_FILM_H
#define REMODEL_FILM_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/capture/camera_path.h"
#include "common/film/effects.h"

struct film {
    const char *name;             /* of the film, for path.txt */
    const struct camera_set *set; /* the scene's views */
    const struct vec3 *ups;       /* their upright directions in their own cameras; NULL: 0 -1 0 */
    struct view lens;             /* size, principal point, and the focal length where none is keyed (film_lens.h) */
    struct vec3 up;               /* upright in the world */
    double fps;
    bool rest;         /* shots of keys start and end at rest */
    const char *moves; /* the folder of planned moves, parallax/; NULL: there are none */
};

/* The film that `file` describes (docs/formats.md), and its effect layers: those of its moves, which moves/EFFECT/
 * effects.txt has, over each move's own time, then the file's. path and layers are empty on entry, and left so on
 * failure. Each file read is added to prov, which may be NULL. Scores "shot_N": the second at which it begins. */
enum status keyframed_path(struct camera_path *path, struct effects *layers, const char *file, const struct film *film,
                           struct provenance *prov, struct err *err);

#endif
