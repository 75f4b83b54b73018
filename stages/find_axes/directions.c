/* directions.c - three orthogonal directions of most normals [Furukawa 2009].
 *
 * Normals are counted in bins of the half sphere (a surface and its back have the same direction). The first axis is
 * the densest direction, the second the densest about perpendicular to it, the third the densest about perpendicular to
 * both. The source is greedy. Here each of the densest directions starts a triple, and the triple with the most points
 * in total wins: the side of a sofa may be denser than a wall, but few surfaces are perpendicular to it.
 *
 * The triple is then made exactly orthogonal and refined by robust least squares over the points: a normal's residual
 * is its angle to the nearest axis, and Tukey's biweight excludes normals that are not along any axis. Where there are
 * only two clusters, their cross product is the third axis. */
#include "stages/find_axes/directions.h"

#include <stdlib.h>

#include "common/math/rotation_fit.h"
#include "stages/find_axes/blocks.h"

enum {
    GRID = 32, /* bins along an edge of the cube onto which directions are projected: up to 3.6 degrees wide */
    BINS = 3 * GRID * GRID,
    STARTS = 24,     /* number of directions that start a triple */
    ITERATIONS = 12, /* of the refinement */
    STEPS = 2000,    /* of the histogram of angles */
};
static const double CAP = 10 * M_PI / 180;   /* max angle between an axis and the normals that count for it */
static const double REACH = 15 * M_PI / 180; /* max angle between an axis and the normals that refine it */
static const double MIN_SPREAD = 0.3 * M_PI / 180;
static const double BIWEIGHT = 4.685; /* standard deviations at which a residual's weight is zero (95 % efficiency) */

struct bin {
    struct vec3 sum, direction;
    double count, mass; /* mass: points within CAP of the direction */
};

/* ------------------------------------------------------------------------------------------------------------ peaks */

static int cell_of(double part) /* of -1 .. 1 */
{
    const int at = (int)((part + 1) / 2 * GRID);
    return at < 0 ? 0 : at >= GRID ? GRID - 1 : at;
}

/* n or its opposite, with the largest component positive; *at: its bin. */
static struct vec3 fold(struct vec3 n, int *at)
{
    const double c[3] = {n.x, n.y, n.z};
    int face = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(c[k]) > fabs(c[face])) face = k;
    *at = (face * GRID + cell_of(c[(face + 1) % 3] / c[face])) * GRID + cell_of(c[(face + 2) % 3] / c[face]);
    return c[face] < 0 ? vec3_scale(n, -1) : n;
}

static int fill_bins(struct bin *bins, const struct point_cloud *cloud)
{
    int used = 0;
    for (size_t i = 0; i < cloud->count; i++) {
        int at;
        const struct vec3 n = fold(cloud_normal(&cloud->points[i]), &at);
        bins[at].sum = vec3_add(bins[at].sum, n);
        bins[at].count++;
    }
    for (int i = 0; i < BINS; i++) {
        if (!(bins[i].count > 0)) continue;
        bins[used] = bins[i];
        bins[used].direction = vec3_normalize(bins[used].sum);
        used++;
    }
    for (int i = 0; i < used; i++)
        for (int j = 0; j < used; j++)
            if (fabs(vec3_dot(bins[i].direction, bins[j].direction)) > cos(CAP)) bins[i].mass += bins[j].count;
    return used;
}

/* The densest bin about perpendicular to the given axes; -1: none. */
static int densest(const struct bin *bins, int count, const struct vec3 *axes, int given)
{
    int best = -1;
    for (int i = 0; i < count; i++) {
        bool better = best < 0 || bins[i].mass > bins[best].mass;
        for (int k = 0; k < given; k++) better = better && fabs(vec3_dot(bins[i].direction, axes[k])) < sin(CAP);
        if (better) best = i;
    }
    return best;
}

/* Mean shift from a direction to the mean of the normals around it. */
static struct vec3 mean_shift(const struct bin *bins, int count, struct vec3 d)
{
    for (int round = 0; round < 3; round++) {
        struct vec3 sum = {0};
        for (int i = 0; i < count; i++) {
            const double along = vec3_dot(bins[i].direction, d);
            if (fabs(along) > cos(CAP)) sum = vec3_add(sum, vec3_scale(bins[i].sum, along < 0 ? -1 : 1));
        }
        d = vec3_normalize(sum);
    }
    return d;
}

