/* photos.h - the files of one camera: a JPEG for each exposure, and pictures of what is true. */
#ifndef REMODEL_SIMULATE_PHOTOS_H
#define REMODEL_SIMULATE_PHOTOS_H

#include "stages/simulate/render.h"

/* What all pictures of a run share. */
struct picture_job {
    const struct shoot *shoot;
    const char *out;
    const struct simulate_params *params;
    const struct provenance *prov;
};

/* Renders a photo and writes OUT/photos/NAME_eK.jpg, or NAME.jpg if there is one exposure; reference images go to
 * OUT/lri. Photos also get OUT/truth/{depth,ids,hdr}/NAME.exr, if params->truth is "yes". A witness gets only
 * OUT/truth/novel/{depth,ids,hdr}/NAME.exr. ST_DATA: no light reaches the photo. */
enum status photo_make(const struct picture_job *job, const struct world *w, const struct shoot_photo *photo,
                       struct err *err);

/* Writes OUT/FOLDER/{depth,ids,hdr}/NAME.exr: depth, faces and radiance with params->truth_samples,
 * black where no light reaches the camera. */
enum status photo_make_truth(const struct picture_job *job, const struct world *w, const struct shoot_photo *photo,
                             const char *folder, struct err *err);

/* Radiance or irradiance as half, or as float. */
enum status photo_write_colour(const struct image *colour, bool half, const char *path, const struct provenance *prov,
                               struct err *err);

/* "NAME_eK.jpg", or "NAME.jpg" if there is one exposure; the caller frees it. NULL: out of memory. */
char *photo_file_name(const struct shoot *s, const struct shoot_photo *photo, int exposure);

#endif
