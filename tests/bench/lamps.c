/* lamps.c - how near fitted lamps are to those of simulated rooms, and how often their intervals hold the truth.
 *
 *   lamps [--rooms N] [--first N] [--outliers PERCENT] [--verbose] [--threads N]
 *
 * Each room is a random box with one to three lamps in its ceiling: spots with a cone of known half angle and square
 * lamps. Direct light is that of lamp_irradiance(). The rest is known in closed form: daylight that falls off smoothly
 * from a window, and what the room reflects of the lamps' light by the balance of its mean albedo, rho flux / (area (1
 * - rho)), a fifth more or less from place to place. So it holds light of the lamps themselves, as a gather in
 * photographs does. The fit gets it with an error of 5 % that is the same everywhere, one of 5 % of each face and one
 * of 2 % of each mark.
 *
 * Faces have albedos of 0.1 to 0.8, which vary by waves of 0.3 to 3 m with deviations of 1 to 15 %, and from point to
 * point. Marks are squares of nine points; a spot has lit and unlit ones and lines across the edge of its cone, a
 * square lamp only lit ones, on any face. Of the marks 10 % are off by a factor of up to e: they are on a poster, in
 * shade or in the sun. Half the lamps saturate at 0.1 to 0.9 of their radiance. Photographs have 1 % of noise.
 *
 * Prints "seconds S", "error F" (median relative error of radiance), "error_nine_tenths F", "width F" (median half
 * width of the intervals of 95 %), "covered F" (fraction of intervals that hold the truth), "below F" and "above F"
 * (those that lie below it and above it), "intervals N", "found F" (of the marks that are off by more than 30 %, those
 * that are named), "wrong F" (of the good marks, those that are named). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/clock.h"
#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "common/base/sort.h"
#include "common/gather/lamp.h"
#include "common/math/numbers.h"
#include "stages/fit_lights/fit.h"

enum { MAX_LAMPS = 3, MAX_POINTS = 700, MAX_MARKS = 80, FACES = 5, WAVES = 12, LINE = 20 };
static const double noise = 0.01, common_error = 0.05, wall_error = 0.05, mark_error = 0.02;

struct face {
    struct vec3 corner, u, v, normal; /* u, v: unit; of `size` */
    double size[2], albedo[3], waviness, grain, length;
};

struct room {
    struct rng rng;
    uint64_t drawn, seed;
    double size[3];
    struct face faces[FACES];
    struct lamp lamps[MAX_LAMPS];
    struct fit_lamp fitted[MAX_LAMPS];
    struct fit_material materials[FACES];
    struct fit_mark marks[MAX_MARKS];
    double off[MAX_MARKS];  /* true logarithms */
    double wall_off[FACES]; /* of the errors of irradiance */
    struct fit_point points[MAX_POINTS];
    struct vec3 normals[MAX_POINTS];
    int lamp_count, mark_count, point_count;
    double daylight[3], reflected[3], phase[6];
};

struct outcome {
    double error, low, high, truth;
    int lamp;
    bool square;
};

struct work {
    int rooms, first;
    double outliers;
    bool verbose, failed;
    struct outcome *outcomes; /* [room][lamp][colour] */
    int *found, *off, *wrong, *good;
};

static double uniform(struct room *r, double from, double to)
{
    return from + (to - from) * rng_uniform(&r->rng, r->seed, r->drawn++);
}

static double gauss(struct room *r) /* [Box 1958] */
{
    const double a = sqrt(-2 * log(1 - uniform(r, 0, 1)));
    return a * cos(2 * PI * uniform(r, 0, 1));
}