/* Whether a bin may start a triple: it is apart from the earlier starts. */
static bool may_start(const struct bin *bins, int count, int at, const struct vec3 *starts, int known)
{
    for (int k = 0; k < known; k++)
        if (fabs(vec3_dot(bins[at].direction, starts[k])) > cos(CAP)) return false;
    return at < count;
}

/* The axes of the triple with the most points, not yet orthogonal; returns their number, 1 to 3, or 0: no points. */
static int best_triple(struct vec3 axes[3], const struct bin *bins, int count)
{
    struct vec3 starts[STARTS];
    double max_mass = -1;
    int found = 0;
    for (int s = 0; s < STARTS; s++) {
        int first = -1;
        for (int i = 0; i < count; i++)
            if ((first < 0 || bins[i].mass > bins[first].mass) && may_start(bins, count, i, starts, s)) first = i;
        if (first < 0) break;
        starts[s] = bins[first].direction;
        struct vec3 triple[3] = {mean_shift(bins, count, starts[s])};
        double mass = bins[first].mass;
        int known = 1;
        for (int at; known < 3 && (at = densest(bins, count, triple, known)) >= 0; known++) {
            triple[known] = mean_shift(bins, count, bins[at].direction);
            mass += bins[at].mass;
        }
        if (!(mass > max_mass)) continue;
        max_mass = mass;
        found = known;
        for (int k = 0; k < 3; k++) axes[k] = triple[k];
    }
    return found;
}

/* ------------------------------------------------------------------------------------------------------- refinement */

/* The axis nearest to n, which is in the frame of the axes, and the angle between them. */
static int nearest_axis(struct vec3 n, double *angle)
{
    const double c[3] = {fabs(n.x), fabs(n.y), fabs(n.z)};
    const int k = c[0] >= c[1] && c[0] >= c[2] ? 0 : c[1] >= c[2] ? 1 : 2;
    *angle = atan2(hypot(c[(k + 1) % 3], c[(k + 2) % 3]), c[k]);
    return k;
}

/* Standard deviation of the angles to the axes in each of the two directions across, from their median. */
static double spread_of_angles(const struct point_cloud *cloud, struct mat3 axes)
{
    size_t histogram[STEPS] = {0}, count = 0, seen = 0;
    for (size_t i = 0; i < cloud->count; i++) {
        double angle;
        nearest_axis(mat3_apply(axes, cloud_normal(&cloud->points[i])), &angle);
        if (!(angle < REACH)) continue;
        histogram[(int)(angle / REACH * STEPS)]++;
        count++;
    }
    int at = 0;
    while (at < STEPS - 1 && 2 * (seen + histogram[at]) < count) seen += histogram[at++];
    return REACH * (at + 0.5) / STEPS / sqrt(2 * log(2)); /* of a Rayleigh distribution */
}

/* A normal's axis, and the weighted rotation that would bring the axis to the normal. Returns the weight. */
static double weighted_turn(struct vec3 n, double cut, int *axis, struct vec3 *turn)
{
    const double c[3] = {n.x, n.y, n.z};
    double angle, t[3] = {0};
    const int k = *axis = nearest_axis(n, &angle), a = (k + 1) % 3, b = (k + 2) % 3;
    if (!(angle < cut)) return 0;
    const double w = (1 - angle * angle / (cut * cut)) * (1 - angle * angle / (cut * cut));
    t[a] = w * c[b] / c[k];
    t[b] = -w * c[a] / c[k];
    *turn = vec3_make(t[0], t[1], t[2]);
    return w;
}

static double cut_of(const struct point_cloud *cloud, struct mat3 axes)
{
    return fmin(REACH, BIWEIGHT * fmax(spread_of_angles(cloud, axes), MIN_SPREAD));
}

