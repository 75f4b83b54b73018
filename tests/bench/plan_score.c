/* plan_score.c - how near a suggested plan is to the true one.
 *
 *   plan_score --truth FILE --plan FILE [--axes FILE]
 *
 * --truth is the plan of made_house, in the world's frame, which --axes takes to the model's; or a plan.txt of a model,
 * in the frame of --plan. --plan is the plan.txt of the suggested script.
 *
 * Walls are compared by the sides of rooms. A side is found where a suggested one runs along it within NEAR; the
 * intersection over union of their lengths is printed, as are rooms whose area has an intersection over union of
 * SAME_ROOM. Openings are the same if their rectangles, on walls within WALL of each other, have one of SAME_OPENING.
 * Bays are left out, with whatever is suggested in their place.
 *
 * Prints "walls F", "walls_error M" (median distance of sides that are found), "rooms N", "rooms_found N",
 * "rooms_suggested N"; the same three numbers of doors and of windows; "openings_error M" (median over the sides of
 * openings that are found), "ceiling_error M", "floor_error M" (with --axes) and "thickness_error M" (median over walls
 * between rooms). M: metres. What is not known is not printed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/cli.h"
#include "common/base/sort.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"
#include "common/model/model_axes.h"
#include "common/model/model_plan.h"

static const double NEAR = 0.05, WALL = 0.3, SAME_ROOM = 0.9, SAME_OPENING = 0.5, SAME_SIDE = 0.3, CELL = 0.02;

enum { MOST_CORNERS = 64 };
enum kind { DOOR, WINDOW, BAY };

struct point {
    double x, y;
};

struct outline {
    struct point corners[MOST_CORNERS];
    int count;
};

struct opening {
    struct point a, b; /* its ends along the wall */
    double z[2];
    enum kind kind;
    bool used;
};

struct thick_wall { /* between rooms */
    struct point a, b;
    double thickness;
};

struct plan {
    struct outline *rooms;
    struct opening *openings;
    struct thick_wall *walls;
    int room_count, opening_count, wall_count;
    double ceiling, floor; /* 0: not known; floor: in the frame of the model */
};

