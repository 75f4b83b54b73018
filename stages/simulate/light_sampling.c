/* light_sampling.c - sampling of lamps, windows and the sun.
 *
 * Square lamps and windows are sampled uniformly over the solid angle that they subtend [Urena 2013]; below
 * MIN_SOLID_ANGLE, where that loses precision, over their area. Disks are sampled over their area, the sun over its
 * cone. A place that several points share is uniform over the area, so that its density from each of them is simple.
 *
 * The probability of a light is in proportion to its luminance, times the solid angle of its area seen from the point,
 * times the cosine at the surface, each roughly estimated. Any positive probability gives the same expectation; the
 * estimate only sets the noise. Zero is exact: below the horizon, behind a lamp, outside the circle that a spot can
 * light. */
#include "stages/simulate/light_sampling.h"

#include <math.h>
#include <stdlib.h>

#include "common/light/fast.h"
#include "common/light/frame.h"
#include "common/math/numbers.h"

#define MIN_SOLID_ANGLE   1e-4 /* sr */
#define HIDDEN_SUN_FACTOR 0.05 /* of the estimate, if the sun is visible through no window */

/* --------------------------------------------------------------------------------------------- spherical rectangles */

/* A rectangle in the frame of a point: x0..x1 and y0..y1 along its edges, at z0 < 0; notation of [Urena 2013]. */
struct spherical {
    struct vec3 z;
    double x0, x1, y0, y1, z0, b0, b1, k, solid;
};

static struct spherical spherical_make(const struct scene_light *l, struct vec3 point)
{
    struct spherical q = {.z = vec3_cross(l->x, l->y)};
    const struct vec3 d = vec3_sub(l->corner, point);
    q.z0 = vec3_dot(d, q.z);
    if (q.z0 > 0) {
        q.z = vec3_scale(q.z, -1);
        q.z0 = -q.z0;
    }
    q.x0 = vec3_dot(d, l->x), q.x1 = q.x0 + l->width;
    q.y0 = vec3_dot(d, l->y), q.y1 = q.y0 + l->height;
    /* z components of the normals of the planes through the point and an edge */
    const double zz = q.z0 * q.z0;
    const double n0 = -q.y0 / sqrt(zz + q.y0 * q.y0), n1 = q.x1 / sqrt(zz + q.x1 * q.x1);
    const double n2 = q.y1 / sqrt(zz + q.y1 * q.y1), n3 = -q.x0 / sqrt(zz + q.x0 * q.x0);
    q.b0 = n0;
    q.b1 = n2;
    q.k = 2 * PI - acos(clamp(-n2 * n3, -1, 1)) - acos(clamp(-n3 * n0, -1, 1));
    q.solid = acos(clamp(-n0 * n1, -1, 1)) + acos(clamp(-n1 * n2, -1, 1)) - q.k;
    return q;
}

/* The vector from the point to a sample on the rectangle. */
static struct vec3 spherical_sample(const struct spherical *q, const struct scene_light *l, double u, double v)
{
    const double a = u * q->solid + q->k, f = (cos(a) * q->b0 - q->b1) / sin(a);
    const double c = clamp((f > 0 ? 1 : -1) / sqrt(f * f + q->b0 * q->b0), -1, 1);
    const double x = clamp(-c * q->z0 / sqrt(fast_max(1e-300, 1 - c * c)), q->x0, q->x1);
    const double dd = x * x + q->z0 * q->z0;
    const double h0 = q->y0 / sqrt(dd + q->y0 * q->y0), h1 = q->y1 / sqrt(dd + q->y1 * q->y1), h = h0 + v * (h1 - h0);
    const double y = h * h < 1 - 1e-12 ? clamp(h * sqrt(dd / (1 - h * h)), q->y0, q->y1) : q->y1;
    return vec3_add(vec3_add(vec3_scale(l->x, x), vec3_scale(l->y, y)), vec3_scale(q->z, q->z0));
}

/* Density per solid angle; `to`: from the point to the sample. */
static double rectangle_pdf(const struct scene_light *l, const struct spherical *q, struct vec3 to)
{
    if (q->solid > MIN_SOLID_ANGLE) return 1 / q->solid;
    const double d = vec3_length(to);
    return d * d * d / (l->area * fabs(vec3_dot(to, l->n)));
}

/* --------------------------------------------------------------------------------------------------------- building */

