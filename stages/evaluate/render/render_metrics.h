/* render_metrics.h - metrics of rendered pictures. */
#ifndef REMODEL_RENDER_METRICS_H
#define REMODEL_RENDER_METRICS_H

#include "stages/evaluate/scene/evaluation_parts.h"

/* Each group adds its metrics to the table, or a note that says why it has none. */
enum status evaluate_renders(struct evaluation *e, struct err *err);  /* novel.*, edited.E.* */
enum status evaluate_revealed(struct evaluation *e, struct err *err); /* edited.E.revealed* */
enum status evaluate_shell(struct evaluation *e, struct err *err);    /* shell.* */

#endif
