/* level_sums.c - see level_sums.h.
 *
 * Skies. Each patch of the sky has its mean luminance, times what the glass lets through; patch by patch they add up to
 * the sky's illuminance (sky_luminance.h). The sun's direct light at a point is that of a ray in its own direction.
 * What it reflects comes from beams in the middles of patches: the three nearest, weighted by the inverse of their
 * distance, because what a room reflects changes slowly with the sun's place. */
#include "stages/light_levels/level_sums.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/numbers.h"
#include "stages/light_levels/rows.h"

enum { NEAREST = 3 };

/* ---------------------------------------------------------------------------------------------------------- weights */

enum status level_weights_init(struct state_weights *w, const struct light_groups *groups, struct err *err)
{
    const size_t count = (size_t)groups->count + 1;
    *w = (struct state_weights){.groups = groups,
                                .relative = calloc(count, sizeof *w->relative),
                                .absolute = calloc(count, sizeof *w->absolute),
                                .windows = calloc((size_t)groups->windows_count + 1, sizeof *w->windows)};
    if (!w->relative || !w->absolute || !w->windows)
        return err_nomem(err, "groups of light", count * sizeof *w->relative);
    for (int v = 0; v < groups->windows_count; v++) w->windows[v] = 1;
    return ST_OK;
}

void level_weights_release(struct state_weights *w)
{
    free(w->relative);
    free(w->absolute);
    free(w->windows);
    *w = (struct state_weights){0};
}

/* Shares the sun out among the beams around it. */
static void add_beams(struct state_weights *w, const struct light_groups *g)
{
    int near[NEAREST] = {-1, -1, -1};
    double away[NEAREST] = {INFINITY, INFINITY, INFINITY}, sum = 0;
    for (int k = SKY_GROUND + 1; k < g->patches.count; k++) {
        const double cosine = vec3_dot(sky_patch_direction(&g->patches, k), w->to_sun);
        const double angle = acos(clamp(cosine, -1, 1));
        int at = NEAREST;
        while (at > 0 && angle < away[at - 1]) at--;
        if (at == NEAREST) continue;
        for (int i = NEAREST - 1; i > at; i--) {
            away[i] = away[i - 1];
            near[i] = near[i - 1];
        }
        away[at] = angle;
        near[at] = k;
    }
    for (int i = 0; i < NEAREST; i++) sum += 1 / (away[i] + 1e-6);
    for (int i = 0; i < NEAREST; i++)
        for (int v = 0; v < g->windows_count; v++)
            w->absolute[groups_beam(g, v, near[i])] += w->windows[v] * w->sun / (away[i] + 1e-6) / sum;
}

void level_weights_add_sky(struct state_weights *w, const struct sky_luminance *sky, const struct light_groups *groups,
                           const struct levels_params *params)
{
    double luminance[144 + 2];
    sky_patch_luminances(luminance, &groups->patches, sky);
    for (int v = 0; v < groups->windows_count; v++) {
        const double glass = w->windows[v] * (v + 1 < groups->windows_count ? params->glass : 1);
        for (int k = 0; k < groups->patches.count; k++) w->absolute[groups_patch(groups, v, k)] += glass * luminance[k];
    }
    w->has_absolute = true;
    w->horizontal = sky_horizontal_illuminance(sky);
    w->to_sun = sky->to_sun;
    w->sun = sky->to_sun.z > 0 ? params->glass * sky->sun : 0;
    if (w->sun > 0) add_beams(w, groups);
}

static int find_lamp(const struct light_list *l, const char *name)
{
    for (int i = 0; i < l->lamp_count; i++)
        if (!strcmp(l->lamps[i].name, name)) return i;
    return -1;
}

enum status level_lamps_check(const struct state_list *states, const struct light_list *lights, struct err *err)
{
    for (int i = 0; i < states->count; i++)
        for (int k = 0; k < states->items[i].named_count; k++)
            if (find_lamp(lights, states->items[i].named[k].name) < 0 &&
                planned_lamps_find(&states->planned, states->items[i].named[k].name) < 0)
                return err_set(err, ST_DATA,
                               "%s:%d: found the lamp %s, which the scene does not have; wanted one of "
                               "lights/lights.txt, or of the lines `lamp NAME ies FILE` of this file.",
                               states->path, states->items[i].line, states->items[i].named[k].name);
    for (int i = 0; i < states->planned.count; i++)
        if (find_lamp(lights, states->planned.list[i].name) >= 0)
            return err_set(err, ST_DATA,
                           "%s:%d: found the planned lamp %s; lights/lights.txt has a lamp of that name, so give it "
                           "another one.",
                           states->planned.list[i].on ? "the edit" : states->path, states->planned.list[i].line,
                           states->planned.list[i].name);
    return ST_OK;
}

