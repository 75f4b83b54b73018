/* sfm_model_parts.h - what the readers of COLMAP's and Bundler's formats share. Not for other modules. */
#ifndef REMODEL_SFM_MODEL_PARTS_H
#define REMODEL_SFM_MODEL_PARTS_H

#include <stdbool.h>
#include <stddef.h>

#include "common/capture/sfm_ids.h"
#include "common/capture/sfm_model.h"

/* array_append() for counts of type int. ST_DATA: the array is full. */
enum status sfm_append(void *array, int count, size_t item_size, const char *what, struct err *err);

/* Frees the unused capacity of a finished array; returns its new address. */
void *sfm_shrink(void *array, int count, size_t item_size);

/* Normalises the quaternion. One that is of length 1 up to rounding keeps its bits, so that writing and reading changes
 * nothing. False: its length is 0 or not finite. */
bool sfm_normalize_rotation(struct quat *q);

/* Sorts the images by name and adapts the tracks. *old_idx: for each image its former index; the caller frees it. The
 * order of images with equal names is kept. */
enum status sfm_sort_images(struct sfm_model *m, int **old_idx, struct err *err);

/* Sorts the points by id, as they are in the list. ST_DATA: an id is there twice. */
enum status sfm_sort_points(struct sfm_model *m, struct id_list *ids, const char *path, struct err *err);

/* Gives the point a copy of a track. */
enum status sfm_set_track(struct sfm_point *p, const struct sfm_track *track, int count, struct err *err);

#endif
