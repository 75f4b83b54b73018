/* outdoors_rotation.c - how a camera in a window is turned: from rays to points outdoors whose distance is unknown.
 *
 * A photo indoors and the camera in the window are metres apart, and houses outside tens of metres away, so that what
 * both show is seen in directions that differ by degrees. Their places are known. A point in the direction m from the
 * camera, at the inverse distance q, lies for the photo, which is b away, in the direction of
 *   u(q) = m - q b,     0 <= q <= 1 / nearest:
 * on an arc that begins at m. A match therefore says how far m is beside the arc, and on which end of it, but not where
 * on it: that is the distance. Where several photos show one point, their arcs share q, so that it is known too.
 *
 * 1. Rotations are drawn: three matches at random give three equations "m is not beside the arc", r . (m x b) = 0. They
 *    are solved by Newton steps from the rotation that is given, with a weak pull to it (PULL), because three points at
 *    the horizon leave the azimuth open. The best sum over all matches of 1 - (distance to the arc / AGREE)^2 wins
 *    (MSAC [Torr 2000]).
 * 2. The winner is refined by least squares over the rotation and all q, which are eliminated (Schur complement), with
 *    the weights of [Geman 1987], whose width shrinks to CUT standard deviations of the residuals; in the last steps
 *    sights within that count fully and others not at all, so that the residuals show their standard deviation.
 * 3. The standard error is the larger of two: that of independent errors of the residuals' size, and the sandwich
 *    estimator [Cameron 2011] over photos and points, because an error of a photo's pose moves all that it shows, and
 *    one of a ray all sights of its point. What an error of the camera's place does, through q, is added.
 *
 * 4. Wrong matches also lie on an arc by chance, the more so where everything is at the horizon. How often is counted:
 *    the ray of each match with the direction of others of its photo. So many must agree that as many would by chance
 *    in one of a hundred million draws (CHANCE), besides the three that the rotation was drawn from, and at least a
 *    given number.
 *
 * All sums run in the order of the matches. */
#include "stages/hdr_merge/outdoors_rotation.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/rng.h"
#include "common/math/numbers.h"
#include "common/math/rotation_fit.h"

enum { DRAWS = 2000, NEWTON_STEPS = 6, STEPS = 40, LAST_STEPS = 10, DISTANCE_STEPS = 3, EXCHANGES = 16 };

static const double AGREE = 0.5 * DEGREE, PULL = 1e-4, CHANCE = 1e-8, MIN_SPREAD = 0.005 * DEGREE, CUT = 3.5;

struct fit {
    const struct outdoors_sight *sights;
    int count;
    double max_inverse; /* 1 / nearest */
    struct mat3 given, turn;
    double *weights, *inverses; /* of each sight; the inverse distance is that of its point; owned */
    struct vec3 *residuals;     /* of each sight: across its direction, radians; owned */
};

static struct vec3 ray_in_model(struct mat3 cam_from_model, const struct outdoors_sight *s)
{
    return mat3_apply(mat3_transpose(cam_from_model), s->ray);
}

static struct vec3 direction_at(struct vec3 m, double inverse, const struct outdoors_sight *s)
{
    return vec3_sub(m, vec3_scale(s->from, inverse));
}

/* The sine of the angle between a direction and its sight's, as a vector across both; length 1 behind. */
static struct vec3 residual_at(struct vec3 u, const struct outdoors_sight *s)
{
    const struct vec3 e = vec3_scale(vec3_cross(s->direction, u), 1 / fmax(vec3_length(u), 1e-12));
    const double length = vec3_length(e);
    return vec3_dot(u, s->direction) > 0 ? e : length > 0 ? vec3_scale(e, 1 / length) : vec3_make(1, 0, 0);
}

/* The inverse distance at which sights [begin, end) of one point fit best, by the algebraic residual r x (m - q b),
 * reweighted by its length. */
