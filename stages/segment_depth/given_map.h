/* given_map.h - the samples of a depth file that a user provides: EXR, PNG, PFM or TIFF. */
#ifndef REMODEL_GIVEN_MAP_H
#define REMODEL_GIVEN_MAP_H

#include <stdbool.h>

#include "common/base/provenance.h"

struct given_map {
    int width, height;
    double *samples;    /* width * height, as in the file; NaN: unknown; owned */
    bool whole_numbers; /* of unknown scale */
    double sentinel;    /* the value that stood for unknown depth; NaN: none */
    int sentinels;      /* how many samples had it */
};

/* *path: the file NAME.exr, .png, .pfm, .tif or .tiff in the folder, malloc'ed; NULL if there is none. Extensions may
 * be in capitals; a name that differs in capitals only is taken if none is exact. */
enum status given_map_find(char **path, const char *folder, const char *name, struct err *err);

/* NaN, infinity and sentinels become NaN. ST_DATA names the file: not what its extension says, more than one channel
 * (an EXR may have a channel Z among others). */
enum status given_map_read(struct given_map *m, const char *path, struct err *err);
void given_map_release(struct given_map *m);

/* Marks a sentinel as unknown: with it, programs fill what they do not know, as -1, 65535 or 1e10. It is the least
 * value, if it is the only negative one, or the greatest, if it is more than GIVEN_GAP times as large as the one
 * below; it is there GIVEN_REPEATED times at least. */
#define GIVEN_GAP 2.0
enum { GIVEN_REPEATED = 16 };
enum status given_map_clear_sentinel(struct given_map *m, struct err *err);

#endif
