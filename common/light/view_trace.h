/* view_trace.h - a view of the solid model: face and depth of each pixel. */
#ifndef REMODEL_VIEW_TRACE_H
#define REMODEL_VIEW_TRACE_H

#include "common/light/model_rays.h"
#include "common/model/model_axes.h"

/* {0} is the empty state. */
struct view_trace {
    const struct model_rays *model;
    struct view view; /* in the model's frame */
    int width, height;
    uint32_t *faces;     /* 1 + index of the face in each pixel; 0: nothing is hit. Owned */
    double (*planes)[3]; /* of each face: its inverse depth in scene units, 1 / z = a u + b v + c. Owned */
    bool in_solid;       /* the camera is inside a solid, or on its surface: faces are 0 */
};

/* view: in the frame of the scene. The model must outlive the trace. */
enum status view_trace(struct view_trace *t, const struct model_rays *model, const struct model_axes *axes,
                       const struct view *view, struct err *err);
void view_trace_release(struct view_trace *t);

static inline double view_trace_inverse_depth(const struct view_trace *t, uint32_t face, double u, double v)
{
    const double *p = t->planes[face - 1];
    return p[0] * u + p[1] * v + p[2];
}

#endif