static double best_inverse(const struct fit *f, struct vec3 m, int begin, int end)
{
    double q = 0;
    for (int step = 0; step < DISTANCE_STEPS; step++) {
        double above = 0, below = 0;
        for (int i = begin; i < end; i++) {
            const struct outdoors_sight *s = &f->sights[i];
            const struct vec3 u = direction_at(m, q, s), slope = vec3_cross(s->direction, s->from);
            const double w = f->weights[i] / fmax(vec3_dot(u, u), 1e-6);
            above += w * vec3_dot(vec3_cross(s->direction, m), slope);
            below += w * vec3_dot(slope, slope);
        }
        q = below > 0 ? clamp(above / below, 0, f->max_inverse) : 0;
        if (end - begin == 1) break; /* the weight does not matter */
    }
    return q;
}

/* -------------------------------------------------------------------------------------------------------- the draws */

/* One minus the squared distance to the arc, in units of AGREE; 0 beyond that. */
static double agreement_of(const struct fit *f, struct mat3 turn, const struct outdoors_sight *s)
{
    const struct vec3 m = ray_in_model(turn, s), slope = vec3_cross(s->direction, s->from);
    const double below = vec3_dot(slope, slope);
    const double q = below > 0 ? clamp(vec3_dot(vec3_cross(s->direction, m), slope) / below, 0, f->max_inverse) : 0;
    const double off = vec3_length(residual_at(direction_at(m, q, s), s)) / AGREE;
    return off < 1 ? 1 - off * off : 0;
}

static double agreement(const struct fit *f, struct mat3 turn, int i) { return agreement_of(f, turn, &f->sights[i]); }

/* Solves a symmetric, positive definite system. */
static struct vec3 solve(struct mat3 a, struct vec3 b)
{
    const struct vec3 x = mat3_row(a, 0), y = mat3_row(a, 1), z = mat3_row(a, 2);
    const struct vec3 yz = vec3_cross(y, z), zx = vec3_cross(z, x), xy = vec3_cross(x, y);
    const double determinant = vec3_dot(x, yz);
    const struct vec3 sum = vec3_add(vec3_add(vec3_scale(yz, b.x), vec3_scale(zx, b.y)), vec3_scale(xy, b.z));
    return fabs(determinant) > 1e-300 ? vec3_scale(sum, 1 / determinant) : vec3_make(0, 0, 0);
}

static void add_product(struct mat3 *to, struct vec3 a, struct vec3 b, double weight)
{
    const double l[3] = {a.x, a.y, a.z}, r[3] = {b.x, b.y, b.z};
    for (int i = 0; i < 9; i++) to->m[i / 3][i % 3] += weight * l[i / 3] * r[i % 3];
}

static double angle_between(struct mat3 a, struct mat3 b)
{
    return quat_angle(quat_from_mat3(a), quat_from_mat3(b)) / DEGREE;
}

/* The rotation that puts three sights beside no arc. False: one has no arc, or the rotation is too far. */
static bool turn_of_three(struct mat3 *turn, const struct fit *f, const int chosen[3])
{
    struct vec3 normals[3];
    for (int k = 0; k < 3; k++) {
        const struct outdoors_sight *s = &f->sights[chosen[k]];
        normals[k] = vec3_cross(s->direction, s->from);
        if (vec3_length(normals[k]) < 1e-3 * vec3_length(s->from)) return false;
        normals[k] = vec3_normalize(normals[k]);
    }
    *turn = f->given;
    for (int step = 0; step < NEWTON_STEPS; step++) {
        struct mat3 a = {{{PULL, 0, 0}, {0, PULL, 0}, {0, 0, PULL}}};
        struct vec3 b = {0};
        for (int k = 0; k < 3; k++) {
            /* turning the camera by w in the model's frame moves m by w x m */
            const struct vec3 m = ray_in_model(*turn, &f->sights[chosen[k]]), slope = vec3_cross(m, normals[k]);
            add_product(&a, slope, slope, 1);
            b = vec3_sub(b, vec3_scale(slope, vec3_dot(m, normals[k])));
        }
        *turn = mat3_transpose(rotation_turn(mat3_transpose(*turn), solve(a, b)));
    }
    return angle_between(*turn, f->given) <= OUTDOORS_MAX_TURN;
}

static double score(const struct fit *f, struct mat3 turn)
{
    double sum = 0;
    for (int i = 0; i < f->count; i++) sum += agreement(f, turn, i);
    return sum;
}

