/* fields.h - fields of light made of a few flat patches, a sun and a background, and what is known about them in closed
 * form. */
#ifndef REMODEL_TESTS_FIELDS_H
#define REMODEL_TESTS_FIELDS_H

#include <math.h>
#include <stdbool.h>

#include "common/gather/irradiance.h"
#include "common/math/numbers.h"

enum { PATCHES = 32, PATCH_EMITTERS = 8 };

/* Seen from its front only; from behind it lets rays pass. Radiance times 1 + slope[0] a + slope[1] b at centre + a x +
 * b y, times cos^exponent within beta of the normal. */
struct patch {
    enum emitter_kind kind; /* EMITTER_DISK or EMITTER_QUAD */
    struct vec3 centre, x, y, normal;
    struct rgb radiance;
    double slope[2], beta, exponent;
    enum light_source source;
};

/* Filled by field_*(); must not move once `field` is in use. */
struct patch_field {
    struct patch patches[PATCHES];
    struct emitter emitters[PATCH_EMITTERS];
    struct rgb background, sun;
    struct vec3 to_sun;
    double sun_cone; /* cosine; 2: no sun */
    int count;
    struct light_field field;
};

static inline bool patch_hit(const struct patch *p, struct vec3 from, struct vec3 d, double *t, double ab[2])
{
    const double cosine = -vec3_dot(d, p->normal);
    if (!(cosine > 0)) return false;
    const struct vec3 to = vec3_sub(p->centre, from);
    *t = -vec3_dot(to, p->normal) / cosine;
    if (!(*t > 1e-9)) return false;
    const struct vec3 q = vec3_sub(vec3_scale(d, *t), to);
    const double xx = vec3_dot(p->x, p->x), xy = vec3_dot(p->x, p->y), yy = vec3_dot(p->y, p->y);
    const double qx = vec3_dot(q, p->x), qy = vec3_dot(q, p->y), det = xx * yy - xy * xy;
    ab[0] = (qx * yy - qy * xy) / det;
    ab[1] = (qy * xx - qx * xy) / det;
    return p->kind == EMITTER_DISK ? ab[0] * ab[0] + ab[1] * ab[1] <= 1 : fabs(ab[0]) <= 1 && fabs(ab[1]) <= 1;
}

static inline struct rgb patch_radiance(const struct patch *p, struct vec3 d, const double ab[2])
{
    const double cosine = fmin(-vec3_dot(d, p->normal), 1);
    if (acos(cosine) > p->beta) return rgb_grey(0);
    return rgb_scale(p->radiance, (1 + p->slope[0] * ab[0] + p->slope[1] * ab[1]) *
                                      (p->exponent > 0 ? pow(cosine, p->exponent) : 1));
}

static inline struct light_look patch_field_look(const struct patch_field *f, struct vec3 from, struct vec3 d)
{
    const bool in_sun = vec3_dot(d, f->to_sun) >= f->sun_cone;
    struct light_look seen = {in_sun ? f->sun : f->background, INFINITY, LIGHT_SKY, -1};
    for (int i = 0; i < f->count; i++) {
        double t, ab[2];
        if (!patch_hit(&f->patches[i], from, d, &t, ab) || t >= seen.distance) continue;
        seen = (struct light_look){patch_radiance(&f->patches[i], d, ab), t, f->patches[i].source, -1};
    }
    return seen;
}

static inline void patch_field_looks(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                                     const struct vec3 direction[RAY_PACKET], unsigned active,
                                     struct light_look seen[RAY_PACKET])
{
    const struct patch_field *f = ctx;
    (void)normal;
    for (int k = 0; k < RAY_PACKET; k++)
        if (active >> k & 1) seen[k] = patch_field_look(f, from[k], direction[k]);
}

static inline void field_start(struct patch_field *f, struct rgb background)
{
    *f = (struct patch_field){.background = background, .sun_cone = 2};
    f->field = (struct light_field){.ctx = f, .look = patch_field_looks, .emitters = f->emitters};
}

static inline struct patch *field_add(struct patch_field *f, enum emitter_kind kind, struct vec3 centre, struct vec3 x,
                                      struct vec3 y, struct vec3 normal, struct rgb radiance)
{
    struct patch *p = &f->patches[f->count++];
    *p = (struct patch){kind, centre, x, y, normal, radiance, {0, 0}, PI, 0, LIGHT_TEXTURE};
    return p;
}

/* Makes a patch an emitter that is named. */
static inline void field_name(struct patch_field *f, struct patch *p)
{
    p->source = LIGHT_LAMP;
    f->emitters[f->field.emitter_count++] = (struct emitter){.kind = p->kind,
                                                             .centre = p->centre,
                                                             .x = p->x,
                                                             .y = p->y,
                                                             .normal = p->normal,
                                                             .luminance = rgb_luminance(p->radiance),
                                                             .beta = p->beta,
                                                             .exponent = p->exponent};
}

static inline void field_add_sun(struct patch_field *f, struct vec3 to, double radius, struct rgb radiance)
{
    f->sun = radiance;
    f->to_sun = to;
    f->sun_cone = cos(radius);
    f->emitters[f->field.emitter_count++] =
        (struct emitter){.kind = EMITTER_SUN, .normal = to, .cone = f->sun_cone, .luminance = rgb_luminance(radiance)};
}

