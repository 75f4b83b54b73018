/* solid_check.c - checks that a mesh is a closed solid (solid_mesh.h).
 *
 * Three tests find self-intersections, except where faces only meet edge to edge: no edge of a body passes through the
 * inside of a face of that body; no two of its faces in one plane overlap; and no shell is inside another one (a cavity
 * is in exactly one), which follows from the solid angle of the other shells seen from one of its faces
 * [vanOosterom 1983]. Parts closer than the tolerance only touch. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/model/solid_mesh.h"

void solid_report_release(struct solid_report *report)
{
    if (!report) return;
    free(report->shells);
    *report = (struct solid_report){0};
}

struct box3 {
    double low[3], high[3];
};

struct solid_checker {
    const struct solid_mesh *mesh;
    double tolerance;
    struct solid_triangles triangles;
    int *shell_of;      /* faces; owned */
    double *shell_area; /* owned */
    struct solid_report *report;
};

#define AT(c, v)   ((c)->mesh->vertices[v].p)
#define EDGES(c)   ((c)->mesh->half_edges)
#define FACE(c, h) ((c)->mesh->loops[EDGES(c)[h].loop].face)

static enum status fault(const struct solid_checker *c, int face, struct err *err, const char *what)
{
    return err_set(err, ST_DATA, "face %d, %s: %s.", face + 1, solid_face_name(c->mesh, face), what);
}

/* ------------------------------------------------------------------------------------------------------- topology */

static bool in(int i, int count) { return i >= 0 && i < count; }

static enum status check_indices(const struct solid_mesh *m, struct err *err)
{
    const int n = m->half_edge_count;
    int face = 0, loop = 0;
    for (int h = 0; h < n; h++) {
        const struct solid_half_edge *e = &m->half_edges[h];
        if (!in(e->next, n) || !in(e->prev, n) || !in(e->twin, n) || !in(e->loop, m->loop_count) ||
            !in(e->origin, m->vertex_count))
            return err_set(err, ST_DATA, "half-edge %d has an index outside the mesh.", h);
    }
    for (int h = 0; h < n; h++) {
        const struct solid_half_edge *e = &m->half_edges[h], *t = &m->half_edges[e->twin];
        if (m->half_edges[e->next].prev != h || m->half_edges[e->prev].next != h ||
            m->half_edges[e->next].loop != e->loop)
            return err_set(err, ST_DATA, "half-edge %d: next and prev are inconsistent.", h);
        if (e->twin == h || t->twin != h || t->origin != m->half_edges[e->next].origin ||
            m->half_edges[t->next].origin != e->origin)
            return err_set(err, ST_DATA, "half-edge %d is not paired with its opposite.", h);
    }
    for (int b = 0; b < m->body_count; b++) {
        if (m->bodies[b].face != face || m->bodies[b].faces < 1)
            return err_set(err, ST_DATA, "body %s: its faces are not contiguous.", m->bodies[b].name);
        for (const int end = face + m->bodies[b].faces; face < end; face++) {
            if (face >= m->face_count || m->faces[face].body != b || m->faces[face].loop != loop ||
                m->faces[face].loops < 1 || !in(m->faces[face].name, m->name_count))
                return err_set(err, ST_DATA, "face %d is inconsistent with the lists of bodies, loops and names.",
                               face + 1);
            for (const int last = loop + m->faces[face].loops; loop < last; loop++)
                if (loop >= m->loop_count || m->loops[loop].face != face || !in(m->loops[loop].half_edge, n) ||
                    m->half_edges[m->loops[loop].half_edge].loop != loop)
                    return err_set(err, ST_DATA, "loop %d is inconsistent with the lists of faces and half-edges.",
                                   loop);
        }
    }
    if (face != m->face_count || loop != m->loop_count)
        return err_set(err, ST_DATA, "a face or loop belongs to no body.");
    for (int i = 0; i < m->name_count; i++)
        if (m->names[i].id <= (i ? m->names[i - 1].id : 0))
            return err_set(err, ST_DATA, "name %s has the id %d, wanted ascending ids above 0.", m->names[i].name,
                           m->names[i].id);
    return ST_OK;
}

