/* align.h - finds shifts between the exposures of a view, in whole pixels. */
#ifndef REMODEL_HDR_ALIGN_H
#define REMODEL_HDR_ALIGN_H

#include "stages/hdr_merge/merge.h"

struct alignment {
    struct shift shifts[MERGE_MAX_EXPOSURES]; /* against the middle exposure */
    bool found[MERGE_MAX_EXPOSURES];          /* false: too little contrast to compare; the shift is the neighbour's */
    bool at_limit[MERGE_MAX_EXPOSURES];       /* against the neighbour the shift is max_shift, the largest searched */
};

/* Compares each exposure with its neighbour towards `middle` and adds up the shifts. Ignores b->shifts. ST_NOMEM. */
enum status align_brackets(struct alignment *a, const struct brackets *b, int middle, int max_shift, struct err *err);

#endif
