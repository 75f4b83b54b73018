/* view_layers.c - face and depth of each pixel, as the layers of a view's ids store them. */
#include "stages/trace_ids/view_layers.h"

#include <math.h>

#include "common/base/parallel.h"

enum { ROWS = 16 };

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