static void plan_release(struct plan *p)
{
    free(p->rooms);
    free(p->openings);
    free(p->walls);
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status add_room(struct plan *p, const struct outline *room, struct err *err)
{
    if (array_append(&p->rooms, (size_t)p->room_count, sizeof *p->rooms, "rooms", err)) return err->status;
    p->rooms[p->room_count++] = *room;
    return ST_OK;
}

static enum status add_opening(struct plan *p, struct opening o, struct err *err)
{
    if (array_append(&p->openings, (size_t)p->opening_count, sizeof *p->openings, "openings", err)) return err->status;
    p->openings[p->opening_count++] = o;
    return ST_OK;
}

static enum status add_wall(struct plan *p, struct thick_wall w, struct err *err)
{
    if (array_append(&p->walls, (size_t)p->wall_count, sizeof *p->walls, "walls", err)) return err->status;
    p->walls[p->wall_count++] = w;
    return ST_OK;
}

static struct point moved(const struct model_axes *axes, double x, double y)
{
    const struct vec3 at = model_from_world_point(axes, vec3_make(x, y, 0));
    return (struct point){at.x, at.y};
}

static double length_of(struct point a, struct point b) { return hypot(b.x - a.x, b.y - a.y); }

/* A line of made_house's plan. */
static enum status read_line(struct plan *p, const char *line, const struct model_axes *axes, struct err *err)
{
    double v[7];
    struct outline room = {.count = 4};
    if (sscanf(line, "ceiling %lf", v) == 1) p->ceiling = v[0] * axes->scale;
    if (sscanf(line, "room %lf %lf %lf %lf", v, v + 1, v + 2, v + 3) == 4) {
        const double x[4] = {v[0], v[2], v[2], v[0]}, y[4] = {v[1], v[1], v[3], v[3]};
        for (int k = 0; k < 4; k++) room.corners[k] = moved(axes, x[k], y[k]);
        return add_room(p, &room, err);
    }
    if (sscanf(line, "wall %lf %lf %lf %lf %lf", v, v + 1, v + 2, v + 3, v + 4) == 5)
        return add_wall(p, (struct thick_wall){moved(axes, v[0], v[1]), moved(axes, v[2], v[3]), v[4] * axes->scale},
                        err);
    static const char *const words[] = {"door", "window", "bay"};
    for (int k = 0; k < 3; k++) {
        const size_t length = strlen(words[k]);
        if (strncmp(line, words[k], length) != 0 ||
            sscanf(line + length, "%lf %lf %lf %lf %lf %lf", v, v + 1, v + 2, v + 3, v + 4, v + 5) != 6)
            continue;
        return add_opening(p,
                           (struct opening){moved(axes, v[0], v[1]),
                                            moved(axes, v[2], v[3]),
                                            {v[4] * axes->scale, v[5] * axes->scale},
                                            (enum kind)k,
                                            false},
                           err);
    }
    return ST_OK;
}

static enum status read_house(struct plan *p, FILE *fp, const struct model_axes *axes, struct err *err)
{
    char line[256];
    p->floor = model_from_world_point(axes, vec3_make(0, 0, 0)).z;
    while (!err->status && fgets(line, sizeof line, fp)) read_line(p, line, axes, err);
    return err->status;
}

/* The point at S on a wall's inner face. */
static struct point on_wall(const struct model_wall *w, double s)
{
    if (fabs(w->normal[0]) > fabs(w->normal[1])) return (struct point){w->offset / w->normal[0], s};
    return (struct point){s, w->offset / w->normal[1]};
}

static bool has_wall(const struct model_room *r, int wall)
{
    for (int k = 0; k < r->corner_count; k++)
        if (r->corners[k].wall == wall) return true;
    return false;
}

/* Whether rooms lie on both sides of a wall. */
static bool is_between_rooms(const struct model_plan *m, int wall)
{
    const struct model_wall *w = &m->walls[wall];
    int sides = 0;
    for (int i = 0; i < m->room_count; i++) {
        const struct model_room *r = &m->rooms[i];
        double sum = 0;
        if (!has_wall(r, wall)) continue;
        for (int k = 0; k < r->corner_count; k++)
            sum += w->normal[0] * r->corners[k].x + w->normal[1] * r->corners[k].y - w->offset;
        sides |= sum > 0 ? 1 : 2;
    }
    return sides == 3;
}

static enum status read_model(struct plan *p, const char *path, struct err *err)
{
    struct model_plan m = {0};
    if (model_plan_read(&m, path, NULL, err)) return err->status;
    for (int i = 0; !err->status && i < m.room_count; i++) {
        const struct model_room *r = &m.rooms[i];
        struct outline room = {.count = r->corner_count < MOST_CORNERS ? r->corner_count : MOST_CORNERS};
        for (int k = 0; k < room.count; k++) room.corners[k] = (struct point){r->corners[k].x, r->corners[k].y};
        p->ceiling = fmax(p->ceiling, model_room_ceiling(r, r->corners[0].x, r->corners[0].y) - r->floor);
        add_room(p, &room, err);
    }
    for (int i = 0; !err->status && i < m.opening_count; i++) {
        const struct model_opening *o = &m.openings[i];
        const struct model_wall *w = &m.walls[o->wall];
        add_opening(p,
                    (struct opening){on_wall(w, o->s[0]),
                                     on_wall(w, o->s[1]),
                                     {o->z[0], o->z[1]},
                                     o->kind == MODEL_WINDOW ? WINDOW : DOOR,
                                     false},
                    err);
    }
    for (int i = 0; !err->status && i < m.wall_count; i++)
        if (is_between_rooms(&m, i))
            add_wall(p,
                     (struct thick_wall){on_wall(&m.walls[i], m.walls[i].span[0]),
                                         on_wall(&m.walls[i], m.walls[i].span[1]), m.walls[i].thickness},
                     err);
    model_plan_release(&m);
    return err->status;
}

/* axes: NULL for the plan of a model */
static enum status plan_read(struct plan *p, const char *path, const struct model_axes *axes, struct err *err)
{
    *p = (struct plan){0};
    if (!axes) return read_model(p, path, err);
    FILE *fp = fopen(path, "r");
    if (!fp) return err_set(err, ST_IO, "cannot read %s.", path);
    read_house(p, fp, axes, err);
    fclose(fp);
    if (!err->status && !p->room_count)
        err_set(err, ST_DATA, "%s: no line begins with \"room\"; give the plan.txt of made_house.", path);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- measures */

/* How far b's line lies from a's, where they run along each other within NEAR; their common length. */
static double common_length(struct point a0, struct point a1, struct point b0, struct point b1, double *distance)
{
    const double length = length_of(a0, a1);
    if (!(length > 0)) return 0;
    const double ux = (a1.x - a0.x) / length, uy = (a1.y - a0.y) / length;
    double s[2], d[2];
    for (int k = 0; k < 2; k++) {
        const double x = (k ? b1.x : b0.x) - a0.x, y = (k ? b1.y : b0.y) - a0.y;
        s[k] = x * ux + y * uy;
        d[k] = x * uy - y * ux;
    }
    *distance = fabs(d[0] + d[1]) / 2;
    if (fabs(d[0]) > 2 * NEAR || fabs(d[1]) > 2 * NEAR || *distance > NEAR) return 0;
    return fmax(0, fmin(length, fmax(s[0], s[1])) - fmax(0, fmin(s[0], s[1])));
}

static double walls_length(const struct plan *p)
{
    double sum = 0;
    for (int i = 0; i < p->room_count; i++)
        for (int k = 0; k < p->rooms[i].count; k++)
            sum += length_of(p->rooms[i].corners[k], p->rooms[i].corners[(k + 1) % p->rooms[i].count]);
    return sum;
}

static enum status score_walls(const struct plan *truth, const struct plan *found, struct err *err)
{
    struct weighted *errors = NULL;
    size_t count = 0;
    double both = 0;
    for (int i = 0; i < truth->room_count; i++)
        for (int k = 0; k < truth->rooms[i].count; k++) {
            const struct outline *t = &truth->rooms[i];
            const struct point a0 = t->corners[k], a1 = t->corners[(k + 1) % t->count];
            double here = 0;
            for (int j = 0; j < found->room_count; j++)
                for (int l = 0; l < found->rooms[j].count; l++) {
                    const struct outline *f = &found->rooms[j];
                    double distance;
                    const double common =
                        common_length(a0, a1, f->corners[l], f->corners[(l + 1) % f->count], &distance);
                    if (!(common > 0)) continue;
                    here += common;
                    if (array_append(&errors, count, sizeof *errors, "walls", err)) return err->status;
                    errors[count++] = (struct weighted){distance, common};
                }
            both += fmin(here, length_of(a0, a1));
        }
    printf("walls %.4g\n", both / (walls_length(truth) + walls_length(found) - both));
    if (count) printf("walls_error %.3g\n", weighted_percentile(errors, count, 0.5));
    free(errors);
    return ST_OK;
}

static bool is_inside(const struct outline *o, double x, double y)
{
    bool in = false;
    for (int k = 0; k < o->count; k++) {
        const struct point a = o->corners[k], b = o->corners[(k + 1) % o->count];
        if ((a.y > y) != (b.y > y) && x < (b.x - a.x) * (y - a.y) / (b.y - a.y) + a.x) in = !in;
    }
    return in;
}

/* Intersection over union of two areas, by a grid. */
static double same_area(const struct outline *a, const struct outline *b)
{
    struct point low = {INFINITY, INFINITY}, high = {-INFINITY, -INFINITY};
    double both = 0, either = 0;
    for (int n = 0; n < 2; n++) {
        const struct outline *o = n ? b : a;
        for (int k = 0; k < o->count; k++) {
            low = (struct point){fmin(low.x, o->corners[k].x), fmin(low.y, o->corners[k].y)};
            high = (struct point){fmax(high.x, o->corners[k].x), fmax(high.y, o->corners[k].y)};
        }
    }
    for (double x = low.x + CELL / 2; x < high.x; x += CELL)
        for (double y = low.y + CELL / 2; y < high.y; y += CELL) {
            const bool in_a = is_inside(a, x, y), in_b = is_inside(b, x, y);
            both += in_a && in_b;
            either += in_a || in_b;
        }
    return either > 0 ? both / either : 0;
}

static void score_rooms(const struct plan *truth, const struct plan *found)
{
    int count = 0;
    for (int i = 0; i < truth->room_count; i++)
        for (int j = 0; j < found->room_count; j++)
            if (same_area(&truth->rooms[i], &found->rooms[j]) >= SAME_ROOM) {
                count++;
                break;
            }
    printf("rooms %d\nrooms_found %d\nrooms_suggested %d\n", truth->room_count, count, found->room_count);
}

/* S of b's ends along a, and whether they are on about the same wall. */
static bool along(const struct opening *a, const struct opening *b, double s[2])
{
    const double length = length_of(a->a, a->b), ux = (a->b.x - a->a.x) / length, uy = (a->b.y - a->a.y) / length;
    for (int k = 0; k < 2; k++) {
        const double x = (k ? b->b.x : b->a.x) - a->a.x, y = (k ? b->b.y : b->a.y) - a->a.y;
        if (fabs(x * uy - y * ux) > WALL) return false;
        s[k] = x * ux + y * uy;
    }
    if (s[0] > s[1]) {
        const double swap = s[0];
        s[0] = s[1];
        s[1] = swap;
    }
    return true;
}

static double overlap(double a0, double a1, double b0, double b1) { return fmax(0, fmin(a1, b1) - fmax(a0, b0)); }

/* Intersection over union of two openings' rectangles; errors: distances of their four sides. */
static double same_opening(const struct opening *a, const struct opening *b, double errors[4])
{
    const double length = length_of(a->a, a->b);
    double s[2];
    if (!(length > 0) || !along(a, b, s)) return 0;
    const double both = overlap(0, length, s[0], s[1]) * overlap(a->z[0], a->z[1], b->z[0], b->z[1]);
    errors[0] = fabs(s[0]);
    errors[1] = fabs(s[1] - length);
    for (int k = 0; k < 2; k++) errors[2 + k] = fabs(a->z[k] - b->z[k]);
    return both / (length * (a->z[1] - a->z[0]) + (s[1] - s[0]) * (b->z[1] - b->z[0]) - both);
}

/* Whether something is suggested where a bay is. */
static bool is_of_bay(const struct plan *truth, const struct opening *o)
{
    for (int i = 0; i < truth->opening_count; i++) {
        const struct opening *t = &truth->openings[i];
        double s[2];
        if (t->kind == BAY && along(t, o, s) && overlap(0, length_of(t->a, t->b), s[0], s[1]) > 0) return true;
    }
    return false;
}

static enum status score_openings(const struct plan *truth, struct plan *found, struct err *err)
{
    static const char *const names[] = {"doors", "windows"};
    double *errors = NULL;
    size_t count = 0;
    for (int kind = DOOR; kind <= WINDOW; kind++) {
        int wanted = 0, hits = 0, suggested = 0;
        for (int i = 0; i < truth->opening_count; i++) {
            const struct opening *t = &truth->openings[i];
            double best = SAME_OPENING, off[4], best_off[4];
            int at = -1;
            if ((int)t->kind != kind) continue;
            wanted++;
            for (int j = 0; j < found->opening_count; j++) {
                const struct opening *f = &found->openings[j];
                if ((int)f->kind != kind || f->used) continue;
                const double same = same_opening(t, f, off);
                if (same < best) continue;
                best = same;
                at = j;
                memcpy(best_off, off, sizeof off);
            }
            if (at < 0) continue;
            found->openings[at].used = true;
            hits++;
            for (int k = 0; k < 4; k++, count++) {
                if (array_append(&errors, count, sizeof *errors, "openings", err)) return err->status;
                errors[count] = best_off[k];
            }
        }
        for (int j = 0; j < found->opening_count; j++)
            suggested += (int)found->openings[j].kind == kind &&
                         (found->openings[j].used || !is_of_bay(truth, &found->openings[j]));
        printf("%s %d\n%s_found %d\n%s_suggested %d\n", names[kind], wanted, names[kind], hits, names[kind], suggested);
    }
    if (count) printf("openings_error %.3g\n", sort_median(errors, count));
    free(errors);
    return ST_OK;
}

/* A wall between rooms that runs along a true one for SAME_SIDE, within half of its thickness, is the same. */
static enum status score_thickness(const struct plan *truth, const struct plan *found, struct err *err)
{
    double *errors = NULL;
    size_t count = 0;
    for (int i = 0; i < found->wall_count; i++) {
        const struct thick_wall *f = &found->walls[i];
        for (int j = 0; j < truth->wall_count; j++) {
            const struct thick_wall *t = &truth->walls[j];
            const struct opening a = {t->a, t->b, {0, 1}, DOOR, false}, b = {f->a, f->b, {0, 1}, DOOR, false};
            double s[2];
            if (!along(&a, &b, s) || overlap(0, length_of(t->a, t->b), s[0], s[1]) < SAME_SIDE * (s[1] - s[0]))
                continue;
            if (array_append(&errors, count, sizeof *errors, "walls", err)) return err->status;
            errors[count++] = fabs(t->thickness - f->thickness);
            break;
        }
    }
    if (count) printf("thickness_error %.3g\n", sort_median(errors, count));
    free(errors);
    return ST_OK;
}

static enum status score(const char *truth_path, const char *plan_path, const char *axes_path, struct err *err)
{
    struct model_axes axes;
    struct plan truth = {0}, found = {0};
    if (axes_path) model_axes_read(&axes, axes_path, NULL, err);
    if (!err->status && !plan_read(&truth, truth_path, axes_path ? &axes : NULL, err))
        plan_read(&found, plan_path, NULL, err);
    if (!err->status && !score_walls(&truth, &found, err)) {
        score_rooms(&truth, &found);
        score_openings(&truth, &found, err);
    }
    if (!err->status) score_thickness(&truth, &found, err);
    if (!err->status && truth.ceiling > 0 && found.ceiling > 0)
        printf("ceiling_error %.3g\n", fabs(truth.ceiling - found.ceiling));
    if (!err->status && axes_path) printf("floor_error %.3g\n", fabs(truth.floor));
    plan_release(&truth);
    plan_release(&found);
    return err->status;
}

int main(int argc, char **argv)
{
    const char *truth = NULL, *plan = NULL, *axes = NULL;
    const struct cli_opt opts[] = {
        CLI_ABOUT("How near a suggested plan is to the true one."),
        CLI_STR("truth", &truth, CLI_REQUIRED, "the true plan"),
        CLI_STR("plan", &plan, CLI_REQUIRED, "plan.txt of the suggested script"),
        CLI_STR("axes", &axes, CLI_OPTIONAL, "the model's frame, axes.txt, if the true plan is made_house's"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "plan_score", opts, &prov, &err) == CLI_RUN) score(truth, plan, axes, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
