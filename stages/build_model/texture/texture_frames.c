/* texture_frames.c - see texture_frames.h.
 *
 * A frame, or a casing, is photographed as texture of the wall around its opening. Of an opening that moves, with its
 * size kept, a band around it shows what was around its old place; the band is as wide as an eighth of the opening's
 * shorter side, which holds usual frames without a known scale.
 *
 * Its old place, with the band, shows the wall beside it, mirrored at the band's outer border, so that nothing jumps
 * there: the left half what is to its left, the right half what is to its right; or one side for both, where the other
 * has too little wall before its end or the next opening. With neither, the nearest texels are repeated, as elsewhere.
 */
#include "stages/build_model/texture/texture_frames.h"

#include <math.h>
#include <string.h>

static const double BAND = 1.0 / 8;
static const double SLACK = 1e-6; /* model units */

/* An opening that moved along its wall. */
struct moved {
    const struct plan_opening *before, *now;
    const struct plan_wall *wall; /* of the edited model */
    struct vec3 along;            /* of the wall's coordinate S, unit */
    double band;
};

static double size_of(const double range[2]) { return range[1] - range[0]; }

static bool find_moved(struct moved *moved, const struct texture_models *m, int opening)
{
    const struct plan_opening *a = &m->before->openings[opening], *b = &m->plan->openings[opening];
    if (!plan_opening_is_there(m->before, a) || !plan_opening_is_there(m->plan, b) || a->wall != b->wall) return false;
    if (fabs(size_of(a->s) - size_of(b->s)) > SLACK || fabs(size_of(a->z) - size_of(b->z)) > SLACK) return false;
    if (fabs(a->s[0] - b->s[0]) <= SLACK && fabs(a->z[0] - b->z[0]) <= SLACK) return false;
    const struct plan_wall *wall = &m->plan->walls[b->wall];
    *moved = (struct moved){a, b, wall, vec3_make(wall->sign * wall->d[0], wall->sign * wall->d[1], 0),
                            BAND * fmin(size_of(b->s), size_of(b->z))};
    return true;
}

/* A limited rule in a rectangle of S and Z; p' = M p. */
static enum status add_rule(struct texture_face *to, const struct texture_models *m, int face, int from,
                            const double place[4], const double matrix[3][4], struct err *err)
{
    struct texture_rule rule = {.kind = TEXTURE_PLACE, .from = from, .limited = true};
    memcpy(rule.matrix, matrix, sizeof rule.matrix);
    texture_place_quad(rule.within, m, place, face);
    return texture_face_add(to, rule, err);
}

static enum status add_band(struct texture_face *to, const struct texture_models *m, int face, const struct moved *o,
                            struct vec3 by, struct err *err)
{
    const struct vec3 along = vec3_scale(o->along, o->before->s[0] - o->now->s[0]);
    const double place[4] = {o->now->s[0] - o->band, o->now->z[0] - o->band, o->now->s[1] + o->band,
                             o->now->z[1] + o->band};
    const double matrix[3][4] = {{1, 0, 0, along.x + by.x + 0.0},
                                 {0, 1, 0, along.y + by.y + 0.0},
                                 {0, 0, 1, o->before->z[0] - o->now->z[0] + by.z + 0.0}};
    return add_rule(to, m, face, to->id, place, matrix, err);
}

/* Whether the unedited wall has nothing but wall from S to S, in the heights of the old place. */
static bool is_free(const struct texture_models *m, const struct moved *o, int base_face, double from, double end)
{
    double low[2], high[2];
    solid_face_box(m->base, base_face, o->along, vec3_make(0, 0, 1), low, high);
    if (from + o->wall->origin < low[0] - SLACK || end + o->wall->origin > high[0] + SLACK) return false;
    for (int i = 0; i < m->before->opening_count; i++) {
        const struct plan_opening *other = &m->before->openings[i];
        if (other == o->before || other->wall != o->before->wall || !plan_opening_is_there(m->before, other)) continue;
        if (other->s[0] < end && other->s[1] > from && other->z[0] < o->before->z[1] + o->band &&
            other->z[1] > o->before->z[0] - o->band)
            return false;
    }
    return true;
}

/* The old place from S to S shows the wall beyond `mirror`, an end of the band. */
static enum status add_mirrored(struct texture_face *to, const struct texture_models *m, int face,
                                const struct moved *o, const double s[2], double mirror, struct vec3 by,
                                struct err *err)
{
    const double u[3] = {o->along.x, o->along.y, 0}, shift[3] = {by.x, by.y, by.z};
    const double place[4] = {s[0], o->before->z[0] - o->band, s[1], o->before->z[1] + o->band};
    double matrix[3][4];
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) matrix[i][k] = (i == k) - 2 * u[i] * u[k] + 0.0;
        matrix[i][3] = 2 * (mirror + o->wall->origin) * u[i] + shift[i] + 0.0;
    }
    return add_rule(to, m, face, to->id, place, matrix, err);
}

static enum status add_old_place(struct texture_face *to, const struct texture_models *m, int face, int base_face,
                                 const struct moved *o, struct vec3 by, struct err *err)
{
    const double low = o->before->s[0] - o->band, high = o->before->s[1] + o->band, middle = (low + high) / 2;
    const bool left = is_free(m, o, base_face, 2 * low - middle, low);
    const bool right = is_free(m, o, base_face, high, 2 * high - middle);
    if (left && right)
        return add_mirrored(to, m, face, o, (const double[2]){low, middle}, low, by, err) ||
                       add_mirrored(to, m, face, o, (const double[2]){middle, high}, high, by, err)
                   ? err->status
                   : ST_OK;
    if (left && is_free(m, o, base_face, 2 * low - high, low))
        return add_mirrored(to, m, face, o, (const double[2]){low, high}, low, by, err);
    if (right && is_free(m, o, base_face, high, 2 * high - low))
        return add_mirrored(to, m, face, o, (const double[2]){low, high}, high, by, err);
    return ST_OK;
}

/* Whether the face is the wall's inner or outer one. */
static bool is_side_of(const struct texture_models *m, int face, const struct plan_wall *wall)
{
    const struct solid_face *f = &m->edited->faces[face];
    const char *name = solid_face_name(m->edited, face);
    return !strncmp(name, "wall/", 5) && texture_face_is_of(name, wall->name) &&
           fabs(f->normal.x * wall->d[1] - f->normal.y * wall->d[0]) > 1 - SLACK;
}

enum status texture_frames_add(struct texture_face *to, const struct texture_models *m, int face, int base_face,
                               struct vec3 by, struct err *err)
{
    struct moved o;
    /* all new places before all old ones: an opening may move to where another was */
    for (int old = 0; old < 2; old++)
        for (int i = 0; !err->status && i < m->before->opening_count; i++) {
            if (!find_moved(&o, m, i) || !is_side_of(m, face, o.wall)) continue;
            if (old)
                add_old_place(to, m, face, base_face, &o, by, err);
            else
                add_band(to, m, face, &o, by, err);
        }
    return err->status;
}