static void build_faces(struct room *r)
{
    const double *s = r->size;
    static const double no = 0;
    const struct vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    r->faces[0] = (struct face){.u = x, .v = y, .normal = z, .size = {s[0], s[1]}};
    r->faces[1] = (struct face){.u = x, .v = z, .normal = y, .size = {s[0], s[2]}};
    r->faces[2] = (struct face){{no, s[1], no}, x, z, {0, -1, 0}, {s[0], s[2]}, {0, 0, 0}, 0, 0, 0};
    r->faces[3] = (struct face){.u = y, .v = z, .normal = x, .size = {s[1], s[2]}};
    r->faces[4] = (struct face){{s[0], no, no}, y, z, {-1, 0, 0}, {s[1], s[2]}, {0, 0, 0}, 0, 0, 0};
    for (int i = 0; i < FACES; i++) {
        const double grey = uniform(r, 0.15, 0.8);
        for (int c = 0; c < 3; c++) r->faces[i].albedo[c] = clamp(grey * uniform(r, 0.7, 1.1), 0.1, 0.85);
        r->faces[i].waviness = 0.01 * pow(15, uniform(r, 0, 1));
        r->faces[i].grain = 0.003 * pow(10, uniform(r, 0, 1));
        r->faces[i].length = 0.3 * pow(10, uniform(r, 0, 1));
    }
}

/* The logarithm of the deviation of a face's albedo at a place. */
static double texture(const struct room *r, int face, double u, double v)
{
    const struct rng rng = rng_make(r->seed, "bench", "texture");
    double sum = 0;
    for (uint64_t k = 0; k < WAVES; k++) {
        const uint64_t at = (uint64_t)face * WAVES + k;
        const double turn = 2 * PI * rng_uniform(&rng, at, 0);
        const double wave = 2 * PI / (r->faces[face].length * (0.5 + rng_uniform(&rng, at, 1)));
        sum += cos(wave * (u * cos(turn) + v * sin(turn)) + 2 * PI * rng_uniform(&rng, at, 2));
    }
    return r->faces[face].waviness * sum / sqrt(WAVES / 2.0);
}

static struct vec3 place(const struct room *r, int face, double u, double v)
{
    const struct face *f = &r->faces[face];
    return vec3_add(f->corner, vec3_add(vec3_scale(f->u, u), vec3_scale(f->v, v)));
}

/* A smooth deviation from place to place, about 1. */
static double smooth(const struct room *r, struct vec3 at, int which)
{
    const double *p = r->phase + 3 * which;
    return 1 + 0.2 * sin(at.x + p[0]) * cos(0.8 * at.y + p[1]) * cos(0.7 * at.z + p[2]);
}

static void build_lamps(struct room *r)
{
    const double area = 2 * (r->size[0] * r->size[1] + r->size[0] * r->size[2] + r->size[1] * r->size[2]);
    r->lamp_count = 1 + (int)uniform(r, 0, MAX_LAMPS);
    for (int l = 0; l < r->lamp_count; l++) {
        struct lamp *p = &r->lamps[l];
        const bool square = uniform(r, 0, 1) < 0.4;
        const double half = square ? uniform(r, 0.15, 0.5) : uniform(r, 0.05, 0.12);
        const double share = 0.15 * pow(20, uniform(r, 0, 1)); /* of the other light, right below */
        *p = (struct lamp){
            .shape = square ? LAMP_QUAD : LAMP_DISK,
            .centre = {uniform(r, 0.25, 0.75) * r->size[0], uniform(r, 0.25, 0.75) * r->size[1], r->size[2] - 0.01},
            .normal = {0, 0, -1},
            .x = {half, 0, 0},
            .y = {0, -half, 0},
            .radius = half,
            .radiance = {1, 1, 1},
            .beta = square ? 0.5 * PI : uniform(r, 20, 45) * DEGREE,
            .exponent = square || uniform(r, 0, 1) < 0.5 ? 0 : 1};
        const double below = lamp_irradiance(p, vec3_make(p->centre.x, p->centre.y, 0), vec3_make(0, 0, 1)).r;
        const double s = share / below;
        p->radiance = rgb_make(s * uniform(r, 0.8, 1.2), s, s * uniform(r, 0.6, 1.1));
        const double flux =
            (square ? 4 : PI) * half * half * PI * (1 - pow(cos(p->beta), p->exponent + 2)) * 2 / (p->exponent + 2);
        const double rho = 0.4;
        r->reflected[0] += rho / (1 - rho) * p->radiance.r * flux / area;
        r->reflected[1] += rho / (1 - rho) * p->radiance.g * flux / area;
        r->reflected[2] += rho / (1 - rho) * p->radiance.b * flux / area;
        struct fit_lamp *f = &r->fitted[l];
        *f = (struct fit_lamp){.name = "lamp", .fit = true, .exponent = p->exponent, .seen_is_bound = true};
        const bool saturates = uniform(r, 0, 1) < 0.5;
        const double bound = uniform(r, 0.1, 0.9);
        const double truth[3] = {p->radiance.r, p->radiance.g, p->radiance.b};
        for (int c = 0; saturates && c < 3; c++) {
            f->seen[c] = bound * truth[c];
            f->seen_error[c] = 0.02;
        }
    }
    for (int c = 0; c < 3; c++) r->daylight[c] = uniform(r, 0.6, 1.2);
}

