/* panorama_name.h - the names of photos that are views cut out of a panorama: PANORAMA_yawN.png, N being the degrees,
 * three digits, by which the view is turned to the right of the panorama's middle.
 *
 * Views are square pinhole pictures of 90 degrees, so that f is half their side. */
#ifndef REMODEL_PANORAMA_NAME_H
#define REMODEL_PANORAMA_NAME_H

#include <stdbool.h>
#include <stddef.h>

#include "common/math/vec.h"

enum { PANORAMA_VIEWS = 6, PANORAMA_STEP = 360 / PANORAMA_VIEWS };

/* The file name of a view; the caller frees it. NULL: out of memory. panorama: its id; view: from 0. */
char *panorama_name_make(const char *panorama, int view);

/* Length of the panorama's id in the name of a view, with or without extension, and the degrees; 0: it is not like that
 * of a view. */
size_t panorama_name_read(int *yaw, const char *name);
/* Whether two names are those of views of one panorama. */
bool panorama_name_same(const char *a, const char *b);
/* view_from_panorama of a view that is turned to the right by these degrees: about the axis that points down. */
struct quat panorama_name_turn(int yaw);

#endif