static void draw(struct fit *f, const char *name)
{
    const struct rng random = rng_make(0, "outdoors_rotation", name);
    double best = score(f, f->given);
    f->turn = f->given;
    for (int k = 0; k < DRAWS; k++) {
        int chosen[3];
        struct mat3 turn;
        for (int c = 0; c < 3; c++) chosen[c] = (int)(rng_u32(&random, (uint64_t)k, (uint64_t)c) % (uint32_t)f->count);
        const struct outdoors_sight *s = f->sights;
        if (s[chosen[0]].point == s[chosen[1]].point || s[chosen[1]].point == s[chosen[2]].point ||
            s[chosen[0]].point == s[chosen[2]].point || !turn_of_three(&turn, f, chosen))
            continue;
        const double sum = score(f, turn);
        if (sum > best) {
            best = sum;
            f->turn = turn;
        }
    }
}

/* --------------------------------------------------------------------------------------------------- the refinement */

static int end_of_point(const struct fit *f, int begin)
{
    int end = begin;
    while (end < f->count && f->sights[end].point == f->sights[begin].point) end++;
    return end;
}

/* Distances of all points, and residuals of all sights. */
static void measure(struct fit *f)
{
    for (int begin = 0, end; begin < f->count; begin = end) {
        end = end_of_point(f, begin);
        const struct vec3 m = ray_in_model(f->turn, &f->sights[begin]);
        const double q = best_inverse(f, m, begin, end);
        for (int i = begin; i < end; i++) {
            f->inverses[i] = q;
            f->residuals[i] = residual_at(direction_at(m, q, &f->sights[i]), &f->sights[i]);
        }
    }
}

static void weigh(struct fit *f, double width, bool cut)
{
    for (int i = 0; i < f->count; i++) {
        const double off = vec3_length(f->residuals[i]) / width, w = 1 / (1 + off * off);
        f->weights[i] = cut ? off < 1 : w * w;
    }
}

/* Rows of the derivative of a sight's residual by the turn: -[r] [m] / |u|. */
static struct mat3 slope_of_turn(struct vec3 m, double length, const struct outdoors_sight *s)
{
    const struct vec3 r = s->direction;
    struct mat3 a;
    /* r x (w x m) = w (r . m) - m (r . w) */
    const double dot = vec3_dot(r, m), ms[3] = {m.x, m.y, m.z}, rs[3] = {r.x, r.y, r.z};
    for (int i = 0; i < 9; i++) a.m[i / 3][i % 3] = ((i / 3 == i % 3 ? dot : 0) - ms[i / 3] * rs[i % 3]) / length;
    return a;
}

struct normal_equations {
    struct mat3 information; /* sum of w J' J, where J is free of what a change of q does */
    struct mat3 place;       /* sum of w J' times the derivative by the camera's place */
    struct mat3 points;      /* sum over points of the products of their gradients */
    struct vec3 gradient;
    double sights, squares; /* sums of w, of w e^2 */
    double free;            /* points whose distance is free, by their largest weight */
};

