/* true_planes.h - ids and depths of true pictures at the pixels of rendered ones. */
#ifndef REMODEL_TRUE_PLANES_H
#define REMODEL_TRUE_PLANES_H

#include "stages/evaluate/evaluation_parts.h"

/* The ids of a true picture at the pixels of a rendered one, nearest; 0 outside. */
enum status true_ids_seen(uint32_t *ids, struct evaluation *e, const char *path, const struct picture_map *map,
                          struct err *err);
/* The same of its depth; 0: outside, or nothing there. */
enum status true_depths_seen(float *depths, struct evaluation *e, const char *path, const struct picture_map *map,
                             struct err *err);

/* The file of a kind ("ids", "depth") of the unedited, furnished scene: of the photo of this name, or of the view that
 * nobody photographed. False: there is none. */
bool true_plain_file(char path[FILE_PATH], const struct evaluation *e, const char *kind, const char *name);

#endif
