/* photo_mask.h - what people painted over in a photo: scenes/NAME/masks/ID.png, black where it is not to be looked at.
 *
 * A mask is as large as the photo is stored. Samples below half of white are black: the soft edge of a brush counts by
 * its middle. */
#ifndef REMODEL_PHOTO_MASK_H
#define REMODEL_PHOTO_MASK_H

#include "common/base/provenance.h"
#include "common/capture/photo_list.h"

struct photo_mask {
    int width, height;
    unsigned char *masked; /* w * h, 1: not to be looked at; owned; NULL: the photo has no mask */
};

/* m is {0} on entry and stays so if there is no mask. folder: of the masks, NULL: there are none. A photo that stands for several
 * exposures has the masks of its own id and of each exposure's (records/members has their ids): what one of them hides is
 * hidden, for the merged picture holds light of all. prov (NULL: not wanted) gets the files as masks/ID.png. ST_DATA: another size than
 * the photo's, or nothing is left to look at. */
enum status photo_mask_read(struct photo_mask *m, const char *folder, const char *records, const struct photo_record *r,
                            struct provenance *prov, struct err *err);
void photo_mask_release(struct photo_mask *m);

#endif
