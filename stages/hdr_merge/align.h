/* align.h - small shifts between the exposures of a view: whole pixels, found by median threshold bitmaps. */
#ifndef REMODEL_HDR_ALIGN_H
#define REMODEL_HDR_ALIGN_H

#include "stages/hdr_merge/merge.h"

struct alignment {
    struct shift shifts[MERGE_MOST]; /* against the middle exposure */
    bool told[MERGE_MOST];           /* else the exposure has too little to go by, and its shift is its neighbour's */
    bool at_limit[MERGE_MOST];       /* the shift may be larger */
};

/* b->shifts are not looked at. Each exposure is compared with its neighbour towards `middle`. */
enum status align_brackets(struct alignment *a, const struct brackets *b, int middle, int most_shift, struct err *err);

#endif
