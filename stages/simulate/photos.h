/* photos.h - the files of one photograph: the JPEG of every exposure, and what is true of it. */
#ifndef REMODEL_SIMULATE_PHOTOS_H
#define REMODEL_SIMULATE_PHOTOS_H

#include "stages/simulate/render.h"

/* Renders a shot and writes OUT/photos/NAME_eK.jpg (references: OUT/lri; NAME.jpg where there is one exposure) and, of
 * photos, if params->truth says so, OUT/truth/{depth,ids,hdr}/NAME.exr. */
enum status photo_make(const struct world *w, const struct shoot *s, const struct shot *shot, const char *out,
                       const struct simulate_params *params, const struct provenance *prov, struct err *err);

/* The radiance of an edited scene seen by a shot, into OUT/truth/edited-EDIT/hdr/NAME.exr. */
enum status photo_make_edited(const struct world *w, const struct shoot *s, const struct shot *shot, const char *out,
                              const char *edit, const struct simulate_params *params, const struct provenance *prov,
                              struct err *err);

/* "NAME_eK.jpg", or "NAME.jpg" where there is one exposure; the caller frees it. NULL: no memory. */
char *photo_file_name(const struct shoot *s, const struct shot *shot, int exposure);

#endif