/* The six sides of a box seen from inside (or five without its lid, from outside), of radiances -x +x -y +y -z +z. */
static inline void field_add_box(struct patch_field *f, struct vec3 low, struct vec3 high, const struct rgb sides[6],
                                 bool inside)
{
    const struct vec3 c = vec3_scale(vec3_add(low, high), 0.5), h = vec3_scale(vec3_sub(high, low), 0.5);
    const struct vec3 half[3] = {{h.x, 0, 0}, {0, h.y, 0}, {0, 0, h.z}};
    const struct vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 6; i++) {
        const int k = i / 2;
        const double sign = i % 2 ? 1 : -1;
        field_add(f, EMITTER_QUAD, vec3_add(c, vec3_scale(half[k], sign)), half[(k + 1) % 3], half[(k + 2) % 3],
                  vec3_scale(axis[k], inside ? -sign : sign), sides[i]);
    }
}

/* Lambert's form factor of a convex polygon above the horizon of a point: 1 / (2 pi) sum of the angles under which its
 * edges are seen, times the cosine between the normal and that of the plane through the edge. */
static inline double polygon_factor(const struct vec3 *corners, int count, struct gather_point p)
{
    double sum = 0;
    for (int i = 0; i < count; i++) {
        const struct vec3 a = vec3_normalize(vec3_sub(corners[i], p.at));
        const struct vec3 b = vec3_normalize(vec3_sub(corners[(i + 1) % count], p.at)), n = vec3_cross(a, b);
        const double length = vec3_length(n);
        if (length > 0) sum += atan2(length, vec3_dot(a, b)) * vec3_dot(n, p.normal) / length;
    }
    return fabs(sum) / (2 * PI);
}

/* The form factor of a quad, cut at the point's horizon; 0 from behind. */
static inline double patch_factor(const struct patch *q, struct gather_point p)
{
    struct vec3 in[4], out[8];
    int count = 0;
    if (!(-vec3_dot(vec3_sub(q->centre, p.at), q->normal) > 0)) return 0;
    for (int i = 0; i < 4; i++)
        in[i] = vec3_add(q->centre,
                         vec3_add(vec3_scale(q->x, i == 0 || i == 3 ? 1 : -1), vec3_scale(q->y, i < 2 ? 1 : -1)));
    for (int i = 0; i < 4; i++) {
        const struct vec3 a = in[i], b = in[(i + 1) % 4];
        const double ha = vec3_dot(vec3_sub(a, p.at), p.normal), hb = vec3_dot(vec3_sub(b, p.at), p.normal);
        if (ha >= 0) out[count++] = a;
        if ((ha < 0 && hb > 0) || (ha > 0 && hb < 0))
            out[count++] = vec3_add(a, vec3_scale(vec3_sub(b, a), ha / (ha - hb)));
    }
    return count > 2 ? polygon_factor(out, count, p) : 0;
}

/* A room of 4 x 3 x 2.5 with two boxes in it, a lamp below the ceiling and a window beyond which the sky is bright. */
static inline void field_make_room(struct patch_field *f)
{
    static const struct rgb walls[6] = {{.5, .5, .5}, {.9, .3, .2},  {.4, .6, .4},
                                        {.6, .6, .7}, {.3, .25, .2}, {.8, .8, .8}};
    static const struct rgb wood[6] = {{.3, .2, .1}, {.2, .2, .1}, {.3, .2, .1},
                                       {.2, .2, .1}, {.1, .1, .1}, {.5, .4, .3}};
    field_start(f, rgb_grey(0));
    field_add_box(f, vec3_make(0, 0, 0), vec3_make(4, 3, 2.5), walls, true);
    field_add_box(f, vec3_make(0.5, 0.5, 0), vec3_make(1.3, 1.2, 0.9), wood, false);
    field_add_box(f, vec3_make(2.4, 1.4, 0), vec3_make(3.1, 2.2, 1.6), wood, false);
    for (int i = 0; i < 6; i++) f->patches[i].slope[0] = 0.3 - 0.1 * i;
    field_name(f, field_add(f, EMITTER_DISK, vec3_make(2, 1.5, 2.49), vec3_make(0.2, 0, 0), vec3_make(0, 0.2, 0),
                            vec3_make(0, 0, -1), rgb_make(30, 28, 24)));
    struct patch *window = field_add(f, EMITTER_QUAD, vec3_make(0.001, 1.5, 1.4), vec3_make(0, 0.5, 0),
                                     vec3_make(0, 0, 0.5), vec3_make(1, 0, 0), rgb_make(4, 5, 6));
    field_name(f, window);
    window->source = LIGHT_SKY;
}

/* What a camera in a corner of the room sees, row by row. */
static inline void field_see_room(struct gather_point *points, int width, int height, const struct patch_field *f)
{
    const struct vec3 eye = {3.8, 0.2, 1.7}, ahead = vec3_normalize(vec3_make(-1, 0.75, -0.35));
    const struct vec3 right = vec3_normalize(vec3_cross(ahead, vec3_make(0, 0, 1))), up = vec3_cross(right, ahead);
    for (int i = 0; i < width * height; i++) {
        const double x = (i % width + 0.5) / width * 2 - 1, y = (i / width + 0.5) / height * 2 - 1;
        const struct vec3 d =
            vec3_normalize(vec3_add(ahead, vec3_add(vec3_scale(right, x * 0.8), vec3_scale(up, -0.6 * y))));
        double nearest = INFINITY;
        points[i] = (struct gather_point){{0, 0, 0}, {0, 0, 0}};
        for (int k = 0; k < f->count; k++) {
            double t, ab[2];
            if (!patch_hit(&f->patches[k], eye, d, &t, ab) || t >= nearest) continue;
            nearest = t;
            points[i] = (struct gather_point){vec3_add(eye, vec3_scale(d, t)), f->patches[k].normal};
        }
    }
}

#endif
