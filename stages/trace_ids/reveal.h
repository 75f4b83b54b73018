/* reveal.h - surfaces of the unedited model that a view would see after an edit. */
#ifndef REMODEL_REVEAL_H
#define REMODEL_REVEAL_H

#include <stdint.h>

#include "common/light/view_trace.h"
#include "common/texture/view_ids.h"

/* {.base = trace} is the empty state. */
struct reveal {
    const struct view_trace *base; /* the view in the unedited model */
    int layers;                    /* that have a surface in some pixel */
    uint32_t **faces; /* [layer][pixel]: 1 + a face of the base, 0: no more surfaces; in order of depth. Owned */
};

/* Adds what an edited model shows. *pixels: how many pixels show something new. */
enum status reveal_add(struct reveal *r, const struct view_trace *edited, int64_t *pixels, struct err *err);
enum status reveal_result(struct view_reveal *result, const struct reveal *r, struct err *err);
void reveal_release(struct reveal *r);

#endif