/* Each loop must be one ring, each vertex one fan, and these must contain all half-edges. */
static enum status check_rings(const struct solid_mesh *m, struct err *err)
{
    int rings = 0, fans = 0;
    for (int l = 0; l < m->loop_count; l++) {
        int h = m->loops[l].half_edge;
        do {
            rings++;
            h = m->half_edges[h].next;
        } while (h != m->loops[l].half_edge);
    }
    if (rings != m->half_edge_count) return err_set(err, ST_DATA, "a loop has more than one ring of half-edges.");
    for (int v = 0; v < m->vertex_count; v++) {
        int h = m->vertices[v].half_edge;
        if (!in(h, m->half_edge_count) || m->half_edges[h].origin != v)
            return err_set(err, ST_DATA, "vertex %d has no half-edge that starts there.", v);
        do {
            fans++;
            if (m->half_edges[h].origin != v) return err_set(err, ST_DATA, "vertex %d: its fan leaves the vertex.", v);
            h = m->half_edges[m->half_edges[h].prev].twin;
        } while (h != m->vertices[v].half_edge);
    }
    if (fans != m->half_edge_count) return err_set(err, ST_DATA, "a vertex has more than one fan of faces.");
    return ST_OK;
}

static int root(int *parent, int i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

static enum status find_shells(struct solid_checker *c, struct err *err)
{
    const struct solid_mesh *m = c->mesh;
    struct solid_report *r = c->report;
    int *shell = malloc(((size_t)m->face_count + 1) * sizeof *shell);
    c->shell_of = malloc(((size_t)m->face_count + 1) * sizeof *c->shell_of);
    r->shells = calloc((size_t)m->face_count + 1, sizeof *r->shells);
    c->shell_area = calloc((size_t)m->face_count + 1, sizeof *c->shell_area);
    if (!shell || !c->shell_of || !r->shells || !c->shell_area) {
        free(shell);
        return err_nomem(err, "shells", (size_t)m->face_count * sizeof *r->shells);
    }
    for (int f = 0; f < m->face_count; f++) shell[f] = f;
    for (int h = 0; h < m->half_edge_count; h++) {
        const int a = root(shell, FACE(c, h)), b = root(shell, FACE(c, m->half_edges[h].twin));
        if (a < b)
            shell[b] = a;
        else
            shell[a] = b;
    }
    for (int f = 0; f < m->face_count; f++) {
        const int first = root(shell, f); /* the shell's first face */
        c->shell_of[f] = first == f ? r->count : c->shell_of[first];
        struct solid_shell *s = &r->shells[c->shell_of[f]];
        if (first == f) {
            r->count++;
            s->body = m->faces[f].body;
        }
        s->faces++;
        s->loops += m->faces[f].loops;
    }
    free(shell);
    for (int h = 0; h < m->half_edge_count; h++)
        if (h < m->half_edges[h].twin) r->shells[c->shell_of[FACE(c, h)]].edges++;
    for (int v = 0; v < m->vertex_count; v++) r->shells[c->shell_of[FACE(c, m->vertices[v].half_edge)]].vertices++;
    for (int i = 0; i < r->count; i++) {
        struct solid_shell *s = &r->shells[i];
        s->euler = s->vertices - s->edges + 2 * s->faces - s->loops;
        s->genus = (2 - s->euler) / 2;
        if (s->euler > 2 || s->euler % 2)
            return err_set(err, ST_DATA,
                           "a shell of body %s has %d vertices, %d edges, %d faces and %d loops: their Euler "
                           "characteristic is %d, wanted an even number of at most 2.",
                           m->bodies[s->body].name, s->vertices, s->edges, s->faces, s->loops, s->euler);
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------- geometry */

static enum status check_faces(struct solid_checker *c, struct err *err)
{
    const struct solid_mesh *m = c->mesh;
    struct solid_report *r = c->report;
    for (int h = 0; h < m->half_edge_count; h++) {
        const struct solid_face *f = &m->faces[FACE(c, h)];
        const struct vec3 a = AT(c, m->half_edges[h].origin), b = AT(c, m->half_edges[m->half_edges[h].next].origin);
        const double off = fabs(vec3_dot(f->normal, a) - f->offset), length = vec3_length(vec3_sub(b, a));
        if (off > r->planarity) r->planarity = off;
        if (!h || length < r->shortest_edge) r->shortest_edge = length;
        if (!(off <= c->tolerance)) return fault(c, FACE(c, h), err, "a vertex is not in its plane");
        if (!(length > 0)) return fault(c, FACE(c, h), err, "an edge has no length");
    }
    for (int f = 0; f < m->face_count; f++) {
        double area = 0;
        for (int l = m->faces[f].loop; l < m->faces[f].loop + m->faces[f].loops; l++) {
            const double one = solid_mesh_loop_area(m, l);
            if (!(l == m->faces[f].loop ? one > 0 : one < 0))
                return fault(c, f, err,
                             l == m->faces[f].loop ? "its outer loop is clockwise, seen from outside"
                                                   : "a hole is counter-clockwise, seen from outside");
            area += one;
        }
        if (!(area > 0)) return fault(c, f, err, "its holes are larger than the face");
        r->area += area;
        /* relative to the body's first vertex, as in solid_mesh_volume() */
        const struct solid_loop *first = &m->loops[m->faces[m->bodies[m->faces[f].body].face].loop];
        const struct vec3 origin = AT(c, m->half_edges[first->half_edge].origin);
        const double volume = area * (m->faces[f].offset - vec3_dot(m->faces[f].normal, origin)) / 3;
        r->shells[c->shell_of[f]].volume += volume;
        c->shell_area[c->shell_of[f]] += area;
        r->volume += volume;
    }
    for (int b = 0; b < m->body_count; b++)
        if (!(solid_mesh_volume(m, b) > 0))
            return err_set(err, ST_DATA, "body %s has the volume %.9g, wanted one above 0: it is inside out.",
                           m->bodies[b].name, solid_mesh_volume(m, b));
    for (int s = 0; s < r->count; s++)
        if (r->shells[s].volume == 0)
            return err_set(err, ST_DATA, "a shell of body %s has no volume.", m->bodies[r->shells[s].body].name);
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------- self-intersection */

static void box_add(struct box3 *box, struct vec3 p, bool first)
{
    const double v[3] = {p.x, p.y, p.z};
    for (int i = 0; i < 3; i++) {
        box->low[i] = first ? v[i] : fmin(box->low[i], v[i]);
        box->high[i] = first ? v[i] : fmax(box->high[i], v[i]);
    }
}

static bool boxes_overlap(const struct box3 *a, const struct box3 *b)
{
    for (int i = 0; i < 3; i++)
        if (a->low[i] > b->high[i] || b->low[i] > a->high[i]) return false;
    return true;
}

static double segment_distance(struct vec3 p, struct vec3 a, struct vec3 b)
{
    const struct vec3 d = vec3_sub(b, a), e = vec3_sub(p, a);
    const double t = fmin(fmax(vec3_dot(d, e) / vec3_dot(d, d), 0), 1);
    return vec3_length(vec3_sub(e, vec3_scale(d, t)));
}

/* Whether a point of the face's plane is inside the face, farther than the tolerance from its border. */
static bool inside_face(const struct solid_checker *c, int face, struct vec3 p)
{
    bool found = false;
    for (int i = c->triangles.first[face]; !found && i < c->triangles.first[face + 1]; i++) {
        const int *v = c->triangles.triangles[i].v;
        bool all = true;
        for (int k = 0; all && k < 3; k++) {
            const struct vec3 a = AT(c, v[k]), b = AT(c, v[(k + 1) % 3]);
            all = vec3_dot(vec3_cross(vec3_sub(b, a), vec3_sub(p, a)), c->mesh->faces[face].normal) >= 0;
        }
        found = all;
    }
    if (!found) return false;
    for (int l = c->mesh->faces[face].loop; l < c->mesh->faces[face].loop + c->mesh->faces[face].loops; l++) {
        int h = c->mesh->loops[l].half_edge;
        do {
            const int next = EDGES(c)[h].next;
            if (segment_distance(p, AT(c, EDGES(c)[h].origin), AT(c, EDGES(c)[next].origin)) <= c->tolerance)
                return false;
            h = next;
        } while (h != c->mesh->loops[l].half_edge);
    }
    return true;
}

static bool edge_pierces(const struct solid_checker *c, int half_edge, int face)
{
    const struct solid_face *f = &c->mesh->faces[face];
    const struct vec3 a = AT(c, EDGES(c)[half_edge].origin), b = AT(c, EDGES(c)[EDGES(c)[half_edge].next].origin);
    const double da = vec3_dot(f->normal, a) - f->offset, db = vec3_dot(f->normal, b) - f->offset;
    if (!(fmin(da, db) < -c->tolerance && fmax(da, db) > c->tolerance)) return false;
    return inside_face(c, face, vec3_add(a, vec3_scale(vec3_sub(b, a), da / (da - db))));
}

/* Overlap of two triangles in one plane along the separating axis with the smallest overlap; negative: they are
 * apart. */
static double overlap_width(const struct solid_checker *c, const int *v, const int *w, struct vec3 normal)
{
    double min_overlap = INFINITY;
    for (int k = 0; k < 6; k++) {
        const int *t = k < 3 ? v : w;
        const struct vec3 along = vec3_sub(AT(c, t[(k + 1) % 3]), AT(c, t[k % 3]));
        const struct vec3 across = vec3_normalize(vec3_cross(along, normal));
        double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
        for (int i = 0; i < 6; i++) {
            const double d = vec3_dot(across, AT(c, i < 3 ? v[i] : w[i - 3]));
            low[i / 3] = fmin(low[i / 3], d);
            high[i / 3] = fmax(high[i / 3], d);
        }
        min_overlap = fmin(min_overlap, fmin(high[0], high[1]) - fmax(low[0], low[1]));
    }
    return min_overlap;
}

static bool faces_overlap(const struct solid_checker *c, int f, int g)
{
    const struct solid_face *a = &c->mesh->faces[f], *b = &c->mesh->faces[g];
    const double same = vec3_dot(a->normal, b->normal) > 0 ? 1 : -1;
    if (vec3_length(vec3_cross(a->normal, b->normal)) > 1e-6 || fabs(a->offset - same * b->offset) > c->tolerance * 1e3)
        return false;
    /* in one plane at the faces, not only at the origin */
    const struct vec3 p = AT(c, c->triangles.triangles[c->triangles.first[g]].v[0]);
    if (fabs(vec3_dot(a->normal, p) - a->offset) > c->tolerance) return false;
    for (int i = c->triangles.first[f]; i < c->triangles.first[f + 1]; i++) {
        const int *v = c->triangles.triangles[i].v;
        struct box3 box;
        for (int k = 0; k < 3; k++) box_add(&box, AT(c, v[k]), !k);
        for (int o = c->triangles.first[g]; o < c->triangles.first[g + 1]; o++) {
            const int *w = c->triangles.triangles[o].v;
            struct box3 other;
            for (int k = 0; k < 3; k++) box_add(&other, AT(c, w[k]), !k);
            if (boxes_overlap(&box, &other) && overlap_width(c, v, w, a->normal) > c->tolerance) return true;
        }
    }
    return false;
}

struct sweep_item { /* a face or a half-edge */
    struct box3 box;
    int index;
    bool is_edge;
};

static int compare_items(const void *a, const void *b, void *axis)
{
    const struct sweep_item *p = a, *q = b;
    const double low = p->box.low[*(int *)axis], other = q->box.low[*(int *)axis];
    if (low != other) return low < other ? -1 : 1;
    if (p->is_edge != q->is_edge) return p->is_edge ? 1 : -1;
    return (p->index > q->index) - (p->index < q->index);
}

static enum status check_pair(const struct solid_checker *c, const struct sweep_item *a, const struct sweep_item *b,
                              struct err *err)
{
    if (a->is_edge && b->is_edge) return ST_OK;
    if (!a->is_edge && !b->is_edge) {
        if (!faces_overlap(c, a->index, b->index)) return ST_OK;
        return err_set(err, ST_DATA, "face %d, %s, and face %d, %s, overlap.", a->index + 1,
                       solid_face_name(c->mesh, a->index), b->index + 1, solid_face_name(c->mesh, b->index));
    }
    const int edge = a->is_edge ? a->index : b->index, face = a->is_edge ? b->index : a->index;
    if (!edge_pierces(c, edge, face)) return ST_OK;
    return err_set(err, ST_DATA, "an edge of face %d, %s, passes through face %d, %s.", FACE(c, edge) + 1,
                   solid_face_name(c->mesh, FACE(c, edge)), face + 1, solid_face_name(c->mesh, face));
}

/* Checks all pairs of a body's faces and edges whose boxes overlap, by a sweep along the body's longest side. */
static enum status check_crossings(const struct solid_checker *c, int body, struct err *err)
{
    const struct solid_mesh *m = c->mesh;
    const struct solid_body *b = &m->bodies[body];
    int count = 0, edges = 0;
    for (int f = b->face; f < b->face + b->faces; f++)
        for (int l = m->faces[f].loop; l < m->faces[f].loop + m->faces[f].loops; l++) {
            int h = m->loops[l].half_edge;
            do {
                edges++;
                h = EDGES(c)[h].next;
            } while (h != m->loops[l].half_edge);
        }
    const size_t max_items = (size_t)b->faces + (size_t)edges + 1;
    struct sweep_item *items = malloc(max_items * sizeof *items);
    int *active[2] = {malloc(max_items * sizeof **active), malloc(max_items * sizeof **active)};
    if (!items || !active[0] || !active[1]) err_nomem(err, "a sweep", max_items * sizeof *items);
    struct box3 whole = {{0}, {0}};
    for (int f = b->face; !err->status && f < b->face + b->faces; f++) {
        struct sweep_item *face = &items[count++];
        *face = (struct sweep_item){.index = f};
        bool first = true;
        for (int l = m->faces[f].loop; l < m->faces[f].loop + m->faces[f].loops; l++) {
            int h = m->loops[l].half_edge;
            do {
                const int next = EDGES(c)[h].next;
                box_add(&face->box, AT(c, EDGES(c)[h].origin), first);
                box_add(&whole, AT(c, EDGES(c)[h].origin), first && f == b->face);
                first = false;
                if (h < EDGES(c)[h].twin) {
                    struct sweep_item *e = &items[count++];
                    *e = (struct sweep_item){.index = h, .is_edge = true};
                    box_add(&e->box, AT(c, EDGES(c)[h].origin), true);
                    box_add(&e->box, AT(c, EDGES(c)[next].origin), false);
                }
                h = next;
            } while (h != m->loops[l].half_edge);
        }
    }
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (whole.high[i] - whole.low[i] > whole.high[axis] - whole.low[axis]) axis = i;
    if (!err->status) qsort_r(items, (size_t)count, sizeof *items, compare_items, &axis);
    int alive[2] = {0, 0};
    for (int i = 0; !err->status && i < count; i++)
        for (int kind = 0; !err->status && kind < 2; kind++) { /* all items against faces, faces against edges too */
            int kept = 0;
            if (kind && items[i].is_edge) {
                active[1][alive[1]++] = i;
                continue;
            }
            for (int k = 0; k < alive[kind]; k++) {
                const struct sweep_item *o = &items[active[kind][k]];
                if (o->box.high[axis] < items[i].box.low[axis]) continue;
                active[kind][kept++] = active[kind][k];
                if (!err->status && boxes_overlap(&o->box, &items[i].box)) check_pair(c, o, &items[i], err);
            }
            alive[kind] = kept;
            if (!kind && !items[i].is_edge) active[0][alive[0]++] = i;
        }
    free(items);
    free(active[0]);
    free(active[1]);
    return err->status;
}

/* Solid angle of a triangle seen from p, as a fraction of the sphere; positive if its inner side is visible
 * [vanOosterom 1983]. */
static double solid_angle(const struct solid_checker *c, const int *v, struct vec3 p)
{
    const struct vec3 a = vec3_sub(AT(c, v[0]), p), b = vec3_sub(AT(c, v[1]), p), d = vec3_sub(AT(c, v[2]), p);
    const double la = vec3_length(a), lb = vec3_length(b), ld = vec3_length(d);
    const double over = vec3_dot(a, vec3_cross(b, d));
    const double under = la * lb * ld + vec3_dot(a, b) * ld + vec3_dot(b, d) * la + vec3_dot(d, a) * lb;
    return over == 0 && under == 0 ? 0 : 2 * atan2(over, under) / (4 * M_PI);
}

static enum status check_shells(const struct solid_checker *c, struct err *err)
{
    const struct solid_mesh *m = c->mesh;
    const struct solid_report *r = c->report;
    struct box3 *boxes = malloc(((size_t)r->count + 1) * sizeof *boxes);
    char *begun = calloc((size_t)r->count + 1, 1), *done = calloc((size_t)r->count + 1, 1);
    if (!boxes || !begun || !done) err_nomem(err, "shells", (size_t)r->count * sizeof *boxes);
    for (int h = 0; !err->status && h < m->half_edge_count; h++) {
        const int s = c->shell_of[FACE(c, h)];
        box_add(&boxes[s], AT(c, m->half_edges[h].origin), !begun[s]);
        begun[s] = 1;
    }
    for (int f = 0; !err->status && f < m->face_count; f++) {
        const int s = c->shell_of[f];
        if (done[s]) continue;
        done[s] = 1;
        if (fabs(r->shells[s].volume) <= c->tolerance * c->shell_area[s]) continue; /* too thin for a test */
        const int *v = c->triangles.triangles[c->triangles.first[f]].v;
        /* a generic point of the face: other faces may touch its edges */
        const struct vec3 p = vec3_add(vec3_scale(AT(c, v[0]), 0.2371),
                                       vec3_add(vec3_scale(AT(c, v[1]), 0.3093), vec3_scale(AT(c, v[2]), 0.4536)));
        struct box3 at;
        double around = 0;
        box_add(&at, p, true);
        for (int g = m->bodies[m->faces[f].body].face;
             g < m->bodies[m->faces[f].body].face + m->bodies[m->faces[f].body].faces; g++) {
            if (c->shell_of[g] == s || !boxes_overlap(&at, &boxes[c->shell_of[g]])) continue;
            for (int i = c->triangles.first[g]; i < c->triangles.first[g + 1]; i++)
                around += solid_angle(c, c->triangles.triangles[i].v, p);
        }
        if (fabs(around - (r->shells[s].volume < 0 ? 1 : 0)) > 0.25)
            fault(c, f, err,
                  r->shells[s].volume < 0 ? "its shell is inside out and not inside another one"
                                          : "its shell is inside another one of the same body");
    }
    free(boxes);
    free(begun);
    free(done);
    return err->status;
}

enum status solid_mesh_check(const struct solid_mesh *mesh, double tolerance, struct solid_report *report,
                             struct err *err)
{
    struct solid_report own = {0};
    struct solid_checker c = {
        .mesh = mesh, .tolerance = tolerance > 0 ? tolerance : 1e-6, .report = report ? report : &own};
    *c.report = (struct solid_report){0};
    if (!check_indices(mesh, err) && !check_rings(mesh, err) && !find_shells(&c, err) && !check_faces(&c, err))
        solid_mesh_triangulate(&c.triangles, mesh, err);
    for (int b = 0; !err->status && b < mesh->body_count; b++) check_crossings(&c, b, err);
    if (!err->status) check_shells(&c, err);
    solid_triangles_release(&c.triangles);
    free(c.shell_of);
    free(c.shell_area);
    solid_report_release(&own);
    return err->status;
}
