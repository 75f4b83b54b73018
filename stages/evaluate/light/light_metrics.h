/* light_metrics.h - metrics of light: irradiance, relit pictures and films. */
#ifndef REMODEL_LIGHT_METRICS_H
#define REMODEL_LIGHT_METRICS_H

#include "stages/evaluate/scene/evaluation_parts.h"

/* Each group adds its metrics to the table, or a note that says why it has none. */
enum status evaluate_films(struct evaluation *e, struct err *err);      /* edited.E.flicker* */
enum status evaluate_irradiance(struct evaluation *e, struct err *err); /* irradiance.* */
enum status evaluate_relit(struct evaluation *e, struct err *err);      /* edited.E.relit_*, edited.E.unlit_psnr */

#endif
