/* relit_light.c - see relit_light.h.
 *
 * Overview. Patches that a pixel of a photograph takes its light from are places. Of each group of light their
 * irradiance is pi B / rho, B the radiance that the solve gave them and rho their reflectance; of the group `rest` that
 * counts what they send out by themselves, so that it goes with that group. Where rho is near 0 it is gathered.
 *
 * Computed skies - the overcast one, three at each hour of some days, and those of states - are taken apart by window,
 * and those of a window into few parts (sky_basis.h), which places and points of plans share. The sun's direct light is
 * left out of them: a picture of half the size says for each hour where it shines, by a ray a pixel, and through which
 * window, so that blinds act on it. */
#include "stages/light_levels/relit_light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/image/photo.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"
#include "stages/light_levels/rows.h"
#include "stages/light_levels/sky_basis.h"

enum { QUALITY = 85, ROWS = 8, PLACES = 32 };
static const double LEAST_REFLECTANCE = 0.01, LEAST_LIGHT = 0.02, TOLERANCE = 0.002; /* LEAST_LIGHT: of the median */

void relit_light_release(struct relit_light *r)
{
    for (int i = 0; i < r->field_count; i++) free(r->fields[i].values);
    for (int i = 0; i < r->lamp_count; i++) free(r->lamps[i].name);
    for (int i = 0; r->windows && i < r->window_count; i++) free(r->windows[i]);
    for (int i = 0; i < r->sky_count; i++) free(r->skies[i].mixes);
    for (int i = 0; i < r->face_count; i++) free(r->faces[i].places);
    for (int i = 0; i < r->photo_count; i++) {
        struct relit_photo *p = &r->photos[i];
        for (int k = 0; p->shades && k < r->shade_count; k++) free(p->shades[k]);
        free(p->shades);
        free(p->name);
        free(p->rays);
        free(p->pixels);
        free(p->jpeg);
    }
    for (int k = 0; r->shades && k < r->shade_count; k++) free(r->shades[k]);
    free(r->shades);
    free(r->normals);
    free(r->fields);
    free(r->lamps);
    free(r->windows);
    free(r->skies);
    free(r->faces);
    free(r->photos);
    *r = (struct relit_light){.places = 0};
}

/* ------------------------------------------------------------------------------------------------------------ skies */

int relit_light_first_part(const struct relit_light *r, int window, int *count)
{
    int first = 0;
    *count = 0;
    for (int i = 0; i < r->field_count; i++) {
        if (r->fields[i].kind != RELIT_PART) continue;
        first += r->fields[i].of < window;
        *count += r->fields[i].of == window;
    }
    return first;
}

static bool same_sky(const struct light_state *a, const struct light_state *b)
{
    const double apart = a->sky == STATE_SKY_WEATHER ? 0.5 : 1e-3; /* weather is that of an hour */
    if (a->sky != b->sky || (a->sky == STATE_SKY_TIME && a->cover != b->cover)) return false;
    return a->sky == STATE_SKY_OVERCAST ||
           (a->time.month == b->time.month && a->time.day == b->time.day && fabs(a->time.hour - b->time.hour) <= apart);
}

int relit_light_find_sky(const struct relit_light *r, const struct light_state *state)
{
    for (int i = 0; i < r->sky_count; i++)
        if (same_sky(&r->skies[i].state, state)) return i;
    return -1;
}

static enum status add_sky(struct relit_light *r, const struct light_state *state, struct err *err)
{
    if (relit_light_find_sky(r, state) >= 0) return ST_OK;
    if (array_append(&r->skies, (size_t)r->sky_count, sizeof *r->skies, "skies", err)) return err->status;
    struct relit_sky *sky = &r->skies[r->sky_count++];
    *sky = (struct relit_sky){.state = *state, .shade = -1};
    sky->state.name = NULL;
    sky->state.named = sky->state.blinds = NULL;
    sky->state.named_count = sky->state.blind_count = 0;
    sky->state.lamps = false;
    return ST_OK;
}

