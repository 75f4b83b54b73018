/* thing_mask.h - the things that the pixels of a view show: out/SCENE/things/masks/VIEW.exr, channel id (uint). */
#ifndef REMODEL_THING_MASK_H
#define REMODEL_THING_MASK_H

#include <stdint.h>

#include "common/base/provenance.h"
#include "common/capture/view.h"

/* mask: width * height ids of things, from 1; 0: none. */
enum status thing_mask_write(const uint32_t *mask, const struct view *view, const char *path,
                             const struct provenance *prov, struct err *err);
/* The caller frees *mask, which is NULL after a failure. ST_DATA: the size is not the view's; an id above max_id. */
enum status thing_mask_read(uint32_t **mask, const struct view *view, const char *path, uint32_t max_id,
                            struct provenance *prov, struct err *err);

#endif
