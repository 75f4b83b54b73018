/* unite.c - the union of convex solids as closed half-edge meshes.
 *
 * borders_find() returns the borders of the surface in each plane: segments of lines with the surface on their left.
 * They are cut where they meet, paired to edges and linked to loops (unite_edges.c); the loops become faces with holes
 * and names (unite_faces.c); a few edges are split, so that a mesh can have them (unite_split.c). The faces of all
 * bodies are then one list of polygons.
 *
 * docs/decisions/0015 explains why each step is exact. */
#include "stages/build_model/solid/unite.h"

#include <math.h>
#include <stdlib.h>

#include "stages/build_model/solid/unite_internal.h"

struct polygon_soup { /* the faces of all bodies as polygons, with offsets instead of pointers */
    struct vec3 *vertices;
    struct solid_polygon *polygons;
    int *corners, *sizes;
    size_t *at; /* of each polygon in corners, in sizes */
    int vertex_count, vertex_capacity, polygon_count, polygon_capacity, corner_count, corner_capacity, size_count;
    int size_capacity, at_capacity;
};

/* ---------------------------------------------------------------------------------------------------------- result */

struct face_order {
    int name, face;
};

static int compare_faces(const void *a, const void *b)
{
    const struct face_order *p = a, *q = b;
    if (p->name != q->name) return p->name < q->name ? -1 : 1;
    return (p->face > q->face) - (p->face < q->face);
}

static enum status add_loop(struct body_union *j, struct polygon_soup *r, int loop, int *vertex, struct err *err)
{
    const int first = j->loops[loop].half;
    int h = first, count = 0;
    do {
        int *v = &vertex[j->halves[h].vertex];
        if (*v < 0) {
            double p[3];
            if (exact_grow(&r->vertices, &r->vertex_capacity, r->vertex_count + 1, sizeof *r->vertices, err))
                return err->status;
            unite_half_position(j, h, p);
            /* divided, so that 2700000 becomes the double 2.7; + 0 removes negative zeros */
            r->vertices[r->vertex_count] = vec3_make(p[0] / 1e6 + 0., p[1] / 1e6 + 0., p[2] / 1e6 + 0.);
            *v = r->vertex_count++;
        }
        if (exact_grow(&r->corners, &r->corner_capacity, r->corner_count + 1, sizeof *r->corners, err))
            return err->status;
        r->corners[r->corner_count++] = *v;
        count++;
        h = j->halves[h].next;
    } while (h != first);
    if (exact_grow(&r->sizes, &r->size_capacity, r->size_count + 1, sizeof *r->sizes, err)) return err->status;
    r->sizes[r->size_count++] = count;
    return ST_OK;
}

static enum status add_result(struct body_union *j, struct polygon_soup *r, const char *body, const char *const *names,
                              struct err *err)
{
    struct face_order *order = malloc(((size_t)j->face_count + 1) * sizeof *order);
    int *vertex = malloc(((size_t)j->vertex_count + 1) * sizeof *vertex);
    int *hole_first = calloc((size_t)j->face_count + 2, sizeof *hole_first);
    int *holes = malloc(((size_t)j->loop_count + 1) * sizeof *holes);
    if (!order || !vertex || !hole_first || !holes)
        err_nomem(err, "faces of a union", (size_t)j->vertex_count * sizeof *vertex);
    if (!err->status) {
        for (int i = 0; i < j->vertex_count; i++) vertex[i] = -1;
        for (int i = 0; i < j->face_count; i++) order[i] = (struct face_order){j->faces[i].name, i};
        qsort(order, (size_t)j->face_count, sizeof *order, compare_faces);
        for (int i = 0; i < j->face_count; i++) hole_first[i + 2] = hole_first[i + 1] + j->faces[i].holes;
        for (int i = 0; i < j->loop_count; i++)
            if (j->loops[i].hole) holes[hole_first[j->loops[i].face + 1]++] = i;
    }
    for (int i = 0; !err->status && i < j->face_count; i++) {
        const struct union_face *f = &j->faces[order[i].face];
        const struct exact_plane *p = &j->set.space.planes[f->plane];
        const double n[3] = {(double)(p->n[0] * f->side), (double)(p->n[1] * f->side), (double)(p->n[2] * f->side)};
        const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (exact_grow(&r->polygons, &r->polygon_capacity, r->polygon_count + 1, sizeof *r->polygons, err) ||
            exact_grow(&r->at, &r->at_capacity, 2 * r->polygon_count + 2, sizeof *r->at, err))
            break;
        r->at[2 * r->polygon_count] = (size_t)r->corner_count;
        r->at[2 * r->polygon_count + 1] = (size_t)r->size_count;
        r->polygons[r->polygon_count++] = (struct solid_polygon){
            .name = names[f->name],
            .body = body,
            .normal = vec3_make(n[0] / length + 0., n[1] / length + 0., n[2] / length + 0.),
            .offset = (double)(p->d * f->side) / length / 1e6 + 0.,
            .loops = 1 + f->holes,
        };
        add_loop(j, r, f->loop, vertex, err);
        for (int k = hole_first[order[i].face]; !err->status && k < hole_first[order[i].face + 1]; k++)
            add_loop(j, r, holes[k], vertex, err);
    }
    free(order);
    free(vertex);
    free(hole_first);
    free(holes);
    return err->status;
}

