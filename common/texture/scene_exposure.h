/* scene_exposure.h - the exposure of all pictures and films of a scene's rooms: out/SCENE/exposure.txt, written by
 * choose_exposure.
 *
 *   remodel-exposure 1
 *   exposure E             radiance times E is 1 at white */
#ifndef REMODEL_SCENE_EXPOSURE_H
#define REMODEL_SCENE_EXPOSURE_H

#include "common/base/provenance.h"

/* From the exposures that cameras would have chosen for the views, all above 0: their median, in thirds of a stop. The
 * order of `of_views` changes. 1 without views. */
double scene_exposure_of(double *of_views, int count);

/* Leaves the file alone if its text does not change. */
enum status scene_exposure_write(double exposure, const char *path, const struct provenance *prov, struct err *err);
/* ST_DATA with file and line: an exposure that is not above 0. */
enum status scene_exposure_read(double *exposure, const char *path, struct provenance *prov, struct err *err);

#endif