static struct scene_light rectangle(enum light_kind kind, struct vec3 corner, struct vec3 u, struct vec3 v,
                                    struct rgb radiance)
{
    struct scene_light l = {.kind = kind, .corner = corner, .x = vec3_normalize(u), .y = vec3_normalize(v)};
    l.width = vec3_length(u);
    l.height = vec3_length(v);
    l.area = l.width * l.height;
    l.n = vec3_cross(l.x, l.y);
    l.radiance = radiance;
    l.luminance = rgb_luminance(radiance);
    return l;
}

static struct scene_light disk(const struct scene_item *it)
{
    struct scene_light l = {.kind = LIGHT_DISK, .corner = it->at, .n = vec3_normalize(it->u), .radius = it->radius};
    const double half = it->half_angle * PI / 180;
    l.area = PI * l.radius * l.radius;
    l.cos_cone = it->half_angle < 90 ? cos(half) : 0;
    l.tan_cone = it->half_angle < 90 ? tan(half) : 1e30;
    l.exponent = it->exponent;
    l.radiance = it->radiance;
    l.luminance = rgb_luminance(it->radiance);
    return l;
}

/* How many of 64 rays from the middle of a window, to one side of its wall, hit nothing. */
static int count_escaping(const struct ray_scene *rays, struct vec3 middle, struct vec3 n, double depth)
{
    int count = 0;
    struct vec3 x, y;
    frame_from_normal(n, &x, &y);
    for (int i = 0; i < 64; i++) {
        const double cos_t = (i + 0.5) / 64, sin_t = sqrt(1 - cos_t * cos_t), phi = 2.399963 * i; /* golden angle */
        const struct vec3 d =
            vec3_add(vec3_scale(n, cos_t), vec3_add(vec3_scale(x, sin_t * cos(phi)), vec3_scale(y, sin_t * sin(phi))));
        count += !ray_scene_blocked(rays, vec3_add(middle, vec3_scale(n, depth + rays->epsilon)), d, INFINITY);
    }
    return count;
}

/* The portal lies in the outer face of the wall, so that the reveals are inside. Outdoors is the side on which more
 * rays hit nothing. */
static struct scene_light window(const struct scene_item *it, const struct scene_item *wall, const struct sky *sky,
                                 const struct scene_geometry *g)
{
    struct vec3 along, left;
    double length;
    geometry_wall_axes(wall, &along, &left, &length);
    const double depth = wall->thickness / 2;
    const struct vec3 u = vec3_scale(along, it->s1 - it->s0), v = {0, 0, it->z1 - it->z0};
    const struct vec3 corner = vec3_add(vec3_make(wall->x0, wall->y0, it->z0), vec3_scale(along, it->s0));
    const struct vec3 middle = vec3_add(corner, vec3_scale(vec3_add(u, v), 0.5)), right = vec3_scale(left, -1);
    const struct rgb seen = rgb_add(rgb_scale(sky->panorama.sky, 0.6), rgb_scale(sky->panorama.ground, 0.4));
    if (count_escaping(&g->rays, middle, left, depth) >
        count_escaping(&g->rays, middle, right, depth)) /* u x v points to the right */
        return rectangle(LIGHT_WINDOW, vec3_add(corner, vec3_scale(left, depth)), u, v, seen);
    return rectangle(LIGHT_WINDOW, vec3_add(vec3_add(corner, u), vec3_scale(right, depth)), vec3_scale(u, -1), v, seen);
}

enum status lights_init(struct lights *l, const struct scene *s, const struct scene_geometry *g, struct err *err)
{
    *l = (struct lights){0};
    sky_init(&l->sky, &s->sky);
    if (!(l->of_face = malloc((size_t)(g->face_count + 1) * sizeof *l->of_face)))
        return err_nomem(err, "lights", (size_t)g->face_count * sizeof *l->of_face);
    for (int i = 0; i < g->face_count; i++) l->of_face[i] = -1;
    for (int i = 0; !err->status && i < s->item_count; i++) {
        const struct scene_item *it = &s->items[i];
        const bool lamp = it->kind == ITEM_LAMP_QUAD || it->kind == ITEM_LAMP_DISK;
        if (!lamp && (it->kind != ITEM_WINDOW || !(s->sky.has_panorama || s->sky.has_sun))) continue;
        if (l->count == MAX_LIGHTS - 1) { /* the last entry is for the sun */
            err_set(err, ST_DATA, "the scene has more than %d lamps and windows; remove some.", l->count);
            break;
        }
        if (lamp) l->of_face[g->lamp_faces[i]] = l->count;
        l->list[l->count++] = it->kind == ITEM_WINDOW      ? window(it, &s->items[it->wall], &l->sky, g)
                              : it->kind == ITEM_LAMP_DISK ? disk(it)
                                                           : rectangle(LIGHT_QUAD, it->at, it->u, it->v, it->radiance);
    }
    if (!err->status && s->sky.has_sun) {
        struct scene_light sun = {
            .kind = LIGHT_SUN, .n = l->sky.to_sun, .cos_cone = l->sky.sun_cos, .radiance = s->sky.sun.radiance};
        sun.tan_cone = tan(s->sky.sun.angular_radius * PI / 180);
        sun.area = 2 * PI * (1 - sun.cos_cone); /* sr */
        sun.luminance = rgb_luminance(sun.radiance);
        l->list[l->count++] = sun;
    }
    if (err->status) lights_release(l);
    return err->status;
}

