/* metashape_model.h - cameras in an XML file, as Agisoft Metashape and PhotoScan write them. */
#ifndef REMODEL_METASHAPE_MODEL_H
#define REMODEL_METASHAPE_MODEL_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/capture/photo_list.h"
#include "common/capture/sfm_model.h"

/* Reads the first *.xml of the folder with sensors and cameras of a chunk. *found: whether there is one; if not, *m is
 * empty. The file is recorded in prov, which may be NULL. ST_DATA names the file, and the line or the camera. */
enum status metashape_model_read(struct sfm_model *m, bool *found, const char *folder, const struct photo_list *photos,
                                 struct provenance *prov, struct err *err);

#endif