/* Information of the rotation: a normal does not constrain the rotation about its own axis. */
static struct mat3 information_of(const double weights[3])
{
    struct mat3 m = {0};
    for (int k = 0; k < 3; k++) m.m[k][k] = weights[(k + 1) % 3] + weights[(k + 2) % 3];
    return m;
}

static void refine(struct mat3 *axes, const struct point_cloud *cloud)
{
    for (int round = 0; round < ITERATIONS; round++) {
        const double cut = cut_of(cloud, *axes);
        double weights[3] = {0};
        struct vec3 sum = {0}, turn;
        struct mat3 unknown;
        for (size_t i = 0; i < cloud->count; i++) {
            int k;
            const double w = weighted_turn(mat3_apply(*axes, cloud_normal(&cloud->points[i])), cut, &k, &turn);
            if (!(w > 0)) continue;
            weights[k] += w;
            sum = vec3_add(sum, turn);
        }
        *axes = rotation_turn(*axes, mat3_apply(rotation_inverse_of_known(information_of(weights), &unknown), sum));
    }
}

enum status direction_errors(struct vec3 *errors, const struct mat3 *axes, struct vec3 origin,
                             const struct point_cloud *cloud, struct err *err)
{
    struct vec3 *sums = calloc(BLOCKS, sizeof *sums), turn;
    struct mat3 unknown;
    double size = 0, weights[3] = {0};
    const double cut = cut_of(cloud, *axes);
    if (sums)
        block_cloud_size(&size, cloud, origin, err);
    else
        err_nomem(err, "blocks", BLOCKS * sizeof *sums);
    for (size_t i = 0; !err->status && i < cloud->count; i++) {
        int k;
        const struct cloud_point *p = &cloud->points[i];
        const double w = weighted_turn(mat3_apply(*axes, cloud_normal(p)), cut, &k, &turn);
        if (!(w > 0)) continue;
        weights[k] += w;
        struct vec3 *sum = &sums[block_of(vec3_sub(p->position, origin), size)];
        *sum = vec3_add(*sum, turn);
    }
    if (!err->status)
        *errors = rotation_sandwich(rotation_inverse_of_known(information_of(weights), &unknown), sums, BLOCKS);
    free(sums);
    return err->status;
}

void directions_count(struct directions *d, const struct point_cloud *cloud)
{
    for (int k = 0; k < 3; k++) d->part[k] = 0;
    for (size_t i = 0; i < cloud->count; i++) {
        double angle;
        const int k = nearest_axis(mat3_apply(d->axes, cloud_normal(&cloud->points[i])), &angle);
        d->part[k] += angle < CAP;
    }
    for (int k = 0; k < 3 && cloud->count; k++) d->part[k] /= (double)cloud->count;
}

enum status directions_find(struct directions *d, const struct point_cloud *cloud, double min_part, struct err *err)
{
    struct bin *bins = calloc(BINS, sizeof *bins);
    struct vec3 axes[3] = {{0}};
    *d = (struct directions){0};
    if (!bins) return err_nomem(err, "bins of directions", BINS * sizeof *bins);
    const int known = best_triple(axes, bins, fill_bins(bins, cloud));
    free(bins);
    if (!known) return err_set(err, ST_DATA, "there are no points to find axes from; add photographs that overlap.");
    if (known > 1) {
        const struct vec3 x = axes[0];
        const struct vec3 y = vec3_normalize(vec3_sub(axes[1], vec3_scale(x, vec3_dot(x, axes[1]))));
        const struct vec3 z = vec3_cross(x, y);
        d->axes = (struct mat3){{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
        refine(&d->axes, cloud);
        directions_count(d, cloud);
    }
    int enough = 0;
    for (int k = 0; k < 3; k++) enough += d->part[k] >= min_part;
    if (enough < 2)
        return err_set(
            err, ST_DATA,
            "no two perpendicular directions have enough of the normals of %zu points: the best three have "
            "%.1f, %.1f and %.1f %% of them, wanted %.1f %% or more for two of them. The points must show flat "
            "walls and a floor or a ceiling; if these are only small, lower [find_axes] min_part.",
            cloud->count, 100 * d->part[0], 100 * d->part[1], 100 * d->part[2], 100 * min_part);
    return ST_OK;
}