void lights_release(struct lights *l)
{
    if (!l) return;
    free(l->of_face);
    *l = (struct lights){0};
}

/* --------------------------------------------------------------------------------------------------------- sampling */

/* Height of a rectangle's highest corner above the surface. *middle: from the point to the rectangle's middle. */
static double highest_corner(const struct scene_light *l, struct vec3 d, struct vec3 normal, struct vec3 *middle)
{
    const double a = vec3_dot(d, normal), x = l->width * vec3_dot(l->x, normal), y = l->height * vec3_dot(l->y, normal);
    *middle = vec3_add(d, vec3_add(vec3_scale(l->x, l->width / 2), vec3_scale(l->y, l->height / 2)));
    return a + fast_max(0, x) + fast_max(0, y);
}

/* Whether part of the sun's disk is visible from the point through the window. */
static bool window_shows_sun(const struct scene_light *w, const struct scene_light *sun, struct vec3 point)
{
    const double slope = vec3_dot(sun->n, w->n), t = vec3_dot(vec3_sub(w->corner, point), w->n) / slope;
    if (!(t > 0) || !(t < 1e6)) return false;
    const struct vec3 d = vec3_sub(vec3_add(point, vec3_scale(sun->n, t)), w->corner);
    const double x = vec3_dot(d, w->x), y = vec3_dot(d, w->y), margin = t * sun->tan_cone / fast_max(0.05, fabs(slope));
    return x > -margin && x < w->width + margin && y > -margin && y < w->height + margin;
}

/* The estimate that a light's probability is in proportion to; 0: it cannot reach the point. */
static double expected_light(const struct lights *all, const struct scene_light *l, struct vec3 point,
                             struct vec3 normal)
{
    struct vec3 to = vec3_sub(l->corner, point);
    double seen = 0, facing = 0;
    switch (l->kind) {
    case LIGHT_SUN: {
        const double cos_s = vec3_dot(normal, l->n), margin = sqrt(1 - l->cos_cone * l->cos_cone);
        bool window = false, shown = false;
        if (cos_s <= -margin) return 0;
        for (int i = 0; i < all->count && !shown; i++) {
            if (all->list[i].kind != LIGHT_WINDOW) continue;
            window = true;
            shown = window_shows_sun(&all->list[i], l, point);
        }
        return l->luminance * l->area * fast_max(0.05, cos_s) * (window && !shown ? HIDDEN_SUN_FACTOR : 1);
    }
    case LIGHT_DISK: {
        const double h = -vec3_dot(to, l->n), d2 = vec3_dot(to, to), cos_s = vec3_dot(normal, to);
        const double aside2 = fast_max(0, d2 - h * h), reach = l->radius + h * l->tan_cone;
        if (h <= 0 || aside2 >= reach * reach || cos_s <= -l->radius) return 0;
        const double d = sqrt(d2), cos_l = fast_max(h / d, l->cos_cone);
        seen = l->area * cos_l / d2;
        facing = cos_s / d;
        break;
    }
    case LIGHT_QUAD:
    case LIGHT_WINDOW: {
        struct vec3 middle;
        const double h = -vec3_dot(to, l->n);
        if (h <= 0) return 0;
        if (highest_corner(l, to, normal, &middle) <= 0) return 0;
        const double d2 = vec3_dot(middle, middle), d = sqrt(d2);
        seen = l->area * h / (d2 * d);
        facing = vec3_dot(middle, normal) / d;
        break;
    }
    }
    return l->luminance * fast_min(seen, 2 * PI) * fast_max(facing, 0.1);
}

void lights_select(struct light_selection *c, const struct lights *l, struct vec3 point, struct vec3 normal)
{
    double sum = 0;
    c->point = point;
    for (int i = 0; i < l->count; i++) sum += c->probability[i] = expected_light(l, &l->list[i], point, normal);
    for (int i = 0; i < l->count; i++) c->probability[i] = sum > 0 ? c->probability[i] / sum : 0;
}

