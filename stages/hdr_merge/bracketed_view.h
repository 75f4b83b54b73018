/* bracketed_view.h - one view's exposures, its record, and the radiance merged from them, on disk and in memory. */
#ifndef REMODEL_BRACKETED_VIEW_H
#define REMODEL_BRACKETED_VIEW_H

#include "common/photo_list.h"
#include "common/provenance.h"
#include "stages/hdr_merge/merge.h"

struct bracketed_view {
    struct photo_record record;
    struct photo photos[MERGE_MOST];
    double exposures[MERGE_MOST]; /* relative to white's */
    struct image radiance;        /* R G B, 1 is white */
    uint8_t *marks;               /* a pixel: MERGE_BRIGHT, MERGE_DARK; owned */
};

/* RECORDS/ID.txt and the photos it names in PHOTOS. v is {0} on entry; release it also after a failure. ST_DATA: a
 * single photo's record, or more exposures than MERGE_MOST. */
enum status bracketed_view_read(struct bracketed_view *v, const char *id, const char *photos, const char *records,
                                struct provenance *prov, struct err *err);
/* OUT/ID.jpg, the middle exposure: a JPEG's own bytes, anything else encoded. */
enum status bracketed_view_write_middle(const struct bracketed_view *v, const char *photos, const char *out,
                                        struct err *err);
/* OUT/ID.exr. *beyond: samples brighter than a half number holds, cut there. */
enum status bracketed_view_write_radiance(const struct bracketed_view *v, const char *out,
                                          const struct provenance *prov, size_t *beyond, struct err *err);
void bracketed_view_release(struct bracketed_view *v);

#endif
