/* keyframes.h - reader of keyframed films: scenes/NAME/keyframes/FILM.txt (docs/formats.md).
 *
 * A film is a sequence of shots; a shot is a run of keys or a planned move. Cameras are computed from the keys while
 * reading, so every error names its line. Scene units, seconds, pixels of the film. */
#ifndef REMODEL_KEYFRAMES_H
#define REMODEL_KEYFRAMES_H

#include <stdbool.h>

#include "common/capture/camera_set.h"
#include "common/film/effects.h"

/* The animated values of a film's camera besides its pose. */
enum lens_channel { LENS_FX, LENS_FY, LENS_CX, LENS_CY, LENS_APERTURE, LENS_FOCUS, LENS_CHANNELS };

struct film_key {
    double time; /* from the start of the shot */
    struct vec3 position;
    struct quat rotation; /* world_from_cam */
    double lens[LENS_CHANNELS];
    bool keyed[LENS_CHANNELS]; /* channels that this key sets; others are interpolated from the keys that do */
};

struct film_shot {
    int line;     /* where it begins in the file */
    double join;  /* duration of the transition from the previous shot, s; 0: a cut */
    char *effect; /* name of a planned move; NULL: a shot of keys */
    bool reversed;
    double seconds; /* duration of a planned move; 0: as planned */
    struct film_key *keys;
    int key_count;
};

struct film_script {
    struct film_shot *shots;
    int shot_count;
    struct effects layers;
};

/* set: the views that keys may name. ups: each view's upright direction in its own camera; NULL: (0, -1, 0). lens: the
 * film's size and principal point, and the focal length until one is keyed. up: the upright direction in the world for
 * keys without their own. script is empty on entry and, on failure, on return. ST_DATA with file, line, what was found
 * and what was expected. */
enum status keyframes_read(struct film_script *script, const char *file, const struct camera_set *set,
                           const struct vec3 *ups, const struct view *lens, struct vec3 up, struct provenance *prov,
                           struct err *err);
void keyframes_release(struct film_script *script);

#endif
