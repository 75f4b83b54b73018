/* groups.c - see groups.h. */
#include "stages/light_levels/groups.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/numbers.h"

static const double EDGE = 1 + 1e-9; /* rays through the very rim of a pane count */

static void add_window(struct light_groups *g, const char *name, const struct emitter *pane)
{
    struct light_window *w = &g->windows[g->windows_count++];
    *w = (struct light_window){.name = name, .pane = *pane};
    field_dual(w->dual, pane->x, pane->y);
}

static bool has_window(const struct light_groups *g, const char *name)
{
    for (int i = 0; i < g->windows_count; i++)
        if (!strcmp(g->windows[i].name, name)) return true;
    return false;
}

/* The panes of the model, then openings of lights.txt that have none. */
static enum status find_windows(struct light_groups *g, struct err *err)
{
    const struct solid_mesh *m = &g->field->model.mesh;
    const struct light_list *l = &g->field->lights;
    struct emitter pane;
    g->windows = calloc((size_t)m->body_count + (size_t)l->opening_count + 1, sizeof *g->windows);
    if (!g->windows) return err_nomem(err, "windows", (size_t)m->body_count * sizeof *g->windows);
    for (int i = 0; i < m->body_count; i++)
        if (model_field_pane(&pane, g->field, i)) add_window(g, strchr(m->bodies[i].name, '/') + 1, &pane);
    for (int i = 0; i < l->opening_count; i++) {
        const struct daylight *o = &l->openings[i];
        pane = (struct emitter){.kind = EMITTER_QUAD,
                                .centre = o->centre,
                                .x = o->x,
                                .y = o->y,
                                .normal = o->normal,
                                .luminance = 1,
                                .beta = 0.5 * PI};
        if (!has_window(g, o->name)) add_window(g, o->name, &pane);
    }
    g->windows[g->windows_count++] = (struct light_window){.name = WINDOW_ELSEWHERE};
    return ST_OK;
}

enum status groups_make(struct light_groups *g, const struct model_field *field, bool hours, struct err *err)
{
    *g = (struct light_groups){.field = field};
    if (sky_patches_init(&g->patches, 1, 0, err) || find_windows(g, err)) return err->status;
    const int windows = g->windows_count, parts = hours ? windows * g->patches.count : 0;
    g->rest = field->lights.lamp_count;
    g->sky = g->rest + 1;
    g->sun = g->sky + windows;
    g->patch = g->sun + windows;
    g->beam = g->patch + parts;
    g->planned = g->count = g->beam + parts;
    g->metre = 1;
    return ST_OK;
}

void groups_add_planned(struct light_groups *g, const struct planned_lamps *lamps, double metre)
{
    g->planned_lamps = lamps;
    g->metre = metre;
    g->count = g->planned + lamps->count;
}

void groups_release(struct light_groups *g)
{
    free(g->windows);
    *g = (struct light_groups){0};
}

int groups_window(const struct light_groups *g, struct vec3 from, struct vec3 direction)
{
    const int elsewhere = g->windows_count - 1;
    int found = elsewhere;
    double nearest = INFINITY;
    for (int i = 0; i < elsewhere; i++) {
        const struct light_window *w = &g->windows[i];
        const double cosine = -vec3_dot(direction, w->pane.normal);
        const struct vec3 to = vec3_sub(w->pane.centre, from);
        const double t = -vec3_dot(to, w->pane.normal) / cosine;
        if (!(cosine > 0) || !(t > 0 && t < nearest)) continue;
        const struct vec3 q = vec3_sub(vec3_scale(direction, t), to);
        if (!(fabs(vec3_dot(w->dual[0], q)) <= EDGE && fabs(vec3_dot(w->dual[1], q)) <= EDGE)) continue;
        found = i;
        nearest = t;
    }
    return found;
}
