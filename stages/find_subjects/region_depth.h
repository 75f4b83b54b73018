/* region_depth.h - the depth of a rectangle in a view. */
#ifndef REMODEL_REGION_DEPTH_H
#define REMODEL_REGION_DEPTH_H

#include "common/film/subject_list.h"
#include "common/layers/layered_depth.h"

/* The median depth of the rectangle's pixels in both layers, weighted by alpha and by their segments' confidence, which
 * counts as DEPTH_INHERITED at least. 0 if no pixel has a depth. */
enum status region_depth(double *depth, const struct layered_depth *d, const struct subject *s, struct err *err);

#endif