static double direct(const void *ctx, int lamp, int point, double exponent)
{
    const struct room *r = ctx;
    struct lamp l = r->lamps[lamp];
    l.radiance = rgb_grey(1);
    l.exponent = exponent;
    return lamp_irradiance(&l, r->points[point].at, r->normals[point]).r;
}

static void add_point(struct room *r, int face, double u, double v, int lamp, enum fit_point_kind kind, double log_e)
{
    const struct face *f = &r->faces[face];
    if (r->point_count == MAX_POINTS) return;
    const int i = r->point_count++, mark = r->mark_count - 1;
    struct fit_point *p = &r->points[i];
    *p = (struct fit_point){
        .material = face, .lamp = lamp, .mark = mark, .wall = face, .kind = kind, .at = place(r, face, u, v)};
    r->normals[i] = f->normal;
    p->sigma = noise;
    const double shade = exp(texture(r, face, u, v) + f->grain * gauss(r) + r->off[mark]);
    for (int c = 0; c < 3; c++) {
        const double others =
            r->daylight[c] * smooth(r, p->at, 0) / (1 + 0.5 * p->at.x) + r->reflected[c] * smooth(r, p->at, 1);
        double e = others;
        for (int l = 0; l < r->lamp_count; l++) {
            const struct rgb s = r->lamps[l].radiance;
            e += (c == 0 ? s.r : c == 1 ? s.g : s.b) * direct(r, l, i, r->lamps[l].exponent);
        }
        p->radiance[c] = f->albedo[c] / PI * shade * e * exp(noise * gauss(r));
        p->indirect[c] = others * exp(log_e + r->wall_off[face]);
    }
}

/* A new mark, off with the probability `outliers`. Returns the error of its irradiance, in logarithms. */
static double begin_mark(struct room *r, double outliers)
{
    const double off = uniform(r, 0.2, 1), sign = uniform(r, 0, 1) < 0.5 ? -1 : 1;
    r->off[r->mark_count++] = uniform(r, 0, 1) < outliers ? sign * off : 0;
    return mark_error * gauss(r);
}

static void mark_square(struct room *r, int face, double u, double v, int lamp, enum fit_point_kind kind,
                        double outliers, double common)
{
    const double half = uniform(r, 0.1, 0.25), own = begin_mark(r, outliers);
    const double *s = r->faces[face].size;
    for (int k = 0; k < 9; k++)
        add_point(r, face, clamp(u + half * (k % 3 - 1), 0.02, s[0] - 0.02),
                  clamp(v + half * (k / 3 - 1), 0.02, s[1] - 0.02), lamp, kind, common + own);
}

