/* view_trace.c - which face of the model each pixel of a view shows, and how far it is.
 *
 * One ray through the centre of each pixel finds the face (common/light/model_rays.h). Its depth is that of the face's
 * plane, in double precision, and so the same for all the triangles that the face was cut into. A ray through an edge
 * that faces share is given to either of them.
 *
 * A camera inside a solid, or on its surface, sees the solid from within: whatever its rays hit would be wrong. Such a
 * view shows nothing. */
#include "stages/trace_ids/view_trace.h"

#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/light/model_clearance.h"

enum { ROWS = 16 };

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

struct ids_job {
    struct view_ids *ids;
    const struct view_trace *trace;
};

static void fill_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct ids_job *job = ctx;
    const struct view_trace *t = job->trace;
    const size_t width = (size_t)t->width;
    (void)thread;
    for (size_t i = begin * width; i < end * width; i++) {
        const uint32_t face = t->faces[i];
        job->ids->id[i] = 0;
        job->ids->z[i] = 0;
        if (!face) continue;
        const float z =
            (float)(1 / view_trace_inverse_depth(t, face, (double)(i % width) + 0.5, (double)(i / width) + 0.5));
        if (!(z > 0 && isfinite(z))) continue; /* a plane through the camera, but for rounding */
        job->ids->id[i] = (uint32_t)solid_face_id(&t->model->mesh, (int)face - 1);
        job->ids->z[i] = z;
    }
}

void view_trace_ids(struct view_ids *ids, const struct view_trace *t)
{
    struct ids_job job = {ids, t};
    parallel_for((size_t)t->height, ROWS, fill_rows, &job);
}
