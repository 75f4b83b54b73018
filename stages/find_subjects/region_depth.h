/* region_depth.h - how far away what a rectangle of a view shows is. */
#ifndef REMODEL_REGION_DEPTH_H
#define REMODEL_REGION_DEPTH_H

#include "common/film/subject_list.h"
#include "common/layers/layered_depth.h"

/* Clips the subject's rectangle to the picture; false if nothing is left. */
bool clip_to_picture(struct subject *s, int width, int height);

/* The median depth of the pixels in the rectangle, of both layers, weighted by what they cover and by their segments'
 * confidence (which counts as DEPTH_INHERITED at least: a guess is better than nothing). 0: no pixel has a depth. */
enum status region_depth(double *depth, const struct layered_depth *d, const struct subject *s, struct err *err);

#endif
