/* model_prior.c - the faces of the solid model as what segments are expected to lie on, and what may stand before them.
 *
 * A segment is expected on the face that the ray of its middle pixel meets first. Panes of glass show what is behind
 * the model, so that nothing is expected there; faces on one plane count as one. A model may have walls without a room:
 * then a ray that meets no face ends on the floor, which is at 0, or on the ceiling, which is where the highest wall
 * ends, if this is within the plan of the walls.
 *
 * Evidence beats the model: a segment costs its gain less on its face, and less so the surer its depth was before. What
 * then stands off its face is judged in before_model.c. */
#include "stages/segment_depth/model_prior.h"

#include <math.h>
#include <stdlib.h>

#include "common/math/numbers.h"

#define SAME_PLANE 1e-3 /* part of a plane's normal by which faces on one plane may differ */
#define SURE_PART  0.75 /* part of the gain that a sure depth before takes away */

static int candidate_of(struct prior_candidate *list, int *count, struct vec3 normal)
{
    for (int k = 0; k < *count; k++)
        if (vec3_length(vec3_sub(list[k].normal, normal)) <= SAME_PLANE * vec3_length(normal)) return k;
    list[*count] = (struct prior_candidate){normal, 0};
    return (*count)++;
}

/* The box of the model. */
struct extent {
    struct vec3 low, high;
};

static struct extent extent_of(const struct solid_mesh *mesh)
{
    struct extent e = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int i = 0; i < mesh->vertex_count; i++) {
        const struct vec3 p = mesh->vertices[i].p;
        e.low = vec3_make(fmin(e.low.x, p.x), fmin(e.low.y, p.y), fmin(e.low.z, p.z));
        e.high = vec3_make(fmax(e.high.x, p.x), fmax(e.high.y, p.y), fmax(e.high.z, p.z));
    }
    return e;
}

/* Whether the ray of a pixel ends on the floor or the ceiling of walls that have no room; *normal: of that plane. */
static bool meets_level(struct vec3 *normal, const struct view_trace *t, const struct extent *e, double scale, double u,
                        double v)
{
    const struct view *view = &t->view;
    const struct vec3 ray = vec3_make((u - view->cx) / view->fx, (v - view->cy) / view->fy, 1),
                      up = mat3_apply(view->cam_from_world, vec3_make(0, 0, 1));
    const double rise = vec3_dot(up, ray), height = view->center.z;
    const double off = rise > 0 ? e->high.z - height : -height; /* of the level from the camera */
    if (t->in_solid || !(off * rise > 0)) return false;
    const struct vec3 at = view_unproject(view, u, v, off / rise);
    *normal = vec3_scale(up, scale / off);
    return at.x > e->low.x && at.x < e->high.x && at.y > e->low.y && at.y < e->high.y;
}

enum status model_prior_make(struct plane_prior *prior, const struct view_trace *t, double scale,
                             const struct view *view, const struct segmentation *s, struct err *err)
{
    const struct solid_mesh *mesh = &t->model->mesh;
    const struct extent extent = extent_of(mesh);
    struct prior_candidate *candidates = calloc((size_t)mesh->face_count + 2, sizeof *candidates);
    int count = 0;
    if (candidates)
        plane_prior_init(prior, s->count, err);
    else
        err_nomem(err, "expected planes", (size_t)mesh->face_count * sizeof *candidates);
    for (int i = 0; !err->status && i < s->count; i++) {
        const struct segment *g = &s->segments[i];
        const uint32_t face = t->faces[s->pixel[g->first + g->pixels / 2]];
        struct vec3 normal;
        if (face) {
            const double *plane = t->planes[face - 1];
            if (solid_face_is_pane(mesh, (int)face - 1)) continue;
            normal = plane_normal(view, (struct plane){plane[0], plane[1], plane[2]});
        } else if (!meets_level(&normal, t, &extent, scale, g->cx, g->cy))
            continue;
        const int k = prior->expected[i] = candidate_of(candidates, &count, normal);
        candidates[k].pixels += g->pixels;
    }
    if (!err->status) plane_prior_keep(prior, candidates, count, view, s, err);
    free(candidates);
    return err->status;
}

void model_prior_weigh(struct plane_prior *prior, double gain, const double *sure, const struct segmentation *s)
{
    for (int i = 0; i < s->count; i++) prior->gain[i] = (float)(gain * (1 - SURE_PART * clamp(sure[i], 0, 1)));
}
