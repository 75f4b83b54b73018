/* photos.h - the files of one photograph: a JPEG for each exposure, and its ground truth. */
#ifndef REMODEL_SIMULATE_PHOTOS_H
#define REMODEL_SIMULATE_PHOTOS_H

#include "stages/simulate/render.h"

/* Renders a photo and writes OUT/photos/NAME_eK.jpg, or NAME.jpg if there is one exposure; reference images go to
 * OUT/lri. Photos also get OUT/truth/{depth,ids,hdr}/NAME.exr, if params->truth is "yes". */
enum status photo_make(const struct world *w, const struct shoot *s, const struct shoot_photo *photo, const char *out,
                       const struct simulate_params *params, const struct provenance *prov, struct err *err);

/* Renders an edited scene from a photo's camera and writes its radiance to OUT/truth/edited-EDIT/hdr/NAME.exr. */
enum status photo_make_edited(const struct world *w, const struct shoot *s, const struct shoot_photo *photo,
                              const char *out, const char *edit, const struct simulate_params *params,
                              const struct provenance *prov, struct err *err);

/* "NAME_eK.jpg", or "NAME.jpg" if there is one exposure; the caller frees it. NULL: out of memory. */
char *photo_file_name(const struct shoot *s, const struct shoot_photo *photo, int exposure);

#endif
