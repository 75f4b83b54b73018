/* true_planes.h - ids and depths of true pictures at the pixels of rendered ones. */
#ifndef REMODEL_TRUE_PLANES_H
#define REMODEL_TRUE_PLANES_H

#include "stages/evaluate/scene/evaluation_parts.h"

/* The ids of a true picture at the pixels of a rendered one, nearest; 0 outside. */
enum status true_ids_seen(uint32_t *ids, struct evaluation *e, const char *path, const struct picture_map *map,
                          struct err *err);
/* The same of its depth; 0: outside, or nothing there. */
enum status true_depths_seen(float *depths, struct evaluation *e, const char *path, const struct picture_map *map,
                             struct err *err);

/* The same of its colours, R G B; black outside. */
enum status true_colours_seen(float *rgb, struct evaluation *e, const char *path, const struct picture_map *map,
                              struct err *err);

/* The file of a kind ("ids", "depth", "hdr", "irradiance") of the unedited, furnished scene: of the photo of this name,
 * or of the view that nobody photographed. False: there is none. */
bool true_plain_file(char path[FILE_PATH], const struct evaluation *e, const char *kind, const char *name);

/* True ids and depths of a picture's pixels before and after an edit. {0} is the empty state; everything is owned. */
struct surface_planes {
    uint32_t *ids[2];
    float *depths[2];
};

/* *found is false, and nothing is read, if the truth of the unedited scene or of the edited one (set) lacks ids or
 * depth of the picture of this name. The caller releases p in each case. */
enum status true_planes_read(struct surface_planes *p, bool *found, struct evaluation *e, const struct true_set *set,
                             const char *name, const struct picture_map *map, struct err *err);
void true_planes_release(struct surface_planes *p);

#endif