/* Adds the sights [begin, end) of a point. gradients: of each photo, added to; may be NULL. */
static void add_point(struct normal_equations *n, const struct fit *f, int begin, int end, struct vec3 *gradients)
{
    const double q = f->inverses[begin];
    const struct vec3 m = ray_in_model(f->turn, &f->sights[begin]);
    struct vec3 share = {0}, sum = {0};
    double below = 0, largest = 0;
    const bool free = q > 0 && q < f->max_inverse;
    for (int i = begin; i < end; i++) {
        const struct outdoors_sight *s = &f->sights[i];
        const double length = fmax(vec3_length(direction_at(m, q, s)), 1e-6);
        const struct mat3 a = slope_of_turn(m, length, s);
        const struct vec3 by_q = vec3_scale(vec3_cross(s->direction, s->from), -1 / length);
        share = vec3_add(share, vec3_scale(mat3_apply(mat3_transpose(a), by_q), f->weights[i]));
        below += f->weights[i] * vec3_dot(by_q, by_q);
        largest = fmax(largest, f->weights[i]);
    }
    share = free && below > 0 ? vec3_scale(share, 1 / below) : vec3_make(0, 0, 0);
    n->free += free ? largest : 0;
    for (int i = begin; i < end; i++) {
        const struct outdoors_sight *s = &f->sights[i];
        const double length = fmax(vec3_length(direction_at(m, q, s)), 1e-6), w = f->weights[i];
        const struct vec3 by_q = vec3_scale(vec3_cross(s->direction, s->from), -1 / length), r = s->direction,
                          e = f->residuals[i];
        struct mat3 a = slope_of_turn(m, length, s);
        add_product(&a, by_q, share, -1);
        const struct mat3 t = mat3_transpose(a),
                          by_place = {{{0, -r.z * q / length, r.y * q / length},
                                       {r.z * q / length, 0, -r.x * q / length},
                                       {-r.y * q / length, r.x * q / length, 0}}},
                          information = mat3_multiply(t, a), place = mat3_multiply(t, by_place);
        const struct vec3 gradient = vec3_scale(mat3_apply(t, e), w);
        for (int k = 0; k < 9; k++) {
            n->information.m[k / 3][k % 3] += w * information.m[k / 3][k % 3];
            n->place.m[k / 3][k % 3] += w * place.m[k / 3][k % 3];
        }
        sum = vec3_add(sum, gradient);
        if (gradients) gradients[s->photo] = vec3_add(gradients[s->photo], gradient);
        n->sights += w;
        n->squares += w * vec3_dot(e, e);
    }
    n->gradient = vec3_add(n->gradient, sum);
    add_product(&n->points, sum, sum, 1);
}

static struct normal_equations equations_of(const struct fit *f, struct vec3 *gradients)
{
    struct normal_equations n = {0};
    for (int begin = 0, end; begin < f->count; begin = end) {
        end = end_of_point(f, begin);
        add_point(&n, f, begin, end, gradients);
    }
    return n;
}

/* Of a residual along each axis. */
static double spread_of(const struct normal_equations *n)
{
    const double freedom = 2 * n->sights - n->free - 3;
    return freedom > 0 ? fmax(sqrt(n->squares / freedom), MIN_SPREAD) : AGREE;
}

static void refine(struct fit *f)
{
    double width = 2 * AGREE;
    for (int i = 0; i < f->count; i++) f->weights[i] = agreement(f, f->turn, i) > 0 ? 1 : 0;
    measure(f);
    for (int step = 0; step < STEPS; step++) {
        struct normal_equations n = equations_of(f, NULL);
        for (int k = 0; k < 3; k++) n.information.m[k][k] += 1e-9 + 1e-6 * n.sights;
        const struct vec3 w = vec3_scale(solve(n.information, n.gradient), -1);
        f->turn = mat3_transpose(rotation_turn(mat3_transpose(f->turn), w));
        measure(f);
        width = fmin(fmax(0.8 * width, CUT * spread_of(&n)), 2 * AGREE);
        weigh(f, width, step >= STEPS - LAST_STEPS);
        measure(f);
    }
}

/* ------------------------------------------------------------------------------------------------------ the verdict */

static double trace(struct mat3 a) { return a.m[0][0] + a.m[1][1] + a.m[2][2]; }

