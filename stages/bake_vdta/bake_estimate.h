/* bake_estimate.h - time, memory and bytes that viewpoints will take, before they are baked. */
#ifndef REMODEL_BAKE_ESTIMATE_H
#define REMODEL_BAKE_ESTIMATE_H

#include <stdio.h>

#include "common/base/work_estimate.h"
#include "stages/bake_vdta/bake_viewpoint.h"

/* Adds what the viewpoint of a photo takes, on one core of the machine on which the constants were measured. ST_USAGE:
 * there is no such photo. */
enum status estimate_viewpoint(struct work_estimate *w, const struct bake_scene *scene, const char *photo,
                               struct err *err);

/* Prints a sentence, and the line of common/base/work_estimate.h, for the photos in `list`: a file with one a line. */
enum status estimate_print(FILE *to, const char *list, const struct bake_scene *scene, struct err *err);

#endif
