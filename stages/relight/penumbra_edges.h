/* penumbra_edges.h - edges of the quotient that the light before an edit has, too, and what they are found from. */
#ifndef REMODEL_RELIGHT_PENUMBRA_EDGES_H
#define REMODEL_RELIGHT_PENUMBRA_EDGES_H

#include "common/gather/irradiance.h"
#include "stages/relight/quotients.h"

enum { PENUMBRA_MOST_HALF = 20 /* px, half of the widest penumbra */ };

struct edge_point {
    int pixel;
    double x, y;                 /* on the ridge beside its centre */
    double nx, ny;               /* normal, towards more old light */
    double half;                 /* of the penumbra, px */
    double shift, steeper, part; /* the fit: px, how much steeper the photograph's is, how far it is believed */
    bool is_known;               /* it has a profile */
};

/* {0} is the empty state. Everything but `quotient` is owned. */
struct old_edges {
    int width, height;
    int *surface;           /* face of each pixel; -1: none that counts */
    float *photo, *e, *old; /* logarithms: of the photograph, of one over the quotient, of the light before */
    float *smooth_e, *smooth_old;
    struct edge_point *points; /* in order of pixel */
    size_t count;
    size_t *rows; /* first point of each row, and the end */
    float (*quotient)[4];
};

/* Finds the points of all old edges. The parameters are those of penumbra_fit(). The caller releases s, also after an
 * error. */
enum status penumbra_edges_find(struct old_edges *s, float (*quotient)[4], const float (*matt)[3],
                                const struct irradiance *before, const struct pixels *p, struct err *err);
void penumbra_edges_release(struct old_edges *s);

/* A field between pixels; false: not all of the pixels around are of the surface. */
bool penumbra_edges_sample(double *value, const struct old_edges *s, const float *field, int surface, double x,
                           double y);

#endif
