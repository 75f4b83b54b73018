/* traced_model.h - a solid model as rays from true cameras see it. The model is read without its panes of glass: what
 * is behind a window counts. */
#ifndef REMODEL_TRACED_MODEL_H
#define REMODEL_TRACED_MODEL_H

#include "common/light/model_rays.h"
#include "stages/evaluate/scene/model_frame.h"
#include "stages/evaluate/truth/true_set.h"

/* The id of the face name at the centre of each pixel of a true camera, 0 if there is none, and the distance of a true
 * point from that face's plane, in the unit of the truth. points: in the axes of the true camera, {0, 0, 0} unknown;
 * NULL: distances are 0. frame: to the truth's world. ids, distance: as many as the camera's pixels. */
void traced_model_faces(uint32_t *ids, float *distance, const struct model_rays *m, const struct model_frame *frame,
                        const struct true_picture *camera, const struct vec3 *points);

#endif