/* Whether a ray crosses a window; *to: from the point to the crossing. */
static bool crosses_window(const struct scene_light *w, struct vec3 point, struct vec3 direction, struct vec3 *to)
{
    const struct vec3 d = vec3_sub(w->corner, point);
    const double t = vec3_dot(d, w->n) / vec3_dot(direction, w->n);
    if (!(t > 0) || !(t < 1e30)) return false;
    *to = vec3_scale(direction, t);
    const struct vec3 on = vec3_sub(*to, d);
    const double x = vec3_dot(on, w->x), y = vec3_dot(on, w->y);
    return x >= 0 && x <= w->width && y >= 0 && y <= w->height;
}

/* Density of all lights that show the outdoors, except one (-1: none). */
static double sky_pdf_except(const struct lights *l, const struct light_selection *c, struct vec3 direction, int except)
{
    double pdf = 0;
    for (int i = 0; i < l->count; i++) {
        const struct scene_light *light = &l->list[i];
        struct vec3 to;
        if (i == except || !(c->probability[i] > 0)) continue;
        if (light->kind == LIGHT_SUN && vec3_dot(direction, light->n) > light->cos_cone)
            pdf += c->probability[i] / light->area;
        if (light->kind == LIGHT_WINDOW && crosses_window(light, c->point, direction, &to)) {
            const struct spherical q = spherical_make(light, c->point);
            pdf += c->probability[i] * rectangle_pdf(light, &q, to);
        }
    }
    return pdf;
}

double lights_pdf_sky(const struct lights *l, const struct light_selection *c, struct vec3 direction)
{
    return sky_pdf_except(l, c, direction, -1);
}

static double disk_pdf(const struct scene_light *l, struct vec3 to)
{
    const double d = vec3_length(to);
    return d * d * d / (l->area * fabs(vec3_dot(to, l->n)));
}

double lights_pdf_face(const struct lights *l, const struct light_selection *c, const struct ray_hit *hit,
                       struct vec3 direction)
{
    const int i = l->of_face[hit->id];
    if (i < 0 || !(c->probability[i] > 0) || !hit->front) return 0;
    const struct scene_light *light = &l->list[i];
    const struct vec3 to = vec3_scale(direction, vec3_length(vec3_sub(hit->point, c->point)));
    if (light->kind == LIGHT_DISK) return c->probability[i] * disk_pdf(light, to);
    const struct spherical q = spherical_make(light, c->point);
    return c->probability[i] * rectangle_pdf(light, &q, to);
}

static struct rgb emitted(const struct scene_light *l, double cos_l)
{
    if (!(cos_l > 0)) return rgb_grey(0);
    if (l->kind == LIGHT_QUAD) return l->radiance;
    if (cos_l < l->cos_cone) return rgb_grey(0);
    return l->exponent > 0 ? rgb_scale(l->radiance, pow(cos_l, l->exponent)) : l->radiance;
}

struct rgb lights_emitted(const struct lights *l, const struct ray_hit *hit, struct vec3 direction)
{
    const int i = l->of_face[hit->id];
    return i < 0 || !hit->front ? rgb_grey(0) : emitted(&l->list[i], -vec3_dot(direction, hit->normal));
}

/* The index of the light that u chooses; -1: no light has a chance. */
static int choose_light(const struct lights *l, const double chance[MAX_LIGHTS], double u)
{
    int i = 0;
    while (i < l->count && u >= chance[i]) u -= chance[i++];
    if (i < l->count) return i;
    while (i > 0 && !(chance[i - 1] > 0)) i--; /* rounding: take the last light that can be chosen */
    return i - 1;
}

static struct vec3 sun_direction(const struct scene_light *sun, const double u[2])
{
    const double cos_t = 1 - u[0] * (1 - sun->cos_cone);
    return frame_direction(sun->n, sqrt(fast_max(0, 1 - cos_t * cos_t)), cos_t, u[1]);
}

/* The vector from a point to a place on a lamp or window, uniform over its area; d: from the point to its corner. */
static struct vec3 to_area(const struct scene_light *l, struct vec3 d, const double u[2])
{
    if (l->kind == LIGHT_DISK) return vec3_add(d, frame_direction(l->n, l->radius * sqrt(u[0]), 0, u[1]));
    return vec3_add(d, vec3_add(vec3_scale(l->x, u[0] * l->width), vec3_scale(l->y, u[1] * l->height)));
}

