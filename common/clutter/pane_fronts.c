/* pane_fronts.c - where a room ends before a pane of glass.
 *
 * A pane shows what is outdoors, of which a view knows no depth: the sky takes that of the frame, somewhere between the
 * wall's inner face and the pane. In depth nothing tells it from a vase on the sill. So whatever a view shows at a pane
 * counts as furniture only before the plane of the wall's inner face: the one through the farthest corner, along the
 * pane's normal, of the faces of its opening ("window/sunny/sill" of "glass/sunny/in"). Things on sills are lost: there
 * the shell wins.
 *
 * Source: none. */
#include "common/clutter/pane_fronts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/light/model_rays.h"

#define PANES "glass/"
#define ALONG 1e-6 /* of the pane's offset: planes nearer than this are the pane's own */

/* The NAME of "KIND/NAME/PART". */
static const char *middle(const char *name, size_t *length)
{
    const char *first = strchr(name, '/'), *last = strrchr(name, '/');
    if (!first || last <= first) return NULL;
    *length = (size_t)(last - first - 1);
    return first + 1;
}

static bool is_pane(const struct solid_mesh *m, int face)
{
    return !strncmp(m->bodies[m->faces[face].body].name, PANES, strlen(PANES));
}

/* How far the opening of a pane's face reaches along its normal. */
static double reach_of_opening(const struct solid_mesh *m, int pane)
{
    size_t length, other_length;
    const char *name = middle(solid_face_name(m, pane), &length);
    double reach = m->faces[pane].offset;
    for (int i = 0; name && i < m->face_count; i++) {
        const char *other = middle(solid_face_name(m, i), &other_length);
        if (is_pane(m, i) || !other || other_length != length || strncmp(other, name, length) != 0) continue;
        const int first = m->loops[m->faces[i].loop].half_edge;
        int e = first;
        do {
            reach = fmax(reach, vec3_dot(m->faces[pane].normal, m->vertices[m->half_edges[e].origin].p));
            e = m->half_edges[e].next;
        } while (e != first);
    }
    return reach;
}

static int by_id(const void *a, const void *b)
{
    const struct pane_front *x = a, *y = b;
    return (x->id > y->id) - (x->id < y->id);
}

enum status pane_fronts_find(struct pane_fronts *f, const struct solid_mesh *mesh, struct err *err)
{
    *f = (struct pane_fronts){0};
    if (!mesh) return ST_OK;
    f->list = calloc((size_t)mesh->face_count + 1, sizeof *f->list);
    if (!f->list) return err_nomem(err, "the panes of a model", (size_t)mesh->face_count * sizeof *f->list);
    for (int i = 0; i < mesh->face_count; i++) {
        if (!is_pane(mesh, i)) continue;
        const double reach = reach_of_opening(mesh, i), offset = mesh->faces[i].offset;
        if (!(reach > offset + ALONG * fmax(1, fabs(offset)))) continue;
        struct pane_front *front = &f->list[f->count++];
        *front = (struct pane_front){solid_face_id(mesh, i), mesh->faces[i]};
        front->plane.offset = reach;
    }
    qsort(f->list, (size_t)f->count, sizeof *f->list, by_id);
    return ST_OK;
}

void pane_fronts_release(struct pane_fronts *f)
{
    if (!f) return;
    free(f->list);
    *f = (struct pane_fronts){0};
}

static void bring_forward(struct view_ids *ids, const struct pane_front *front, const struct view *view, double scale)
{
    double plane[3];
    model_face_inverse_depth(plane, &front->plane, view);
    for (int y = 0; y < ids->height; y++)
        for (int x = 0; x < ids->width; x++) {
            const size_t i = (size_t)y * (size_t)ids->width + (size_t)x;
            const double inverse = (plane[0] * (x + 0.5) + plane[1] * (y + 0.5) + plane[2]) * scale;
            if (ids->id[i] == (uint32_t)front->id && inverse * (double)ids->z[i] > 1) ids->z[i] = (float)(1 / inverse);
        }
}

void pane_fronts_apply(struct view_ids *ids, const struct pane_fronts *f, const struct view *view, double scale)
{
    for (int i = 0; i < f->count; i++) bring_forward(ids, &f->list[i], view, scale);
}
