/* model_metrics.h - metrics of the model of the room: axes, walls, faces. */
#ifndef REMODEL_MODEL_METRICS_H
#define REMODEL_MODEL_METRICS_H

#include "stages/evaluate/scene/evaluation_parts.h"

/* Each group adds its metrics to the table, or a note that says why it has none. */
enum status evaluate_axes(struct evaluation *e, struct err *err);         /* axes.* */
enum status evaluate_faces(struct evaluation *e, struct err *err);        /* model.faces, edited.E.faces */
enum status evaluate_walls(struct evaluation *e, struct err *err);        /* model.* */
enum status evaluate_edited_walls(struct evaluation *e, struct err *err); /* edited.E.*, of the models of edits */

#endif