static int find_window(const struct light_groups *g, const char *name)
{
    for (int v = 0; v + 1 < g->windows_count; v++)
        if (!strcmp(g->windows[v].name, name)) return v;
    return -1;
}

static bool has_window(const struct model_field *field, const char *name, struct err *err)
{
    struct light_groups g = {0};
    const bool has = !groups_make(&g, field, false, err) && find_window(&g, name) >= 0;
    groups_release(&g);
    return has;
}

/* An edit may take away a window that has a blind. */
enum status level_blinds_check(const struct state_list *states, const struct level_scene *scene, struct err *err)
{
    for (int i = 0; i < states->count; i++)
        for (int k = 0; !err->status && k < states->items[i].blind_count; k++) {
            const char *name = states->items[i].blinds[k].name;
            if (has_window(level_scene_field(scene), name, err) ||
                (scene->edited && has_window(&scene->change.before, name, err)) || err->status)
                continue;
            err_set(err, ST_DATA,
                    "%s:%d: found a blind of the window %s, which the scene does not have; wanted a window of "
                    "model.txt or of lights/lights.txt.",
                    states->path, states->items[i].line, name);
        }
    return err->status;
}

static void set_blinds(struct state_weights *w, const struct light_state *s)
{
    for (int k = 0; k < s->blind_count; k++) {
        const int window = find_window(w->groups, s->blinds[k].name);
        if (window >= 0) w->windows[window] = s->blinds[k].factor;
    }
}

static void set_lamps(struct state_weights *w, const struct light_state *s, const struct light_groups *g)
{
    const struct light_list *l = &g->field->lights;
    for (int i = 0; i < l->lamp_count; i++) w->relative[i] = s->lamps;
    w->relative[g->rest] = s->lamps;
    for (int i = 0; i < g->count - g->planned; i++) {
        w->absolute[g->planned + i] = g->planned_lamps->list[i].on && g->scaled && s->lamps;
    }
    for (int k = 0; k < s->named_count; k++) {
        const int lamp = find_lamp(l, s->named[k].name);
        const int planned = g->planned_lamps ? planned_lamps_find(g->planned_lamps, s->named[k].name) : -1;
        if (lamp >= 0) w->relative[lamp] = s->named[k].factor;
        if (planned >= 0) w->absolute[g->planned + planned] = s->named[k].factor;
    }
    for (int i = g->planned; i < g->count; i++) w->has_planned |= w->absolute[i] > 0;
    w->has_absolute |= w->has_planned;
}

