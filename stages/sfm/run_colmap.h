/* run_colmap.h - COLMAP's sparse reconstruction of a set of photographs. */
#ifndef REMODEL_RUN_COLMAP_H
#define REMODEL_RUN_COLMAP_H

#include "stages/sfm/colmap_job.h"

/* Adds COLMAP's models of the photos to the folder; their images have the names of the photos' files. ST_DATA: fewer
 * than two photos, or COLMAP placed none; the message gives the likely reason and names the photos. */
enum status run_colmap(struct sfm_folder *f, const struct sfm_input *in, const struct provenance *prov,
                       struct err *err);

#endif
