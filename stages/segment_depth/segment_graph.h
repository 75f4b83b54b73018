/* segment_graph.h - segments and the borders between them, from a label per pixel. */
#ifndef REMODEL_SEGMENT_GRAPH_H
#define REMODEL_SEGMENT_GRAPH_H

#include "stages/segment_depth/oversegment.h"

/* Renumbers s->label (any numbers below w * h, -1: none) from 0 in raster order of each segment's first pixel, and
 * fills the rest of s but for its size. lab: colours of the pixels; NULL: none are wanted. ST_NOMEM; the caller
 * releases s also after a failure. */
enum status segment_graph_make(struct segmentation *s, float *const lab[3], struct err *err);

/* The same of labels that are numbered from 0 to s->count - 1 already, each of at least one pixel. */
enum status segment_graph_of_numbers(struct segmentation *s, float *const lab[3], struct err *err);

#endif