enum status level_weights_make(struct state_weights *w, const struct light_state *state,
                               const struct state_list *states, const struct light_groups *groups,
                               const struct levels_params *params, struct err *err)
{
    struct sun_position sun;
    struct sky_luminance sky;
    if (level_weights_init(w, groups, err)) return err->status;
    set_lamps(w, state, groups);
    set_blinds(w, state);
    for (int v = 0; state->sky == STATE_SKY_PHOTOGRAPHED && v < groups->windows_count; v++)
        w->relative[groups->sky + v] = w->relative[groups->sun + v] = w->windows[v];
    if (state->sky == STATE_SKY_OVERCAST) {
        sky = sky_of_type(SKY_TRADITIONAL, vec3_make(0, 0, 1), state->horizontal, 0, params->ground);
        level_weights_add_sky(w, &sky, groups, params);
    } else if (state->sky == STATE_SKY_TIME) {
        sun_position_find(&sun, &states->site, &state->time);
        sky = sky_of_cover(state->cover, &sun, states->north, params->ground);
        level_weights_add_sky(w, &sky, groups, params);
    } else if (state->sky == STATE_SKY_WEATHER) {
        sun_position_find(&sun, &state->place, &state->time);
        sky = sky_from_weather(&state->weather, &sun, states->north, params->ground);
        level_weights_add_sky(w, &sky, groups, params);
    }
    for (int i = 0; i < groups->count; i++) w->has_relative |= w->relative[i] > 0;
    for (int i = 0; groups->factors && i < groups->patch; i++) w->relative[i] *= groups->factors[i];
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------------- points */

enum status level_points_find(struct level_points *p, float **found, const struct level_light *l,
                              const struct gather_point *points, int count, const struct levels_params *params,
                              struct err *err)
{
    const struct light_groups *g = &l->groups;
    const size_t values = (size_t)count * (size_t)g->count;
    struct light_rows direct;
    *p = (struct level_points){points, count, g->count, malloc((values + 1) * sizeof(float)),
                               malloc((values + 1) * sizeof(float))};
    level_light_at(found, &direct, l, points, count, params, err);
    if (!err->status && (!p->whole || !p->direct)) err_nomem(err, "light at points", values * sizeof *p->whole);
    for (size_t i = 0; !err->status && i < values; i++) {
        const int group = (int)(i % (size_t)g->count);
        p->direct[i] = luminance_of(direct.direct + 3 * i);
        p->whole[i] = luminance_of(*found + 3 * i);
        if (group >= g->beam && group < g->planned) p->whole[i] = fmaxf(0, p->whole[i] - p->direct[i]);
    }
    rows_release(&direct);
    return err->status;
}

enum status level_points_make(struct level_points *p, const struct level_light *l, const struct gather_point *points,
                              int count, const struct levels_params *params, struct err *err)
{
    float *found;
    level_points_find(p, &found, l, points, count, params, err);
    free(found);
    return err->status;
}

void level_points_release(struct level_points *p)
{
    free(p->whole);
    free(p->direct);
    *p = (struct level_points){0};
}

void level_points_sum(double to[2], const struct level_points *p, int point, const struct state_weights *w,
                      const struct model_field *field)
{
    const float *own = p->whole + (size_t)point * (size_t)p->groups;
    to[0] = to[1] = 0;
    for (int g = 0; g < p->groups; g++) {
        to[0] += w->relative[g] * (double)own[g];
        to[1] += w->absolute[g] * (double)own[g];
    }
    if (field) to[1] += level_weights_sun(w, p->points[point]);
}

double level_weights_sun(const struct state_weights *w, struct gather_point p)
{
    const struct model_field *field = w->groups->field;
    if (!(w->sun > 0) || !rows_sees_sun(field, p, w->to_sun)) return 0;
    return w->windows[groups_window(w->groups, p.at, w->to_sun)] * w->sun * vec3_dot(p.normal, w->to_sun);
}

/* ---------------------------------------------------------------------------------------------------------- patches */

static void sum_groups(double to[2], const float *values, const struct state_weights *w, int groups)
{
    to[0] = to[1] = 0;
    for (int g = 0; g < groups; g++) {
        const double y = (double)luminance_of(values + 3 * (size_t)g);
        to[0] += w->relative[g] * y;
        to[1] += w->absolute[g] * y;
    }
}

enum status level_patches_sum(double (*to)[2], const struct level_light *l, const struct state_weights *w,
                              struct err *err)
{
    const int count = l->patches.count, groups = l->groups.count;
    const size_t stride = 3 * (size_t)groups;
    double(*radiance)[2] = malloc(((size_t)count + 1) * sizeof *radiance);
    if (!radiance) return err_nomem(err, "patches", (size_t)count * sizeof *radiance);
    for (int i = 0; i < count; i++) {
        sum_groups(radiance[i], l->radiosity.radiance + stride * (size_t)i, w, groups);
        sum_groups(to[i], l->rows.direct + stride * (size_t)i, w, groups);
    }
    for (int i = 0; i < count; i++) {
        const struct light_row *row = &l->rows.rows[i];
        for (int e = 0; e < row->count; e++)
            for (int k = 0; k < 2; k++)
                to[i][k] += PI * (double)row->entries[e].share * radiance[row->entries[e].patch][k];
    }
    free(radiance);
    return ST_OK;
}

void level_patch_direct(double to[2], const struct level_light *l, int patch, const struct state_weights *w)
{
    sum_groups(to, l->rows.direct + 3 * (size_t)l->groups.count * (size_t)patch, w, l->groups.count);
}

void level_patch_groups(float *whole, float *direct, const struct level_light *l, int patch, int count)
{
    const size_t stride = 3 * (size_t)l->groups.count;
    const struct light_row *row = &l->rows.rows[patch];
    for (int k = 0; k < count; k++) {
        const float *own = l->rows.direct + stride * (size_t)patch + 3 * (size_t)k;
        double sum = 0;
        for (int e = 0; e < row->count; e++) {
            const float *from = l->radiosity.radiance + stride * (size_t)row->entries[e].patch + 3 * (size_t)k;
            sum += (double)row->entries[e].share * (double)luminance_of(from);
        }
        direct[k] = luminance_of(own);
        whole[k] = direct[k] + (float)(PI * sum);
    }
}