static enum status list_skies(struct relit_light *r, const struct relit_sources *from, struct err *err)
{
    const struct light_state overcast = {.sky = STATE_SKY_OVERCAST, .horizontal = STATE_OVERCAST_LUX};
    add_sky(r, &overcast, err);
    for (int i = 0; !err->status && i < LEVEL_COVERS * from->days->hour_count; i++) {
        const struct light_state hour = {.sky = STATE_SKY_TIME,
                                         .cover = (enum sky_cover)(i % LEVEL_COVERS),
                                         .time = from->days->hours[i / LEVEL_COVERS].time};
        add_sky(r, &hour, err);
    }
    for (int i = 0; !err->status && i < from->states->count; i++) {
        const enum state_sky sky = from->states->items[i].sky;
        if (sky == STATE_SKY_TIME || sky == STATE_SKY_WEATHER) add_sky(r, &from->states->items[i], err);
    }
    return err->status;
}

/* Gives suns of one direction a number, and sets the sun of each sky. */
static void number_suns(struct relit_light *r, const struct state_weights *weights)
{
    for (int i = 0; i < r->sky_count; i++) {
        struct relit_sky *sky = &r->skies[i];
        sky->horizontal = weights[i].horizontal;
        sky->sun = weights[i].sun;
        sky->to_sun = weights[i].to_sun;
        if (!(sky->sun > 0)) continue;
        for (int k = 0; k < i && sky->shade < 0; k++)
            if (r->skies[k].shade >= 0 && vec3_length(vec3_sub(r->skies[k].to_sun, sky->to_sun)) < 1e-9)
                sky->shade = r->skies[k].shade;
        if (sky->shade < 0) sky->shade = r->shade_count++;
    }
}

/* ----------------------------------------------------------------------------------------------------------- places */

/* Numbers of patches and faces, -1 where no photograph shows them. */
struct numbering {
    int *place, *patch; /* of each patch its place; of each place its patch */
    int *face;
};

static void take_place(struct numbering *n, int patch)
{
    if (patch >= 0) n->place[patch] = 1;
}

/* The four cells of a face around a point. */
static void take_cells(struct numbering *n, const struct patch_cells *c, struct vec3 at)
{
    const double x = (vec3_dot(c->u, at) - c->low[0]) / c->step[0] - 0.5;
    const double y = (vec3_dot(c->v, at) - c->low[1]) / c->step[1] - 0.5;
    for (int i = 0; i < 4; i++) {
        const int column = (int)clamp(floor(x) + (i & 1), 0, c->columns - 1);
        const int row = (int)clamp(floor(y) + (i >> 1), 0, c->rows - 1);
        take_place(n, c->patch[row * c->columns + column]);
    }
}

static struct vec3 ray_of(const struct level_pixel *p)
{
    return vec3_make((double)p->ray[0], (double)p->ray[1], (double)p->ray[2]);
}

static struct vec3 point_of(const struct level_view *v, const struct level_pixel *p)
{
    return vec3_add(v->from, vec3_scale(ray_of(p), (double)p->away));
}

static void number_places(struct relit_light *r, struct numbering *n, const struct relit_sources *from)
{
    const struct light_patches *p = &from->light->patches;
    for (int k = 0; k < from->views->count; k++) {
        const struct level_view *v = &from->views->list[k];
        for (int i = 0; i < v->width * v->height; i++) {
            const struct level_pixel *pixel = &v->pixels[i];
            if (pixel->surface == NO_PHOTO || pixel->surface == -1) continue;
            if (pixel->surface < 0)
                take_place(n, -2 - pixel->surface);
            else if (p->cells[pixel->surface].patch) {
                n->face[pixel->surface] = 1;
                take_cells(n, &p->cells[pixel->surface], point_of(v, pixel));
            }
        }
    }
    for (int i = 0; i < p->count; i++) {
        if (i == p->face_patches) r->things = r->places;
        if (n->place[i] < 0) continue;
        n->patch[r->places] = i;
        n->place[i] = r->places++;
    }
    if (p->face_patches == p->count) r->things = r->places;
    for (int f = 0; f < p->field->model.mesh.face_count; f++)
        if (n->face[f] >= 0) n->face[f] = r->face_count++;
}

