/* picture_record.h - what the pixels of a rendered picture come from: O/remodel/E/pictures/VIEW.txt, written by
 * render_model.
 *
 *   remodel-picture 1
 *   size WIDTH HEIGHT
 *   exposure E             radiance times E is 1 at white
 *   changed PERCENT        pixels of the photo that the edit changes
 *   made KIND PERCENT      for each kind of picture_made.h */
#ifndef REMODEL_PICTURE_RECORD_H
#define REMODEL_PICTURE_RECORD_H

#include "common/base/provenance.h"
#include "common/texture/picture_made.h"

struct picture_record {
    int width, height;
    double exposure, changed, shares[MADE_COUNT]; /* shares of a file that lacks a kind: 0 */
};

enum status picture_record_write(const struct picture_record *record, const char *path, const struct provenance *prov,
                                 struct err *err);
/* ST_DATA with file and line: an unknown kind, or one twice; a share that is not within 0 and 100; an exposure that is
 * not above 0. */
enum status picture_record_read(struct picture_record *record, const char *path, struct provenance *prov,
                                struct err *err);

#endif
