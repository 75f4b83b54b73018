/* texture_metrics.h - metrics of texture atlases. */
#ifndef REMODEL_TEXTURE_METRICS_H
#define REMODEL_TEXTURE_METRICS_H

#include "stages/evaluate/scene/evaluation_parts.h"

/* Each group adds its metrics to the table, or a note that says why it has none. */
enum status evaluate_heldout_textures(struct evaluation *e, struct err *err); /* texture.heldout_* */
enum status evaluate_texture_cover(struct evaluation *e, struct err *err);    /* texture.covered */
enum status evaluate_textures(struct evaluation *e, struct err *err);         /* texture.* */

#endif