bool lights_sample(struct light_sample *s, const struct lights *l, const struct light_selection *c, const double u[3])
{
    const int i = choose_light(l, c->probability, u[0]);
    if (i < 0) return false;
    const struct scene_light *light = &l->list[i];
    if (light->kind == LIGHT_SUN) {
        s->direction = sun_direction(light, u + 1);
        s->pdf = c->probability[i] / light->area + sky_pdf_except(l, c, s->direction, i);
    } else {
        struct vec3 to;
        double pdf;
        if (light->kind == LIGHT_DISK) {
            to = to_area(light, vec3_sub(light->corner, c->point), u + 1);
            pdf = disk_pdf(light, to);
        } else {
            const struct spherical q = spherical_make(light, c->point);
            if (q.solid > MIN_SOLID_ANGLE)
                to = spherical_sample(&q, light, u[1], u[2]);
            else
                to = to_area(light, vec3_sub(light->corner, c->point), u + 1);
            pdf = rectangle_pdf(light, &q, to);
        }
        s->distance = vec3_length(to);
        s->direction = vec3_scale(to, 1 / s->distance);
        s->pdf = c->probability[i] * pdf;
        if (light->kind != LIGHT_WINDOW) {
            s->radiance = emitted(light, -vec3_dot(s->direction, light->n));
            return s->pdf > 0 && rgb_max(s->radiance) > 0;
        }
        s->pdf += sky_pdf_except(l, c, s->direction, i);
    }
    s->distance = INFINITY;
    s->radiance = sky_radiance(&l->sky, s->direction);
    return s->pdf > 0;
}

/* --------------------------------------------------------------------------------- sampling for points in common */

bool lights_choose_point(struct light_point *z, const struct lights *l, const double chance[MAX_LIGHTS],
                         const double u[3])
{
    z->light = choose_light(l, chance, u[0]);
    if (z->light < 0) return false;
    const struct scene_light *light = &l->list[z->light];
    z->at = light->kind == LIGHT_SUN ? sun_direction(light, u + 1) : to_area(light, light->corner, u + 1);
    return true;
}

/* Density per solid angle of a place that is uniform over the area, at a distance in a unit direction. */
static double area_pdf(const struct scene_light *l, double distance, struct vec3 direction)
{
    return distance * distance / (l->area * fabs(vec3_dot(direction, l->n)));
}

double lights_point_pdf_sky(const struct lights *l, const double chance[MAX_LIGHTS], struct vec3 point,
                            struct vec3 direction)
{
    double pdf = 0;
    for (int i = 0; i < l->count; i++) {
        const struct scene_light *light = &l->list[i];
        struct vec3 to;
        if (!(chance[i] > 0)) continue;
        if (light->kind == LIGHT_SUN && vec3_dot(direction, light->n) > light->cos_cone) pdf += chance[i] / light->area;
        if (light->kind == LIGHT_WINDOW && crosses_window(light, point, direction, &to))
            pdf += chance[i] * area_pdf(light, vec3_length(to), direction);
    }
    return pdf;
}

double lights_point_pdf_face(const struct lights *l, const double chance[MAX_LIGHTS], struct vec3 point,
                             const struct ray_hit *hit, struct vec3 direction)
{
    const int i = l->of_face[hit->id];
    if (i < 0 || !(chance[i] > 0) || !hit->front) return 0;
    return chance[i] * area_pdf(&l->list[i], vec3_length(vec3_sub(hit->point, point)), direction);
}

bool lights_from_point(struct light_sample *s, const struct lights *l, const double chance[MAX_LIGHTS],
                       const struct light_point *z, struct vec3 point)
{
    const struct scene_light *light = &l->list[z->light];
    s->distance = INFINITY;
    s->direction = z->at;
    if (light->kind != LIGHT_SUN) {
        const struct vec3 to = vec3_sub(z->at, point);
        const double d = vec3_length(to);
        s->direction = vec3_scale(to, 1 / d);
        if (light->kind != LIGHT_WINDOW) {
            s->distance = d;
            s->radiance = emitted(light, -vec3_dot(s->direction, light->n));
            s->pdf = chance[z->light] * area_pdf(light, d, s->direction);
            return rgb_max(s->radiance) > 0 && s->pdf > 0;
        }
    }
    s->pdf = lights_point_pdf_sky(l, chance, point, s->direction);
    if (!(s->pdf > 0)) return false; /* rounding put the place beyond the window's rim */
    s->radiance = sky_radiance(&l->sky, s->direction);
    return rgb_max(s->radiance) > 0;
}
