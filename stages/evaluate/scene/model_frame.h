/* model_frame.h - from the model's frame into the truth: by model/axes.txt and the similarity of the cameras. */
#ifndef REMODEL_MODEL_FRAME_H
#define REMODEL_MODEL_FRAME_H

#include "common/model/model_axes.h"
#include "stages/evaluate/scene/evaluation_parts.h"

struct model_frame {
    struct model_axes axes;
    struct similarity truth_from_scene;
    struct mat3 room_from_world; /* from the truth's world to the frame that is wanted */
    struct vec3 origin;          /* of that frame, in the truth's world */
};

/* Reads model/axes.txt, which becomes an input. The cameras must be aligned. ST_DATA: a damaged file or none. */
enum status model_frame_read(struct model_frame *f, struct evaluation *e, struct mat3 room_from_world,
                             struct vec3 origin, struct err *err);

struct vec3 truth_from_model_point(const struct model_frame *f, struct vec3 p);
struct vec3 model_from_truth_point(const struct model_frame *f, struct vec3 p);
/* Rotated, not scaled. */
struct vec3 model_from_truth_direction(const struct model_frame *f, struct vec3 d);
double model_frame_truth_per_unit(const struct model_frame *f);

#endif