static enum status make_faces(struct relit_light *r, const struct numbering *n, const struct light_patches *p,
                              struct err *err)
{
    const int faces = r->face_count;
    r->faces = calloc((size_t)faces + 1, sizeof *r->faces);
    r->normals = calloc((size_t)(r->places - r->things) + 1, sizeof *r->normals);
    if (!r->faces || !r->normals) return err_nomem(err, "faces", (size_t)faces * sizeof *r->faces);
    for (int i = r->things; i < r->places; i++) r->normals[i - r->things] = p->list[n->patch[i]].origins[0].normal;
    for (int f = 0; f < p->field->model.mesh.face_count; f++) {
        if (n->face[f] < 0) continue;
        const struct patch_cells *c = &p->cells[f];
        struct relit_face *to = &r->faces[n->face[f]];
        const struct vec3 normal = p->field->model.mesh.faces[f].normal;
        const int cells = c->columns * c->rows;
        *to = (struct relit_face){normal,
                                  c->u,
                                  c->v,
                                  0,
                                  {c->low[0], c->low[1]},
                                  {c->step[0], c->step[1]},
                                  c->columns,
                                  c->rows,
                                  malloc(((size_t)cells + 1) * sizeof *to->places)};
        if (!to->places) return err_nomem(err, "cells", (size_t)cells * sizeof *to->places);
        for (int i = 0; i < cells; i++) {
            to->places[i] = c->patch[i] < 0 ? -1 : n->place[c->patch[i]];
            if (c->patch[i] >= 0) to->offset = vec3_dot(normal, p->list[c->patch[i]].origins[0].at);
        }
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ light */

/* The irradiance of a place from a range of groups; beams: without what comes directly. to[3 * groups]. */
static void place_light(float *to, const struct level_light *l, int patch, int first, int end)
{
    const size_t stride = 3 * (size_t)l->groups.count;
    const float *radiance = l->radiosity.radiance + stride * (size_t)patch,
                *direct = l->rows.direct + stride * (size_t)patch;
    const struct rgb *rho = &l->colours[patch].reflectance;
    const double reflects[3] = {rho->r, rho->g, rho->b};
    const struct light_row *row = &l->rows.rows[patch];
    bool dark = false;
    for (int c = 0; c < 3; c++) dark |= !(reflects[c] >= LEAST_REFLECTANCE);
    for (int g = first; g < end; g++)
        for (int c = 0; c < 3; c++) {
            const size_t at = 3 * (size_t)g + (size_t)c;
            to[3 * (g - first) + c] =
                reflects[c] >= LEAST_REFLECTANCE ? (float)(PI / reflects[c] * (double)radiance[at]) : direct[at];
        }
    for (int e = 0; dark && e < row->count; e++) {
        const float *other = l->radiosity.radiance + stride * (size_t)row->entries[e].patch;
        for (int g = first; g < end; g++)
            for (int c = 0; c < 3; c++)
                if (!(reflects[c] >= LEAST_REFLECTANCE))
                    to[3 * (g - first) + c] += (float)PI * row->entries[e].share * other[3 * (size_t)g + (size_t)c];
    }
    for (int g = first; g < end; g++)
        for (int c = 0; g >= l->groups.beam && g < l->groups.planned && c < 3; c++)
            to[3 * (g - first) + c] = fmaxf(0, to[3 * (g - first) + c] - direct[3 * (size_t)g + (size_t)c]);
}

struct making {
    struct relit_light *r;
    const struct relit_sources *from;
    const struct numbering *n;
    const struct state_weights *weights; /* of each sky */
    float *values;                       /* of each sky and row */
    int window;
};

static size_t rows_of(const struct relit_light *r) { return 3 * (size_t)r->places + (size_t)r->points; }

static enum status add_field(struct relit_light *r, enum relit_kind kind, int of, const float *values, struct err *err)
{
    const size_t rows = rows_of(r);
    if (array_append(&r->fields, (size_t)r->field_count, sizeof *r->fields, "fields", err)) return err->status;
    struct relit_field *f = &r->fields[r->field_count];
    *f = (struct relit_field){kind, of, malloc((rows + 1) * sizeof *f->values)};
    if (!f->values) return err_nomem(err, "light of places", rows * sizeof *f->values);
    memcpy(f->values, values, rows * sizeof *values);
    r->field_count++;
    return ST_OK;
}

/* Adds a group to the values of all rows. */
static void add_group(float *values, const struct making *m, int group)
{
    const struct relit_light *r = m->r;
    for (int i = 0; i < r->places; i++) {
        float own[3];
        place_light(own, m->from->light, m->n->patch[i], group, group + 1);
        for (int c = 0; c < 3; c++) values[3 * i + c] += own[c];
    }
    for (int k = 0; k < r->points; k++)
        values[3 * r->places + k] +=
            m->from->points->whole[(size_t)m->from->chosen[k] * (size_t)m->from->points->groups + (size_t)group];
}

static enum status add_groups(const struct making *m, enum relit_kind kind, int of, const int *groups, int count,
                              struct err *err)
{
    float *values = calloc(rows_of(m->r) + 1, sizeof *values);
    if (!values) return err_nomem(err, "light of places", rows_of(m->r) * sizeof *values);
    for (int k = 0; k < count; k++) add_group(values, m, groups[k]);
    add_field(m->r, kind, of, values, err);
    free(values);
    return err->status;
}

/* The sum of lamps and windows, in which the photographs were taken; without black places. Relit photographs also show
 * the lamps that the edit adds. */
static enum status add_texture(struct relit_light *r, bool relit, struct err *err)
{
    float *values = calloc(rows_of(r) + 1, sizeof *values);
    struct weighted *room = malloc(((size_t)r->places + 1) * sizeof *room);
    if (!values || !room) err_nomem(err, "light of places", rows_of(r) * sizeof *values);
    for (int i = 0; !err->status && i < r->field_count; i++) {
        const struct relit_field *f = &r->fields[i];
        const struct relit_lamp *planned =
            f->kind == RELIT_LAMP && r->lamps[f->of].kind == RELIT_PLANNED ? &r->lamps[f->of] : NULL;
        if (planned && !(relit && planned->on && r->scale > 0)) continue;
        const float by = planned ? (float)(1 / r->scale) : 1;
        for (int k = 0; k < 3 * r->places; k++) values[k] += by * f->values[k];
    }
    for (int i = 0; !err->status && i < r->places; i++) room[i] = (struct weighted){(double)values[3 * i + 1], 1};
    const double median = !err->status && r->places ? weighted_percentile(room, (size_t)r->places, 0.5) : 0;
    const float least = median > 0 ? (float)(LEAST_LIGHT * median) : 1;
    for (int k = 0; !err->status && k < 3 * r->places; k++) values[k] = fmaxf(values[k], least);
    if (!err->status) add_field(r, RELIT_TEXTURE, 0, values, err);
    free(values);
    free(room);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------- computed skies */

static double sum_sky(const struct state_weights *w, const struct light_groups *g, int window, const float *light,
                      int stride)
{
    const double *patches = w->absolute + groups_patch(g, window, 0), *beams = w->absolute + groups_beam(g, window, 0);
    double sum = 0;
    for (int k = 0; k < g->patches.count; k++) sum += patches[k] * (double)light[k * stride];
    for (int k = 0; k < g->patches.count; k++)
        if (beams[k] > 0) sum += beams[k] * (double)light[(g->patches.count + k) * stride];
    return sum;
}

static void sum_places(void *ctx, size_t begin, size_t end, int thread)
{
    const struct making *m = ctx;
    const struct light_groups *g = &m->from->light->groups;
    const int parts = g->patches.count, first = groups_patch(g, m->window, 0), beams = groups_beam(g, m->window, 0);
    const size_t rows = rows_of(m->r);
    float *own = malloc(6 * (size_t)parts * sizeof *own);
    (void)thread;
    for (size_t i = begin; own && i < end; i++) {
        place_light(own, m->from->light, m->n->patch[i], first, first + parts);
        place_light(own + 3 * parts, m->from->light, m->n->patch[i], beams, beams + parts);
        for (int s = 0; s < m->r->sky_count; s++)
            for (int c = 0; c < 3; c++)
                m->values[(size_t)s * rows + 3 * i + (size_t)c] =
                    (float)sum_sky(&m->weights[s], g, m->window, own + c, 3);
    }
    free(own);
}

static void sum_points(const struct making *m)
{
    const struct light_groups *g = &m->from->light->groups;
    const int parts = g->patches.count;
    const size_t rows = rows_of(m->r);
    float own[2 * 146];
    for (int k = 0; k < m->r->points; k++) {
        const float *whole = m->from->points->whole + (size_t)m->from->chosen[k] * (size_t)m->from->points->groups;
        memcpy(own, whole + groups_patch(g, m->window, 0), (size_t)parts * sizeof *own);
        memcpy(own + parts, whole + groups_beam(g, m->window, 0), (size_t)parts * sizeof *own);
        for (int s = 0; s < m->r->sky_count; s++)
            m->values[(size_t)s * rows + 3 * (size_t)m->r->places + (size_t)k] =
                (float)sum_sky(&m->weights[s], g, m->window, own, 1);
    }
}

static enum status add_window_skies(struct making *m, double *mixes[], struct err *err)
{
    struct relit_light *r = m->r;
    const size_t rows = rows_of(r);
    struct sky_basis basis;
    parallel_for((size_t)r->places, PLACES, sum_places, m);
    sum_points(m);
    if (!sky_basis_make(&basis, m->values, (int)rows, r->sky_count, TOLERANCE, err) && basis.count &&
        !add_field(r, RELIT_LEVEL, m->window, basis.level, err)) {
        for (int k = 0; !err->status && k < basis.count; k++)
            add_field(r, RELIT_PART, m->window, basis.parts + (size_t)k * rows, err);
        for (int s = 0; !err->status && s < r->sky_count; s++)
            for (int k = 0; k < basis.count; k++) mixes[s][r->part_count + k] = basis.mixes[s * basis.count + k];
        r->part_count += basis.count;
    }
    sky_basis_release(&basis);
    return err->status;
}

static enum status add_skies(struct making *m, struct err *err)
{
    struct relit_light *r = m->r;
    const size_t values = rows_of(r) * (size_t)r->sky_count;
    double **mixes = calloc((size_t)r->sky_count + 1, sizeof *mixes);
    m->values = calloc(values + 1, sizeof *m->values);
    if (!mixes || !m->values) err_nomem(err, "light of skies", values * sizeof *m->values);
    for (int s = 0; !err->status && s < r->sky_count; s++) {
        mixes[s] = r->skies[s].mixes = calloc((size_t)r->window_count * SKY_PARTS + 1, sizeof **mixes);
        if (!mixes[s]) err_nomem(err, "light of skies", (size_t)r->window_count * SKY_PARTS * sizeof **mixes);
    }
    for (m->window = 0; !err->status && m->window < r->window_count; m->window++) add_window_skies(m, mixes, err);
    free(m->values);
    free(mixes);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ suns */

struct shading {
    const struct relit_sources *from;
    const struct level_view *view;
    int *to;
    struct vec3 to_sun;
};

/* 1 + the window through which the sun shines at a point; 0: none. */
static int shade_at(const struct light_groups *g, struct gather_point p, struct vec3 to_sun)
{
    return rows_sees_sun(g->field, p, to_sun) ? 1 + groups_window(g, p.at, to_sun) : 0;
}

static void shade_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct shading *s = ctx;
    const struct light_patches *p = &s->from->light->patches;
    const int width = s->view->width / 2;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < width; x++) {
            const struct level_pixel *pixel = &s->view->pixels[2 * (int)y * s->view->width + 2 * x];
            int *to = &s->to[(int)y * width + x];
            if (pixel->surface == NO_PHOTO || pixel->surface == -1) continue;
            const struct gather_point at = {point_of(s->view, pixel),
                                            pixel->surface >= 0 ? p->field->model.mesh.faces[pixel->surface].normal
                                                                : p->list[-2 - pixel->surface].origins[0].normal};
            *to = shade_at(&s->from->light->groups, at, s->to_sun);
        }
}

/* The direction of a number. */
static struct vec3 sun_of(const struct relit_light *r, int shade)
{
    for (int i = 0; i < r->sky_count; i++)
        if (r->skies[i].shade == shade) return r->skies[i].to_sun;
    return vec3_make(0, 0, -1);
}

static enum status shade_points(struct relit_light *r, const struct relit_sources *from, struct err *err)
{
    r->shades = calloc((size_t)r->shade_count + 1, sizeof *r->shades);
    if (!r->shades) return err_nomem(err, "hours", (size_t)r->shade_count * sizeof *r->shades);
    for (int k = 0; k < r->shade_count; k++) {
        r->shades[k] = calloc((size_t)r->points + 1, sizeof **r->shades);
        if (!r->shades[k]) return err_nomem(err, "hours", (size_t)r->points * sizeof **r->shades);
        for (int i = 0; i < r->points; i++)
            r->shades[k][i] = shade_at(&from->light->groups, from->points->points[from->chosen[i]], sun_of(r, k));
    }
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------------- photos */

int relit_light_lens_size(int pixels) { return (pixels - 2 + RELIT_LENS) / RELIT_LENS + 1; }

static void take_rays(struct relit_photo *to, const struct level_view *v)
{
    const int columns = relit_light_lens_size(v->width), rows = relit_light_lens_size(v->height);
    for (int i = 0; i < columns * rows; i++) {
        const int x = (int)fmin(RELIT_LENS * (i % columns), v->width - 1);
        const int y = (int)fmin(RELIT_LENS * (double)(i / columns), v->height - 1);
        memcpy(to->rays + 3 * i, v->pixels[y * v->width + x].ray, sizeof v->pixels->ray);
    }
}

static int lamp_at(const struct model_field *f, const struct level_view *v, const struct level_pixel *p)
{
    double at;
    const struct lamp *lamp = model_field_lamp(f, v->from, ray_of(p), (double)p->away, &at);
    return lamp ? (int)(lamp - f->lights.lamps) : -1;
}

static int number_of_pixel(const struct relit_light *r, const struct making *m, const struct level_view *v,
                           const struct level_pixel *p)
{
    const struct light_patches *patches = &m->from->light->patches;
    const int lamps = 1 + r->window_count, faces = lamps + r->lamp_count, things = faces + r->face_count;
    if (p->surface == NO_PHOTO) return 0;
    if (p->surface == -1) return 1 + groups_window(&m->from->light->groups, v->from, ray_of(p));
    const int lamp = lamp_at(patches->field, v, p);
    if (lamp >= 0) return lamps + lamp;
    if (p->surface < 0) return things + m->n->place[-2 - p->surface] - r->things;
    return m->n->face[p->surface] < 0 ? 0 : faces + m->n->face[p->surface];
}

static enum status make_photo(struct relit_photo *to, const struct making *m, const struct level_view *v,
                              struct err *err)
{
    const struct relit_light *r = m->r;
    const size_t pixels = (size_t)v->width * (size_t)v->height;
    const size_t rays = (size_t)relit_light_lens_size(v->width) * (size_t)relit_light_lens_size(v->height);
    *to = (struct relit_photo){.name = strdup(v->name),
                               .width = v->width,
                               .height = v->height,
                               .from = v->from,
                               .rays = malloc(3 * rays * sizeof *to->rays),
                               .pixels = malloc(pixels * sizeof *to->pixels),
                               .shades = calloc((size_t)r->shade_count + 1, sizeof *to->shades)};
    if (!to->name || !to->rays || !to->pixels || !to->shades)
        return err_nomem(err, "a photo", pixels * sizeof *to->pixels);
    take_rays(to, v);
    for (size_t i = 0; i < pixels; i++) to->pixels[i] = number_of_pixel(r, m, v, &v->pixels[i]);
    for (int k = 0; k < r->shade_count; k++) {
        struct shading s = {m->from, v, to->shades[k] = calloc(pixels / 4 + 1, sizeof **to->shades), sun_of(r, k)};
        if (!s.to) return err_nomem(err, "a photo", pixels / 4 * sizeof *s.to);
        parallel_for((size_t)v->height / 2, ROWS, shade_rows, &s);
    }
    return jpeg_encode(&to->jpeg, &to->jpeg_size, v->photo, v->width, v->height, QUALITY, err);
}

static enum status make_photos(const struct making *m, struct err *err)
{
    const struct level_views *views = m->from->views;
    m->r->photos = calloc((size_t)views->count + 1, sizeof *m->r->photos);
    if (!m->r->photos) return err_nomem(err, "photos", (size_t)views->count * sizeof *m->r->photos);
    for (int i = 0; !err->status && i < views->count; i++)
        make_photo(&m->r->photos[m->r->photo_count++], m, &views->list[i], err);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ names */

static enum status add_lamp(struct relit_light *r, enum relit_lamp_kind kind, const char *name, struct err *err)
{
    struct relit_lamp *lamp = &r->lamps[r->lamp_count];
    *lamp = (struct relit_lamp){kind, strdup(name), false};
    if (!lamp->name) return err_nomem(err, "a name", strlen(name));
    r->lamp_count++;
    return ST_OK;
}

static enum status name_groups(struct relit_light *r, const struct light_groups *g, struct err *err)
{
    const int planned = g->count - g->planned;
    r->lamps = calloc((size_t)g->rest + (size_t)planned + 2, sizeof *r->lamps);
    r->windows = calloc((size_t)g->windows_count + 1, sizeof *r->windows);
    if (!r->lamps || !r->windows) return err_nomem(err, "lamps", (size_t)g->rest * sizeof *r->lamps);
    for (int i = 0; !err->status && i < g->rest; i++) add_lamp(r, RELIT_FITTED, g->field->lights.lamps[i].name, err);
    if (!err->status) add_lamp(r, RELIT_REST, "", err);
    for (int i = 0; !err->status && i < planned; i++)
        if (!add_lamp(r, RELIT_PLANNED, g->planned_lamps->list[i].name, err))
            r->lamps[r->lamp_count - 1].on = g->planned_lamps->list[i].on;
    for (int v = 0; !err->status && v < g->windows_count; v++) {
        if (!(r->windows[v] = strdup(g->windows[v].name))) return err_nomem(err, "a name", strlen(g->windows[v].name));
        r->window_count++;
    }
    return err->status;
}

/* The irradiance of the horizontal outdoors. */
static double photographed_horizontal(const struct light_groups *g)
{
    double sum = 0;
    for (int k = SKY_GROUND + 1; k < g->patches.count; k++) {
        struct rgb radiance;
        model_field_outdoors(&radiance, g->field, vec3_make(0, 0, 0), sky_patch_direction(&g->patches, k));
        sum += sky_patch_projected(&g->patches, k) * rgb_luminance(radiance);
    }
    return sum;
}

/* The photographs keep their light; switches multiply what was measured. */
static void take_factors(struct relit_light *r, const struct light_groups *g)
{
    for (int i = 0; i < r->field_count; i++) {
        const struct relit_field *f = &r->fields[i];
        const bool is_lamp = f->kind == RELIT_LAMP && r->lamps[f->of].kind != RELIT_PLANNED;
        if (!is_lamp && f->kind != RELIT_WINDOW) continue;
        const float by = (float)g->factors[is_lamp ? f->of : g->sky + f->of];
        for (size_t k = 0; k < rows_of(r); k++) f->values[k] *= by;
    }
}

static enum status add_parts(struct making *m, struct err *err)
{
    struct relit_light *r = m->r;
    const struct light_groups *g = &m->from->light->groups;
    for (int i = 0; !err->status && i < r->lamp_count; i++) {
        const int group = i <= g->rest ? i : g->planned + i - g->rest - 1;
        add_groups(m, RELIT_LAMP, i, &group, 1, err);
    }
    for (int v = 0; !err->status && v < r->window_count; v++) {
        const int groups[] = {g->sky + v, g->sun + v};
        add_groups(m, RELIT_WINDOW, v, groups, 2, err);
    }
    if (!err->status) add_texture(r, m->from->views->relit, err);
    if (!err->status && g->factors) take_factors(r, g);
    return err->status ? err->status : add_skies(m, err);
}

enum status relit_light_make(struct relit_light *r, const struct relit_sources *from, struct err *err)
{
    const struct light_patches *p = &from->light->patches;
    const struct light_groups *g = &from->light->groups;
    const size_t patches = (size_t)p->count + 1, faces = (size_t)p->field->model.mesh.face_count + 1;
    struct numbering n = {malloc(patches * sizeof *n.place), malloc(patches * sizeof *n.patch),
                          malloc(faces * sizeof *n.face)};
    struct state_weights *weights = NULL;
    struct making m = {.r = r, .from = from, .n = &n};
    *r = (struct relit_light){.points = from->chosen_count, .scale = from->scale};
    if (!n.place || !n.patch || !n.face) {
        err_nomem(err, "patches", patches * sizeof *n.place);
    } else {
        memset(n.place, -1, patches * sizeof *n.place);
        memset(n.face, -1, faces * sizeof *n.face);
        number_places(r, &n, from);
    }
    if (!err->status && !name_groups(r, g, err) && !make_faces(r, &n, p, err) && !list_skies(r, from, err)) {
        r->horizontal = photographed_horizontal(g);
        m.weights = weights = calloc((size_t)r->sky_count + 1, sizeof *weights);
        if (!weights) err_nomem(err, "skies", (size_t)r->sky_count * sizeof *weights);
    }
    for (int s = 0; !err->status && s < r->sky_count; s++)
        level_weights_make(&weights[s], &r->skies[s].state, from->states, g, from->params, err);
    if (!err->status) {
        number_suns(r, weights);
        if (!add_parts(&m, err) && !shade_points(r, from, err)) make_photos(&m, err);
    }
    for (int s = 0; weights && s < r->sky_count; s++) level_weights_release(&weights[s]);
    free(weights);
    free(n.place);
    free(n.patch);
    free(n.face);
    return err->status;
}
