/* prepare.h - from two photographs to what the frames of their morph are made from. */
#ifndef REMODEL_MORPH_PREPARE_H
#define REMODEL_MORPH_PREPARE_H

#include "common/base/provenance.h"
#include "stages/morph_views/morph_params.h"

struct morph_job {                                         /* what the command line says */
    const char *photos, *records, *first, *second, *views; /* views: NULL if there are no cameras */
};

/* Writes OUT/first.exr, second.exr, path/, path.txt and frames.mk, in this order. */
enum status morph_prepare(const struct morph_job *job, const char *out, const struct morph_params *params,
                          struct provenance *prov, struct err *err);

/* How far the morph is at a frame: 0 the first photo, 1 the second. */
double morph_time(int frame, int count, const struct morph_params *params);

#endif
