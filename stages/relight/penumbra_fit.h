/* penumbra_fit.h - shift and width of old edges as the photograph has them. */
#ifndef REMODEL_RELIGHT_PENUMBRA_FIT_H
#define REMODEL_RELIGHT_PENUMBRA_FIT_H

#include "stages/relight/penumbra_edges.h"

/* Sets shift, steeper, half and part of all points. most: px of shift, 1 to 16. Same bits for any number of threads. */
enum status penumbra_fit_points(struct old_edges *s, int most, struct err *err);

/* Where across an edge the quotient is that belongs to t, px along its normal. */
double penumbra_fit_moved(const struct edge_point *p, double t, double shift, double steeper);

#endif
