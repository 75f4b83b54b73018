/* solid_mesh.c - makes meshes from polygons; names and ids, volume and area.
 *
 * A mesh of half-edges: a loop is a ring of half-edges around a face or one of its holes, a half-edge knows its
 * origin, its successor and predecessor in the loop, and its twin, the same edge in the neighbouring face.
 * Everything is an index into an array, in the order of the polygons.
 *
 * solid_mesh_make() accepts exactly the closed, oriented 2-manifolds:
 *   - each directed edge occurs once (a hash table of edges finds a second one)
 *   - each has a twin in the opposite direction, so no edge is open and no two faces disagree on the inside
 *   - the half-edges that leave a vertex form one fan. Where two fans touch at a point, walking from twin to twin
 *     reaches only a part of them, which the count shows; the caller must give each fan its own vertex
 *   - vertices belong to one body
 * solid_check.c adds what needs coordinates: planarity, self-intersection. All is O(n) on average, with hash tables
 * of twice the size.
 *
 * Ids. A name keeps its id over edits: solid_mesh_carry_ids() gives names of the base their ids there, and new names
 * ids beyond all that the base used, in order of appearance. Names are sorted by id.
 *
 * Area and volume are sums of cross products. Twice the vector area of a loop is the sum of a x b over its edges,
 * taken from a point of the loop, because products of coordinates far from the origin would cancel; holes have the
 * opposite sign. The volume of a body is the sum over its faces of area times distance from an origin, over 3. */
#include "common/model/solid_mesh.h"
#include "common/base/hash.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

void solid_mesh_release(struct solid_mesh *mesh)
{
    if (!mesh) return;
    for (int i = 0; i < mesh->body_count; i++) free(mesh->bodies[i].name);
    for (int i = 0; i < mesh->name_count; i++) free(mesh->names[i].name);
    free(mesh->vertices);
    free(mesh->half_edges);
    free(mesh->loops);
    free(mesh->faces);
    free(mesh->bodies);
    free(mesh->names);
    *mesh = (struct solid_mesh){0};
}

/* ---------------------------------------------------------------------------------------------------------- tables */

static uint64_t hash_edge(int from, int to)
{
    uint64_t h = ((uint64_t)(unsigned)from << 32 | (unsigned)to) * 0x9e3779b97f4a7c15u;
    return h ^ (h >> 29);
}

static unsigned table_size(int count)
{
    unsigned size = 16;
    while (size < 2 * (unsigned)count + 2) size *= 2;
    return size;
}

static int *table_make(unsigned size)
{
    int *slots = malloc(size * sizeof *slots);
    for (unsigned i = 0; slots && i < size; i++) slots[i] = -1;
    return slots;
}

/* The slot of a name, or the free one where it would be stored. */
static unsigned name_slot(const struct solid_mesh *mesh, const int *slots, unsigned size, const char *name)
{
    unsigned at = (unsigned)hash_text(name) & (size - 1);
    while (slots[at] >= 0 && strcmp(mesh->names[slots[at]].name, name)) at = (at + 1) & (size - 1);
    return at;
}

static unsigned body_slot(const struct solid_mesh *mesh, const int *slots, unsigned size, const char *name)
{
    unsigned at = (unsigned)hash_text(name) & (size - 1);
    while (slots[at] >= 0 && strcmp(mesh->bodies[slots[at]].name, name)) at = (at + 1) & (size - 1);
    return at;
}

static int destination(const struct solid_mesh *mesh, int half_edge)
{
    return mesh->half_edges[mesh->half_edges[half_edge].next].origin;
}

static unsigned edge_slot(const struct solid_mesh *mesh, const int *slots, unsigned size, int from, int to)
{
    unsigned at = (unsigned)hash_edge(from, to) & (size - 1);
    while (slots[at] >= 0 && (mesh->half_edges[slots[at]].origin != from || destination(mesh, slots[at]) != to))
        at = (at + 1) & (size - 1);
    return at;
}

/* ---------------------------------------------------------------------------------------------------------- making */

static int face_of(const struct solid_mesh *mesh, int half_edge)
{
    return mesh->loops[mesh->half_edges[half_edge].loop].face;
}

