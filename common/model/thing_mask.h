/* thing_mask.h - the things before the pixels of a view: out/SCENE/things/masks/VIEW.exr. */
#ifndef REMODEL_THING_MASK_H
#define REMODEL_THING_MASK_H

#include <stdint.h>

#include "common/base/provenance.h"
#include "common/capture/view.h"

/* {0} is the empty state. Both: width * height ids of things, from 1; 0: none; owned. */
struct thing_mask {
    uint32_t *shows; /* what the view shows there: channel id */
    uint32_t *meets; /* whose fused surface the pixel's ray meets first, before the model: channel meets */
};

enum status thing_mask_init(struct thing_mask *m, const struct view *view, struct err *err);
void thing_mask_release(struct thing_mask *m);
enum status thing_mask_write(const struct thing_mask *m, const struct view *view, const char *path,
                             const struct provenance *prov, struct err *err);
/* A failure leaves m empty. ST_DATA: the size is not the view's; an id above max_id. */
enum status thing_mask_read(struct thing_mask *m, const struct view *view, const char *path, uint32_t max_id,
                            struct provenance *prov, struct err *err);

#endif
