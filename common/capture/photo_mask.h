/* photo_mask.h - regions of a photo to ignore, painted black by the user: scenes/NAME/masks/ID.png.
 *
 * A mask has the size of the stored photo. Samples below half of white count as black, so the soft edge of a brush is
 * cut at its middle. */
#ifndef REMODEL_PHOTO_MASK_H
#define REMODEL_PHOTO_MASK_H

#include "common/base/provenance.h"
#include "common/capture/photo_list.h"

struct photo_mask {
    int width, height;
    unsigned char *masked; /* width * height, 1: ignore; owned; NULL: the photo has no mask */
};

/* m is {0} on entry and stays so if there is no mask. folder: of the masks; NULL: none. A view of several exposures has
 * the masks of its own id and of its exposures (their ids are in records/members). A pixel is ignored if any of them
 * masks it, because the merged picture contains light of all exposures. The files are added to prov (may be NULL) as
 * masks/ID.png. ST_DATA: the size differs from the photo's, or nothing remains. */
enum status photo_mask_read(struct photo_mask *m, const char *folder, const char *records, const struct photo_record *r,
                            struct provenance *prov, struct err *err);
void photo_mask_release(struct photo_mask *m);

#endif
