/* view_trace.c - which face of the model each pixel of a view shows, and how far it is.
 *
 * One ray through the centre of each pixel finds the face (common/light/model_rays.h). Its depth is that of the face's
 * plane, in double precision, and so the same for all the triangles that the face was cut into. A ray through an edge
 * that faces share is given to either of them.
 *
 * A camera inside a solid, or on its surface, sees the solid from within: whatever its rays hit would be wrong. Such a
 * view shows nothing. */
#include "common/light/view_trace.h"

#include <stdlib.h>

#include "common/light/model_clearance.h"

enum status view_trace(struct view_trace *t, const struct model_rays *model, const struct model_axes *axes,
                       const struct view *view, struct err *err)
{
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    *t = (struct view_trace){.model = model, .view = model_from_world_view(axes, view)};
    t->width = view->width;
    t->height = view->height;
    t->faces = calloc(pixels, sizeof *t->faces);
    t->planes = calloc((size_t)model->mesh.face_count + 1, sizeof *t->planes);
    if (!t->faces || !t->planes) {
        view_trace_release(t);
        return err_nomem(err, "a view of the model", pixels * sizeof *t->faces);
    }
    for (int i = 0; i < model->mesh.face_count; i++) {
        model_face_inverse_depth(t->planes[i], &model->mesh.faces[i], &t->view);
        for (int k = 0; k < 3; k++) t->planes[i][k] *= axes->scale;
    }
    t->in_solid = model_rays_enclose(model, t->view.center);
    if (!t->in_solid) model_rays_view(t->faces, model, &t->view);
    return ST_OK;
}

void view_trace_release(struct view_trace *t)
{
    if (!t) return;
    free(t->faces);
    free(t->planes);
    *t = (struct view_trace){0};
}
