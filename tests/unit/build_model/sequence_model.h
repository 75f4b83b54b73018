/* sequence_model.h - the model of a random script, and lines through it; for sequences.c. */
#ifndef REMODEL_TESTS_SEQUENCE_MODEL_H
#define REMODEL_TESTS_SEQUENCE_MODEL_H

#include "tests/unit/build_model/random_script.h"
#include "tests/unit/build_model/scripted.h"
#include "tests/unit/build_model/unions.h"

#include "stages/build_model/texture/texture_rules.h"

enum { MAX_HITS = 1024 };

/* -------------------------------------------------------------------------------------------------------- models */

struct model {
    struct plan plan;
    struct solid_list list;
    struct solid_mesh mesh;
    struct solid_report report;
    struct unite_log log;
    struct texture_map map; /* of an edited model */
};

static inline void drop_model(struct model *m)
{
    texture_map_release(&m->map);
    unite_log_release(&m->log);
    solid_report_release(&m->report);
    solid_mesh_release(&m->mesh);
    drop(&m->plan, &m->list);
}

static inline void explain(const char *base, const char *edit)
{
    fprintf(stderr, "sequence %d:\n%s%s%s", (int)sequence, base, edit ? "---- edit\n" : "", edit ? edit : "");
}

static inline void assert_names_the_line(const struct err *err, const char *place, const char *base, const char *edit)
{
    if (err->status == ST_DATA && strstr(err->text, place) && strchr(".?", err->text[strlen(err->text) - 1])) return;
    explain(base, edit);
    fail_msg("rejected without file and line: %s", err->text);
}

/* Makes the model of a script, or of an edit of it; then unedited is its model, else NULL. False: the plan was rejected
 * with an error message; line: of the statement that it must name, 0 for any. */
static inline bool make_model(struct model *m, const struct model *unedited, const char *base, const char *edit,
                              int line)
{
    struct err err = ERR_INIT;
    *m = (struct model){0};
    if (scripted(&m->plan, base, edit, &err)) {
        char place[64];
        if (edit && line)
            snprintf(place, sizeof place, "/edit.txt:%d: ", line);
        else
            strcpy(place, edit ? "/edit.txt:" : "/model.txt:");
        assert_names_the_line(&err, place, base, edit);
        plan_release(&m->plan);
        return false;
    }
    if (layout_solids(&m->list, &m->plan, &err) || unite_solids(&m->mesh, &m->list, &m->log, &err) ||
        solid_mesh_check(&m->mesh, 0, &m->report, &err) ||
        (edit && solid_mesh_carry_ids(&m->mesh, &unedited->mesh, &err))) {
        explain(base, edit);
        fail_msg("accepted, but not a solid: %s", err.text);
    }
    if (!edit || !texture_rules_make(&m->map, &m->mesh, &unedited->mesh, &m->plan, &err)) return true;
    assert_names_the_line(&err, "/edit.txt:", base,
                          edit); /* a face that this or another statement names is not there */
    drop_model(m);
    return false;
}

/* --------------------------------------------------------------------------------------------------------- lines */

struct ray {
    struct vec3 o, d;
};

struct hit {
    double t;
    int way; /* 1 into matter, -1 out of it */
    const char *name, *body;
    int face; /* of the mesh */
};

static inline int compare_hits(const void *a, const void *b)
{
    const struct hit *x = a, *y = b;
    return (x->t > y->t) - (x->t < y->t);
}

static inline bool on_face(const struct solid_mesh *mesh, const struct solid_face *f, struct vec3 p)
{
    const double n[3] = {fabs(f->normal.x), fabs(f->normal.y), fabs(f->normal.z)};
    const int drop_axis = n[0] > n[1] ? (n[0] > n[2] ? 0 : 2) : n[1] > n[2] ? 1 : 2;
    const int u = (drop_axis + 1) % 3, v = (drop_axis + 2) % 3;
    const double at[3] = {p.x, p.y, p.z};
    bool in = false;
    for (int l = f->loop; l < f->loop + f->loops; l++) {
        int h = mesh->loops[l].half_edge;
        do {
            const struct vec3 a = mesh->vertices[mesh->half_edges[h].origin].p;
            h = mesh->half_edges[h].next;
            const struct vec3 b = mesh->vertices[mesh->half_edges[h].origin].p;
            const double x[3] = {a.x, a.y, a.z}, y[3] = {b.x, b.y, b.z};
            if ((x[v] > at[v]) != (y[v] > at[v]) && x[u] + (at[v] - x[v]) / (y[v] - x[v]) * (y[u] - x[u]) > at[u])
                in = !in;
        } while (h != mesh->loops[l].half_edge);
    }
    return in;
}