/* Rotations of which nothing is known have an infinite error. */
static enum status find_error(struct outdoors_rotation *r, const struct fit *f, const struct outdoors_rules *rules,
                              struct err *err)
{
    struct mat3 unknown;
    int photos = 0, seen = 0;
    for (int i = 0; i < f->count; i++) photos = f->sights[i].photo >= photos ? f->sights[i].photo + 1 : photos;
    struct vec3 *gradients = calloc((size_t)photos + 1, sizeof *gradients);
    bool *agrees = calloc((size_t)photos + 1, sizeof *agrees);
    if (!gradients || !agrees) {
        free(gradients);
        free(agrees);
        return err_nomem(err, "gradients of photos", (size_t)photos * sizeof *gradients);
    }
    const struct normal_equations n = equations_of(f, gradients);
    const struct mat3 inverse = rotation_inverse_of_known(n.information, &unknown);
    const double spread = spread_of(&n);
    r->agree = 0;
    for (int i = 0; i < f->count; i++) {
        if (vec3_length(f->residuals[i]) > AGREE) continue;
        r->agree++;
        agrees[f->sights[i].photo] = true;
    }
    for (int i = 0; i < photos; i++) seen += agrees[i];
    r->photos = seen;
    r->spread = spread / DEGREE;
    const struct vec3 together = rotation_sandwich(inverse, gradients, photos);
    const struct mat3 by_place = mat3_multiply(inverse, n.place);
    const double independent = spread * spread * trace(inverse),
                 by_photos = seen > 1 ? vec3_dot(together, together) * seen / (seen - 1) : independent,
                 by_points = trace(mat3_multiply(mat3_multiply(inverse, n.points), inverse)),
                 place =
                     rules->place_error * rules->place_error * trace(mat3_multiply(by_place, mat3_transpose(by_place)));
    r->error =
        trace(unknown) > 0 ? INFINITY : sqrt(fmax(independent, by_photos + by_points - independent) + place) / DEGREE;
    free(gradients);
    free(agrees);
    return ST_OK;
}

/* The share of wrong matches that agree with the rotation. */
static double share_by_chance(const struct fit *f)
{
    int agree = 0, tried = 0;
    for (int i = 0; i < f->count; i++)
        for (int j = i + 1, exchanged = 0; j < f->count && exchanged < EXCHANGES; j++) {
            struct outdoors_sight s = f->sights[j];
            if (s.photo != f->sights[i].photo || s.point == f->sights[i].point) continue;
            s.ray = f->sights[i].ray;
            agree += agreement_of(f, f->turn, &s) > 0;
            tried++;
            exchanged++;
        }
    return tried ? (agree + 1.0) / (tried + 1.0) : 1;
}

/* The least k such that k or more of n happen with a probability of at most CHANCE, each with p; n + 1: none. */
static int least_by_chance(int n, double p)
{
    double tail = 0;
    int k = n;
    for (; k > 0; k--) {
        tail += exp(lgamma(n + 1.0) - lgamma(k + 1.0) - lgamma(n - k + 1.0) + k * log(p) + (n - k) * log1p(-p));
        if (!(tail <= CHANCE)) break;
    }
    return k + 1;
}

static void judge(struct outdoors_rotation *r, const struct fit *f, const struct outdoors_rules *rules)
{
    const int wanted = 3 + least_by_chance(f->count - 3, share_by_chance(f));
    if (wanted > r->wanted) r->wanted = wanted;
    r->turned = angle_between(f->turn, f->given);
    r->verdict = r->agree < r->wanted                                             ? OUTDOORS_FEW
                 : r->error <= rules->max_error && r->turned <= OUTDOORS_MAX_TURN ? OUTDOORS_TURNED
                                                                                  : OUTDOORS_UNCERTAIN;
    if (r->verdict == OUTDOORS_TURNED) r->cam_from_model = f->turn;
}

enum status outdoors_rotation_find(struct outdoors_rotation *r, struct mat3 cam_from_model,
                                   const struct outdoors_sight *sights, int count, const struct outdoors_rules *rules,
                                   const char *name, struct err *err)
{
    struct fit f = {.sights = sights,
                    .count = count,
                    .max_inverse = 1 / rules->nearest,
                    .given = cam_from_model,
                    .turn = cam_from_model};
    *r = (struct outdoors_rotation){
        .verdict = OUTDOORS_FEW, .cam_from_model = cam_from_model, .sights = count, .wanted = rules->min_sights};
    if (count < 3) return ST_OK;
    f.weights = calloc((size_t)count, sizeof *f.weights);
    f.inverses = calloc((size_t)count, sizeof *f.inverses);
    f.residuals = calloc((size_t)count, sizeof *f.residuals);
    if (!f.weights || !f.inverses || !f.residuals)
        err_nomem(err, "matches of the outdoors", (size_t)count * (sizeof *f.residuals + 2 * sizeof *f.weights));
    else {
        draw(&f, name);
        refine(&f);
        if (!find_error(r, &f, rules, err)) judge(r, &f, rules);
    }
    free(f.weights);
    free(f.inverses);
    free(f.residuals);
    return err->status;
}
