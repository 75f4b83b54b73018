/* csv_model.h - cameras in a table, as RealityScan and RealityCapture write them. */
#ifndef REMODEL_CSV_MODEL_H
#define REMODEL_CSV_MODEL_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/capture/photo_list.h"
#include "common/capture/sfm_model.h"

/* Reads the first *.csv of the folder whose first line names the columns of "Internal/External camera parameters".
 * *found: whether there is one; if not, *m is empty. The file is recorded in prov, which may be NULL. Images that are
 * no photos of the scene are left out. ST_DATA names the file and the line. */
enum status csv_model_read(struct sfm_model *m, bool *found, const char *folder, const struct photo_list *photos,
                           struct provenance *prov, struct err *err);

#endif