static bool finite3(struct vec3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

struct maker {
    struct solid_mesh *mesh;
    int *names, *bodies, *edges; /* hash tables */
    unsigned name_size, body_size, edge_size;
    int *faulty;
};

#define FAULT(m, i, polygon, ...)                            \
    (*(m)->faulty = (i), err_set(err, ST_DATA, __VA_ARGS__), \
     err_context(err, "face %d, %s", (i) + 1, (polygon)->name ? (polygon)->name : "(none)"))

static enum status add_name(struct maker *m, const char *name, int *index, struct err *err)
{
    struct solid_mesh *mesh = m->mesh;
    const unsigned at = name_slot(mesh, m->names, m->name_size, name);
    *index = m->names[at];
    if (*index >= 0) return ST_OK;
    struct solid_name n = {strdup(name), mesh->name_count + 1};
    if (!n.name) return err_nomem(err, "a face's name", strlen(name));
    mesh->names[mesh->name_count] = n;
    *index = m->names[at] = mesh->name_count++;
    return ST_OK;
}

static enum status add_body(struct maker *m, int i, const struct solid_polygon *p, int *index, struct err *err)
{
    struct solid_mesh *mesh = m->mesh;
    const int last = mesh->body_count - 1;
    if (last >= 0 && !strcmp(mesh->bodies[last].name, p->body)) {
        *index = last;
        mesh->bodies[last].faces++;
        return ST_OK;
    }
    const unsigned at = body_slot(mesh, m->bodies, m->body_size, p->body);
    if (m->bodies[at] >= 0)
        return FAULT(m, i, p, "found body %s a second time, wanted its faces to be contiguous.", p->body);
    struct solid_body b = {strdup(p->body), mesh->face_count, 1};
    if (!b.name) return err_nomem(err, "a body's name", strlen(p->body));
    mesh->bodies[mesh->body_count] = b;
    *index = m->bodies[at] = mesh->body_count++;
    return ST_OK;
}

static enum status add_polygon(struct maker *m, int i, const struct solid_polygon *p, int *of_body, struct err *err)
{
    struct solid_mesh *mesh = m->mesh;
    struct solid_face f = {.normal = p->normal, .offset = p->offset, .loop = mesh->loop_count, .loops = p->loops};
    if (!p->name || !*p->name || !p->body || !*p->body) return FAULT(m, i, p, "found an empty name, wanted one.");
    if (p->loops < 1) return FAULT(m, i, p, "found no loop, wanted at least the outer one.");
    if (!finite3(p->normal) || !isfinite(p->offset)) return FAULT(m, i, p, "found a plane that is not finite.");
    if (fabs(vec3_length(p->normal) - 1) > 1e-6)
        return FAULT(m, i, p, "found a normal of length %.9g, wanted 1.", vec3_length(p->normal));
    if (add_name(m, p->name, &f.name, err) || add_body(m, i, p, &f.body, err)) return err->status;
    const int *corner = p->corners;
    for (int k = 0; k < p->loops; corner += p->sizes[k++]) {
        const int first = mesh->half_edge_count, n = p->sizes[k];
        if (n < 3) return FAULT(m, i, p, "found a loop of %d corners, wanted 3 or more.", n);
        for (int c = 0; c < n; c++) {
            const int v = corner[c];
            if (v < 0 || v >= mesh->vertex_count)
                return FAULT(m, i, p, "found vertex %d, wanted one from 0 to %d.", v, mesh->vertex_count - 1);
            if (v == corner[(c + 1) % n]) return FAULT(m, i, p, "found vertex %d twice in a row, wanted it once.", v);
            if (of_body[v] < 0) of_body[v] = f.body;
            if (of_body[v] != f.body)
                return FAULT(m, i, p, "found vertex %d of body %s, wanted a vertex of body %s alone.", v,
                             mesh->bodies[of_body[v]].name, p->body);
            mesh->vertices[v].half_edge = first + c;
            mesh->half_edges[first + c] = (struct solid_half_edge){.origin = v,
                                                                   .next = first + (c + 1) % n,
                                                                   .prev = first + (c + n - 1) % n,
                                                                   .twin = -1,
                                                                   .loop = mesh->loop_count};
        }
        mesh->half_edge_count += n;
        for (int h = first; h < mesh->half_edge_count; h++) {
            const int from = mesh->half_edges[h].origin, to = destination(mesh, h);
            const unsigned at = edge_slot(mesh, m->edges, m->edge_size, from, to);
            if (m->edges[at] >= 0)
                return FAULT(m, i, p, "found the edge from vertex %d to vertex %d a second time, wanted it once.", from,
                             to);
            m->edges[at] = h;
        }
        mesh->loops[mesh->loop_count++] = (struct solid_loop){first, mesh->face_count};
    }
    mesh->faces[mesh->face_count++] = f;
    return ST_OK;
}

static enum status pair_edges(struct maker *m, const struct solid_polygon *polygons, struct err *err)
{
    struct solid_mesh *mesh = m->mesh;
    for (int h = 0; h < mesh->half_edge_count; h++) {
        struct solid_half_edge *e = &mesh->half_edges[h];
        const int from = e->origin, to = destination(mesh, h), i = face_of(mesh, h);
        e->twin = m->edges[edge_slot(mesh, m->edges, m->edge_size, to, from)];
        if (e->twin < 0)
            return FAULT(m, i, &polygons[i],
                         "found the edge from vertex %d to vertex %d, but no face has its opposite, wanted one.", from,
                         to);
    }
    return ST_OK;
}

/* Checks that all half-edges that leave a vertex belong to one fan. */
static enum status one_fan_each(struct maker *m, const struct solid_polygon *polygons, int *leaving, struct err *err)
{
    struct solid_mesh *mesh = m->mesh;
    for (int v = 0; v < mesh->vertex_count; v++) leaving[v] = 0;
    for (int h = 0; h < mesh->half_edge_count; h++) leaving[mesh->half_edges[h].origin]++;
    for (int v = 0; v < mesh->vertex_count; v++) {
        if (!leaving[v]) return err_set(err, ST_DATA, "vertex %d belongs to no face, wanted three or more.", v);
        int h = mesh->vertices[v].half_edge, count = 0;
        const int i = face_of(mesh, h);
        do {
            h = mesh->half_edges[mesh->half_edges[h].prev].twin;
            count++;
        } while (h != mesh->vertices[v].half_edge);
        if (count != leaving[v])
            return FAULT(m, i, &polygons[i],
                         "found %d faces around vertex %d and %d more that touch there, wanted a separate vertex for "
                         "those.",
                         count, v, leaving[v] - count);
    }
    return ST_OK;
}

enum status solid_mesh_make(struct solid_mesh *mesh, const struct vec3 *vertices, int vertex_count,
                            const struct solid_polygon *polygons, int count, int *faulty, struct err *err)
{
    int64_t corners = 0, loops = 0;
    int unused;
    if (!faulty) faulty = &unused;
    *faulty = -1;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < polygons[i].loops; k++, loops++)
            corners += polygons[i].sizes[k] > 0 ? polygons[i].sizes[k] : 0;
    if (corners > INT_MAX / 8) return err_nomem(err, "a mesh", (size_t)corners * sizeof *mesh->half_edges);
    struct maker m = {.mesh = mesh,
                      .name_size = table_size(count),
                      .body_size = table_size(count),
                      .edge_size = table_size((int)corners),
                      .faulty = faulty};
    m.names = table_make(m.name_size);
    m.bodies = table_make(m.body_size);
    m.edges = table_make(m.edge_size);
    int *of_vertex = malloc(((size_t)vertex_count + 1) * sizeof *of_vertex);
    mesh->vertices = calloc((size_t)vertex_count + 1, sizeof *mesh->vertices);
    mesh->half_edges = calloc((size_t)corners + 1, sizeof *mesh->half_edges);
    mesh->loops = calloc((size_t)loops + 1, sizeof *mesh->loops);
    mesh->faces = calloc((size_t)count + 1, sizeof *mesh->faces);
    mesh->bodies = calloc((size_t)count + 1, sizeof *mesh->bodies);
    mesh->names = calloc((size_t)count + 1, sizeof *mesh->names);
    if (!m.names || !m.bodies || !m.edges || !of_vertex || !mesh->vertices || !mesh->half_edges || !mesh->loops ||
        !mesh->faces || !mesh->bodies || !mesh->names)
        err_nomem(err, "a mesh", (size_t)corners * sizeof *mesh->half_edges);
    if (!err->status) mesh->vertex_count = vertex_count;
    for (int i = 0; !err->status && i < vertex_count; i++) {
        mesh->vertices[i] = (struct solid_vertex){vertices[i], -1};
        of_vertex[i] = -1;
        if (!finite3(vertices[i])) err_set(err, ST_DATA, "vertex %d is not finite.", i);
    }
    for (int i = 0; !err->status && i < count; i++) add_polygon(&m, i, &polygons[i], of_vertex, err);
    if (!err->status && !pair_edges(&m, polygons, err)) one_fan_each(&m, polygons, of_vertex, err);
    free(m.names);
    free(m.bodies);
    free(m.edges);
    free(of_vertex);
    if (err->status) solid_mesh_release(mesh);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ ids */

struct id_order {
    int id, name;
};

static int compare_ids(const void *a, const void *b)
{
    const struct id_order *p = a, *q = b;
    return (p->id > q->id) - (p->id < q->id);
}

enum status solid_mesh_set_ids(struct solid_mesh *mesh, const int *ids, struct err *err)
{
    const size_t n = (size_t)mesh->name_count;
    struct id_order *order = malloc((n + 1) * sizeof *order);
    struct solid_name *names = malloc((n + 1) * sizeof *names);
    int *now = malloc((n + 1) * sizeof *now);
    if (!order || !names || !now) {
        err_nomem(err, "ids of faces", n * sizeof *order);
    } else {
        for (int i = 0; i < mesh->name_count; i++) order[i] = (struct id_order){ids[i], i};
        qsort(order, n, sizeof *order, compare_ids);
        for (int i = 0; i < mesh->name_count; i++) {
            names[i] = (struct solid_name){mesh->names[order[i].name].name, order[i].id};
            now[order[i].name] = i;
        }
        memcpy(mesh->names, names, n * sizeof *names);
        for (int i = 0; i < mesh->face_count; i++) mesh->faces[i].name = now[mesh->faces[i].name];
    }
    free(order);
    free(names);
    free(now);
    return err->status;
}

enum status solid_mesh_carry_ids(struct solid_mesh *mesh, const struct solid_mesh *base, struct err *err)
{
    const unsigned size = table_size(base->name_count);
    int *slots = table_make(size), *ids = malloc(((size_t)mesh->name_count + 1) * sizeof *ids), next = 1;
    if (!slots || !ids) err_nomem(err, "ids of faces", size * sizeof *slots);
    for (int i = 0; !err->status && i < base->name_count; i++) {
        slots[name_slot(base, slots, size, base->names[i].name)] = i;
        if (base->names[i].id >= next) next = base->names[i].id + 1;
    }
    for (int i = 0; !err->status && i < mesh->name_count; i++) {
        const int at = slots[name_slot(base, slots, size, mesh->names[i].name)];
        ids[i] = at >= 0 ? base->names[at].id : next++;
    }
    if (!err->status) solid_mesh_set_ids(mesh, ids, err);
    free(slots);
    free(ids);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------- volume and area */

/* Twice the area of a loop, as a vector along its normal; origin: any point near it. */
static struct vec3 loop_area(const struct solid_mesh *mesh, int loop, struct vec3 origin)
{
    const int first = mesh->loops[loop].half_edge;
    struct vec3 sum = {0, 0, 0};
    int h = first;
    do {
        const struct vec3 a = vec3_sub(mesh->vertices[mesh->half_edges[h].origin].p, origin);
        h = mesh->half_edges[h].next;
        const struct vec3 b = vec3_sub(mesh->vertices[mesh->half_edges[h].origin].p, origin);
        sum = vec3_add(sum, vec3_cross(a, b));
    } while (h != first);
    return sum;
}

double solid_mesh_loop_area(const struct solid_mesh *mesh, int loop)
{
    const struct vec3 origin = mesh->vertices[mesh->half_edges[mesh->loops[loop].half_edge].origin].p;
    return 0.5 * vec3_dot(loop_area(mesh, loop, origin), mesh->faces[mesh->loops[loop].face].normal);
}

double solid_mesh_area(const struct solid_mesh *mesh, int face)
{
    double sum = 0;
    for (int i = 0; i < mesh->faces[face].loops; i++) sum += solid_mesh_loop_area(mesh, mesh->faces[face].loop + i);
    return sum;
}

double solid_mesh_volume(const struct solid_mesh *mesh, int body)
{
    double sum = 0;
    for (int b = body < 0 ? 0 : body; b < (body < 0 ? mesh->body_count : body + 1); b++) {
        const struct solid_body *o = &mesh->bodies[b];
        /* relative to a point of the body, to avoid cancellation far from the origin */
        const struct solid_loop *first = &mesh->loops[mesh->faces[o->face].loop];
        const struct vec3 origin = mesh->vertices[mesh->half_edges[first->half_edge].origin].p;
        for (int f = o->face; f < o->face + o->faces; f++) {
            const double distance = mesh->faces[f].offset - vec3_dot(mesh->faces[f].normal, origin);
            sum += solid_mesh_area(mesh, f) * distance / 3;
        }
    }
    return sum;
}

bool solid_face_is_pane(const struct solid_mesh *mesh, int face)
{
    return !strncmp(mesh->bodies[mesh->faces[face].body].name, "glass/", 6);
}

void solid_face_box(const struct solid_mesh *mesh, int face, struct vec3 u, struct vec3 v, double low[2],
                    double high[2])
{
    const int first = mesh->loops[mesh->faces[face].loop].half_edge;
    int h = first;
    low[0] = low[1] = INFINITY;
    high[0] = high[1] = -INFINITY;
    do {
        const struct vec3 p = mesh->vertices[mesh->half_edges[h].origin].p;
        const double at[2] = {vec3_dot(u, p), vec3_dot(v, p)};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
        h = mesh->half_edges[h].next;
    } while (h != first);
}
