/* keyframes.h - a film as a person writes it: scenes/NAME/keyframes/FILM.txt (docs/formats.md).
 *
 * A film is a row of shots: runs of keys, planned moves. What keys say of cameras is worked out while it is read, so
 * that every error names its line. Scene units, seconds, pixels of the film. */
#ifndef REMODEL_KEYFRAMES_H
#define REMODEL_KEYFRAMES_H

#include <stdbool.h>

#include "common/capture/camera_set.h"
#include "common/film/effects.h"

/* What a film's camera has beside its pose. */
enum film_number { FILM_FX, FILM_FY, FILM_CX, FILM_CY, FILM_APERTURE, FILM_FOCUS, FILM_NUMBERS };

struct film_key {
    double time; /* from the start of the shot */
    struct vec3 place;
    struct quat turn; /* world_from_cam */
    double number[FILM_NUMBERS];
    bool has[FILM_NUMBERS]; /* the others go on as the keys around say */
};

struct film_shot {
    int line;     /* of the file, where it begins */
    double join;  /* seconds of the transition from the shot before; 0: a cut */
    char *effect; /* a planned move; or NULL: keys */
    bool reversed;
    double seconds; /* of a planned move; 0: its own */
    struct film_key *keys;
    int key_count;
};

struct film_script {
    struct film_shot *shots;
    int shot_count;
    struct effects layers;
};

/* set: the views that keys may name. ups: each view's upright direction in its own camera, NULL: 0 -1 0. lens: the
 * film's size, principal point and focal length where none is keyed. up: the film's, in the world, where none is
 * written. script is empty on entry, and left so on failure. ST_DATA with file, line, what was found and what was
 * wanted. */
enum status film_script_read(struct film_script *script, const char *file, const struct camera_set *set,
                             const struct vec3 *ups, const struct view *lens, struct vec3 up, struct err *err);
void film_script_release(struct film_script *script);

#endif
