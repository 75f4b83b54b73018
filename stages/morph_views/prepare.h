/* prepare.h - preparation of a morph: reads two photographs, matches them and writes what its frames are made from. */
#ifndef REMODEL_MORPH_PREPARE_H
#define REMODEL_MORPH_PREPARE_H

#include "common/base/provenance.h"
#include "stages/morph_views/morph_params.h"

struct morph_job {                                         /* the command line */
    const char *photos, *records, *first, *second, *views; /* views: NULL: no cameras */
};

/* Writes OUT/second.exr, first.exr, path/, path.txt and frames.mk, in this order. ST_DATA: a photo has the wrong shape
 * or is too small, or too few pixels match. */
enum status morph_prepare(const struct morph_job *job, const char *out, const struct morph_params *params,
                          struct provenance *prov, struct err *err);

/* Position of a frame in the morph: 0 is the first photo, 1 the second. */
double morph_time(int frame, int count, const struct morph_params *params);

#endif