static void joined_release(struct body_union *j)
{
    convex_set_release(&j->set);
    border_set_release(&j->borders);
    free(j->halves);
    free(j->loops);
    free(j->faces);
}

/* Unites the solids of one body: list->solids[members[0 .. count)]. half_space_of: first half-space of each solid. */
static enum status unite_body(struct polygon_soup *r, const struct solid_list *list, const int *members, int count,
                              const size_t *half_space_of, const struct lattice_half_space *half_spaces,
                              const struct name_table *names, struct merges *merges, struct err *err)
{
    struct body_union j = {0};
    const struct solid *first = &list->solids[members[0]];
    for (int i = 0; !err->status && i < count; i++) {
        const size_t at = half_space_of[members[i]];
        convex_set_add(&j.set, &list->solids[members[i]], &half_spaces[at], &names->rank[at], err);
    }
    if (!err->status && !borders_find(&j.borders, &j.set, names->room, err) && !unite_make_halves(&j, first, err))
        unite_link_halves(&j, first, err);
    int *loop_of_border = malloc(((size_t)j.borders.border_count + 1) * sizeof *loop_of_border);
    if (!err->status && !loop_of_border) err_nomem(err, "faces of a union", (size_t)j.borders.border_count);
    if (!err->status) {
        for (int i = 0; i < j.half_count; i++) loop_of_border[j.halves[i].border] = j.halves[i].loop;
        unite_make_vertices(&j);
        unite_make_faces(&j, loop_of_border, merges, names, first, err);
    }
    if (!err->status && !unite_split_edges(&j, err)) add_result(&j, r, first->body, names->texts, err);
    free(loop_of_border);
    joined_release(&j);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------- whole lists */

void unite_log_release(struct unite_log *log)
{
    if (!log) return;
    free(log->notes);
    *log = (struct unite_log){0};
}

enum status unite_solids(struct solid_mesh *mesh, const struct solid_list *solids, struct unite_log *log,
                         struct err *err)
{
    const size_t n = (size_t)solids->count;
    struct lattice_half_space *half_spaces = NULL;
    struct name_table names = {0};
    struct merges merges = {0};
    struct polygon_soup r = {0};
    int *body = malloc((n + 1) * sizeof *body), *members = malloc((n + 1) * sizeof *members), bodies = 0;
    int *first = calloc(n + 2, sizeof *first);
    size_t *half_space_of = malloc((n + 1) * sizeof *half_space_of), at = 0;
    if (!body || !members || !first || !half_space_of) err_nomem(err, "solids", n * sizeof *body);

    if (!err->status && !convex_half_spaces(&half_spaces, solids, err))
        unite_rank_names(&names, body, &bodies, solids, err);
    if (!err->status) {
        for (int i = 0; i < solids->count; at += (size_t)solids->solids[i++].count) {
            half_space_of[i] = at;
            first[body[i] + 2]++;
        }
        for (int i = 0; i < bodies; i++) first[i + 2] += first[i + 1];
        for (int i = 0; i < solids->count; i++) members[first[body[i] + 1]++] = i;
    }
    for (int i = 0; !err->status && i < bodies; i++)
        unite_body(&r, solids, &members[first[i]], first[i + 1] - first[i], half_space_of, half_spaces, &names, &merges,
                   err);
    for (int i = 0; !err->status && i < r.polygon_count; i++) {
        r.polygons[i].corners = r.corners + r.at[2 * i];
        r.polygons[i].sizes = r.sizes + r.at[2 * i + 1];
    }
    if (!err->status) solid_mesh_make(mesh, r.vertices, r.vertex_count, r.polygons, r.polygon_count, NULL, err);
    if (!err->status && log) unite_write_log(log, &merges, &names, err);
    if (err->status) {
        solid_mesh_release(mesh);
        if (log) unite_log_release(log);
    }
    free(half_spaces);
    free(names.texts);
    free(names.rank);
    free(names.room);
    free(names.present);
    free(merges.merges);
    free(r.vertices);
    free(r.polygons);
    free(r.corners);
    free(r.sizes);
    free(r.at);
    free(body);
    free(members);
    free(first);
    free(half_space_of);
    return err->status;
}