static void mark_spot(struct room *r, int lamp, double outliers, double common)
{
    const struct lamp *l = &r->lamps[lamp];
    const double edge = l->centre.z * tan(l->beta);
    const int lit = 2 + (int)uniform(r, 0, 4), unlit = 1 + (int)uniform(r, 0, 4);
    for (int k = 0; k < lit + unlit; k++) {
        const double turn = uniform(r, 0, 2 * PI);
        const double at = k < lit ? edge * sqrt(uniform(r, 0, 0.6)) : edge + 0.35 + uniform(r, 0, 1);
        mark_square(r, 0, clamp(l->centre.x + at * cos(turn), 0.05, r->size[0] - 0.05),
                    clamp(l->centre.y + at * sin(turn), 0.05, r->size[1] - 0.05), lamp,
                    k < lit ? POINT_LIT : POINT_UNLIT, outliers, common);
    }
    for (int k = 0; k < 2; k++) {
        const double turn = uniform(r, 0, 2 * PI), own = begin_mark(r, outliers);
        for (int i = 0; i < LINE; i++) {
            const double at = edge + 0.4 * (2 * (i + 0.5) / LINE - 1);
            const double u = l->centre.x + at * cos(turn), v = l->centre.y + at * sin(turn);
            if (u > 0 && v > 0 && u < r->size[0] && v < r->size[1])
                add_point(r, 0, u, v, lamp, POINT_ACROSS, common + own);
        }
    }
}

static void mark_panel(struct room *r, int lamp, double outliers, double common)
{
    const int count = 4 + (int)uniform(r, 0, 5);
    for (int k = 0; k < count; k++) {
        const int face = (int)uniform(r, 0, FACES);
        mark_square(r, face, uniform(r, 0.1, 0.9) * r->faces[face].size[0],
                    uniform(r, 0.1, 0.9) * r->faces[face].size[1], lamp, POINT_LIT, outliers, common);
    }
}

static void build(struct room *r, uint64_t seed, double outliers)
{
    memset(r, 0, sizeof *r);
    r->seed = seed;
    r->rng = rng_make(seed, "bench", "lamps");
    r->size[0] = uniform(r, 3, 6);
    r->size[1] = uniform(r, 3, 5);
    r->size[2] = uniform(r, 2.3, 3);
    for (int i = 0; i < 6; i++) r->phase[i] = uniform(r, 0, 2 * PI);
    build_faces(r);
    build_lamps(r);
    const double common = common_error * gauss(r);
    for (int k = 0; k < FACES; k++) r->wall_off[k] = wall_error * gauss(r);
    for (int l = 0; l < r->lamp_count; l++) {
        if (r->lamps[l].shape == LAMP_DISK)
            mark_spot(r, l, outliers, common);
        else
            mark_panel(r, l, outliers, common);
    }
    for (int i = 0; i < FACES; i++) r->materials[i].name = "face";
}

static void score(const struct room *r, struct work *w, int at)
{
    for (int l = 0; l < r->lamp_count; l++) {
        const struct rgb s = r->lamps[l].radiance;
        const double truth[3] = {s.r, s.g, s.b};
        for (int c = 0; c < 3; c++) {
            const struct fit_lamp *f = &r->fitted[l];
            struct outcome *o = &w->outcomes[(at * MAX_LAMPS + l) * 3 + c];
            *o = (struct outcome){f->radiance[c] / truth[c],     f->low[c], f->high[c], truth[c], l,
                                  r->lamps[l].shape == LAMP_QUAD};
        }
    }
    for (int m = 0; m < r->mark_count; m++) {
        const struct fit_mark *k = &r->marks[m];
        const bool named = fabs(expm1(k->off)) > 0.15 && fabs(k->off) > 2.5 * k->off_error;
        if (fabs(r->off[m]) > 0.3) {
            w->off[at]++;
            w->found[at] += named;
        } else if (r->off[m] == 0) {
            w->good[at]++;
            w->wrong[at] += named;
        }
    }
}

static void try_rooms(void *ctx, size_t begin, size_t end, int thread)
{
    struct work *w = ctx;
    struct room *r = calloc(1, sizeof *r);
    (void)thread;
    for (size_t i = begin; r && i < end; i++) {
        struct err err = ERR_INIT;
        build(r, (uint64_t)w->first + i, w->outliers);
        struct light_fit f = {.points = r->points,
                              .lamps = r->fitted,
                              .materials = r->materials,
                              .marks = r->marks,
                              .point_count = r->point_count,
                              .lamp_count = r->lamp_count,
                              .material_count = FACES,
                              .mark_count = r->mark_count,
                              .direct = direct,
                              .ctx = r,
                              .texture = 0.05,
                              .irradiance_error = common_error,
                              .draws = FIT_DRAWS};
        if (fit_solve(&f, &err))
            w->failed = true;
        else
            score(r, w, (int)i);
    }
    w->failed |= !r;
    free(r);
}

