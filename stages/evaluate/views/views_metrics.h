/* views_metrics.h - metrics of the rectified views: cameras, depths, radiance, held-out photographs. */
#ifndef REMODEL_VIEWS_METRICS_H
#define REMODEL_VIEWS_METRICS_H

#include "stages/evaluate/scene/evaluation_parts.h"

/* Each group adds its metrics to the table, or a note that says why it has none. Cameras come first: they set
 * `aligned` and truth_from_scene. */
enum status evaluate_cameras(struct evaluation *e, struct err *err);  /* camera.* */
enum status evaluate_depths(struct evaluation *e, struct err *err);   /* depth.* */
enum status evaluate_pictures(struct evaluation *e, struct err *err); /* holdout.* */
enum status evaluate_radiance(struct evaluation *e, struct err *err); /* radiance.*; sets radiance_scale */

#endif