static inline int hit_mesh(const struct solid_mesh *mesh, const struct ray *r, struct hit hits[MAX_HITS])
{
    int n = 0;
    for (int f = 0; f < mesh->face_count; f++) {
        const struct solid_face *face = &mesh->faces[f];
        const double slant = vec3_dot(face->normal, r->d);
        const double t = (face->offset - vec3_dot(face->normal, r->o)) / slant;
        if (!isfinite(t) || !on_face(mesh, face, vec3_add(r->o, vec3_scale(r->d, t)))) continue;
        assert_true(n < MAX_HITS);
        hits[n++] = (struct hit){t, slant < 0 ? 1 : -1, solid_face_name(mesh, f), mesh->bodies[face->body].name, f};
    }
    if (n) qsort(hits, (size_t)n, sizeof *hits, compare_hits);
    return n;
}

/* Where the line enters and leaves each solid; false: it grazes a plane, so that rounding would matter. */
static inline bool hit_solids(const struct solid_list *list, const struct ray *r, struct hit hits[MAX_HITS], int *count)
{
    *count = 0;
    for (int i = 0; i < list->count; i++) {
        const struct solid *s = &list->solids[i];
        double from = -HUGE_VAL, to = HUGE_VAL;
        for (int k = 0; k < s->count; k++) {
            const double slant = vec3_dot(s->half_spaces[k].normal, r->d);
            const double t = (s->half_spaces[k].offset - vec3_dot(s->half_spaces[k].normal, r->o)) / slant;
            if (fabs(slant) < 0.02 * vec3_length(s->half_spaces[k].normal)) return false;
            if (slant < 0)
                from = fmax(from, t);
            else
                to = fmin(to, t);
        }
        if (to <= from) continue;
        assert_true(*count + 2 <= MAX_HITS);
        hits[(*count)++] = (struct hit){from, 1, NULL, s->body, -1};
        hits[(*count)++] = (struct hit){to, -1, NULL, s->body, -1};
    }
    if (*count) qsort(hits, (size_t)*count, sizeof *hits, compare_hits);
    return true;
}

/* Length of the line on which only one of mesh and solids has matter of the body. */
static inline double line_difference(const struct hit *mesh, int mesh_count, const struct hit *solids, int solid_count,
                                     const char *body)
{
    double wrong = 0, before = 0;
    for (int i = 0, k = 0, in = 0, depth = 0; i < mesh_count || k < solid_count;) {
        const bool next_mesh = k == solid_count || (i < mesh_count && mesh[i].t < solids[k].t);
        const double t = next_mesh ? mesh[i].t : solids[k].t;
        if (in != (depth > 0)) wrong += t - before;
        before = t;
        if (next_mesh && !strcmp(mesh[i].body, body)) in += mesh[i].way;
        if (!next_mesh && !strcmp(solids[k].body, body)) depth += solids[k].way;
        if (next_mesh)
            i++;
        else
            k++;
    }
    return wrong;
}

static inline struct ray random_ray(const struct solid_mesh *mesh)
{
    struct vec3 low = mesh->vertices[0].p, high = low, d;
    for (int i = 0; i < mesh->vertex_count; i++) {
        const struct vec3 p = mesh->vertices[i].p;
        low = vec3_make(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high = vec3_make(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    const struct vec3 at = {low.x + random_unit() * (high.x - low.x), low.y + random_unit() * (high.y - low.y),
                            low.z + random_unit() * (high.z - low.z)};
    do d = vec3_make(random_unit() - 0.5, random_unit() - 0.5, random_unit() - 0.5);
    while (fmin(fabs(d.x), fmin(fabs(d.y), fabs(d.z))) < 0.05);
    return (struct ray){at, vec3_normalize(d)};
}

#endif