static void print(const struct work *w, double seconds)
{
    const size_t most = (size_t)w->rooms * MAX_LAMPS * 3;
    double *errors = malloc((most + 1) * sizeof *errors), *widths = malloc((most + 1) * sizeof *widths);
    size_t n = 0, below = 0, above = 0;
    int found = 0, off = 0, wrong = 0, good = 0;
    for (size_t i = 0; errors && widths && i < most; i++) {
        const struct outcome *o = &w->outcomes[i];
        if (!(o->truth > 0)) continue;
        errors[n] = fabs(o->error - 1);
        widths[n++] = 0.5 * (o->high - o->low) / o->truth;
        below += o->high < o->truth;
        above += o->low > o->truth;
        if (w->verbose)
            printf("room %zu lamp %d %s colour %zu: %.3f of the truth, %.3f to %.3f%s\n", i / 9 + (size_t)w->first,
                   o->lamp, o->square ? "square" : "spot", i % 3, o->error, o->low / o->truth, o->high / o->truth,
                   o->low > o->truth || o->high < o->truth ? " MISSED" : "");
    }
    for (int i = 0; i < w->rooms; i++) {
        found += w->found[i];
        off += w->off[i];
        wrong += w->wrong[i];
        good += w->good[i];
    }
    if (n) {
        sort_doubles(errors, n);
        sort_doubles(widths, n);
        printf("seconds %.6g\nerror %.5g\nerror_nine_tenths %.5g\nwidth %.5g\ncovered %.5g\nbelow %.5g\nabove %.5g\n"
               "intervals %zu\nfound %.5g\nwrong %.5g\n",
               seconds, errors[n / 2], errors[9 * n / 10], widths[n / 2], 1 - (double)(below + above) / (double)n,
               (double)below / (double)n, (double)above / (double)n, n, off ? (double)found / off : 1,
               good ? (double)wrong / good : 0);
    }
    free(errors);
    free(widths);
}

int main(int argc, char **argv)
{
    struct work w = {.rooms = 200};
    int per_cent = 10;
    const struct cli_opt opts[] = {
        CLI_ABOUT("measures how near fitted lamps are to those of simulated rooms"),
        CLI_INT("rooms", &w.rooms, CLI_OPTIONAL, "number of rooms"),
        CLI_INT("first", &w.first, CLI_OPTIONAL, "seed of the first room"),
        CLI_INT("outliers", &per_cent, CLI_OPTIONAL, "marks that are off, per cent"),
        CLI_FLAG("verbose", &w.verbose, "print each interval"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "lamps", opts, &prov, &err) != CLI_RUN) {
        err_report(&err);
        return err_exit_code(&err);
    }
    w.outliers = per_cent / 100.0;
    if (w.rooms < 1) return 2;
    const size_t n = (size_t)w.rooms;
    w.outcomes = calloc(n * MAX_LAMPS * 3, sizeof *w.outcomes);
    w.found = calloc(n, sizeof *w.found);
    w.off = calloc(n, sizeof *w.off);
    w.wrong = calloc(n, sizeof *w.wrong);
    w.good = calloc(n, sizeof *w.good);
    w.failed = !w.outcomes || !w.found || !w.off || !w.wrong || !w.good;
    const double start = clock_cpu_seconds();
    if (!w.failed) parallel_for(n, 1, try_rooms, &w);
    if (!w.failed) print(&w, clock_cpu_seconds() - start);
    free(w.outcomes);
    free(w.found);
    free(w.off);
    free(w.wrong);
    free(w.good);
    provenance_release(&prov);
    return w.failed;
}
