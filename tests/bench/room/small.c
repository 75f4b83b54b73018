/* small.c - the same room in fewer and smaller photos, for benches of many rooms.
 *
 * The photo that shows least of what the others do not show is left out, and so on, as long as the photos that decide
 * the model's axes look north (photos.c). A surface point that n photos show counts as 1 / n^2. Photos in which
 * openings and lamps are marked stay. If nobody could mark the room and its lamps in what is left, one photo less is
 * left out. */
#include <string.h>

#include "tests/bench/room/sight.h"

enum { FEWEST = 12, FEWEST_OF_TWO = 14, POINTS = 900, TRIES = 40, STEPS = 16 };
#define NEAREST  0.4 /* what a photo shows: distances, m */
#define FARTHEST 6.0
#define SLANT    0.2  /* least cosine between the view and a surface's normal */
#define OFF      0.02 /* m before wall and floor, where a line must be seen */
#define EDGE     8    /* px between a mark and the edge of the photo */
#define SHORTEST 40   /* px of a line */
#define AHEAD    0.85 /* least part of the central photo's direction that is north */

struct shown {
    struct sight sight;
    bool sees[MADE_PHOTOS][POINTS];
    bool needed[MADE_PHOTOS]; /* openings and lamps are marked in it */
};

static bool sees(const struct sight *s, const struct made_photo *photo, struct vec3 at, struct vec3 normal)
{
    const struct vec3 back = vec3_sub(photo->at, at);
    const double distance = vec3_length(back);
    double u, v;
    return distance > NEAREST && distance < FARTHEST && vec3_dot(back, normal) > SLANT * distance &&
           photo_project(photo, at, 5, &u, &v) && sight_clear(s, photo->at, at);
}

/* Points on what rays from the photos' places meet, all around. */
static void look_around(struct shown *shown, const struct made_room *r)
{
    struct dice d = dice_make(r->seed, "small", 0);
    for (int i = 0; i < POINTS; i++) {
        struct sight_hit hit = {.owner = SIGHT_NOTHING};
        struct vec3 from = r->photos[0].at, way = {0, 0, 1};
        for (int k = 0; k < TRIES && hit.owner == SIGHT_NOTHING; k++) {
            const double z = dice_between(&d, -1, 1), turn = dice_between(&d, -M_PI, M_PI), flat = sqrt(1 - z * z);
            from = r->photos[dice_choose(&d, r->photo_count)].at;
            way = vec3_make(flat * cos(turn), flat * sin(turn), z);
            hit = sight_cast(&shown->sight, from, way);
        }
        const struct vec3 at = vec3_add(from, vec3_scale(way, hit.distance));
        for (int k = 0; k < r->photo_count; k++)
            shown->sees[k][i] = hit.owner != SIGHT_NOTHING && sees(&shown->sight, &r->photos[k], at, hit.normal);
    }
}

/* Whether the axes of the model are still those of the scene. */
static bool looks_north(const struct made_room *r)
{
    struct vec3 middle = {0, 0, 0};
    double east = 0, north = 0;
    int central = 0;
    for (int k = 0; k < r->photo_count; k++) {
        middle = vec3_add(middle, vec3_scale(r->photos[k].at, 1.0 / r->photo_count));
        east += r->photos[k].cam_from_world.m[2][0];
        north += r->photos[k].cam_from_world.m[2][1];
    }
    for (int k = 1; k < r->photo_count; k++)
        if (vec3_length(vec3_sub(r->photos[k].at, middle)) < vec3_length(vec3_sub(r->photos[central].at, middle)))
            central = k;
    return r->photos[central].cam_from_world.m[2][1] > AHEAD && north > fabs(east) + 0.1 * r->photo_count;
}

static void leave_out(struct made_room *r, struct shown *shown, int k)
{
    r->photo_count--;
    memmove(r->photos + k, r->photos + k + 1, (size_t)(r->photo_count - k) * sizeof *r->photos);
    memmove(shown->sees + k, shown->sees + k + 1, (size_t)(r->photo_count - k) * sizeof *shown->sees);
    memmove(shown->needed + k, shown->needed + k + 1, (size_t)(r->photo_count - k) * sizeof *shown->needed);
}

static double loss_of(const struct made_room *r, const struct shown *shown, int k)
{
    double sum = 0;
    for (int i = 0; i < POINTS; i++) {
        int n = 0;
        for (int p = 0; p < r->photo_count; p++) n += shown->sees[p][i];
        if (shown->sees[k][i]) sum += 1.0 / (n * n);
    }
    return sum;
}

/* Leaves photos out down to a number, or as many as can go. */
static void thin_out(struct made_room *r, int wanted)
{
    static struct shown shown; /* too large for the stack */
    memset(&shown, 0, sizeof shown);
    sight_build(&shown.sight, r);
    look_around(&shown, r);
    for (int i = 0; i < r->opening_count; i++) shown.needed[r->opening_marks[i].photo] = true;
    for (int i = 0; i < r->lamp_count; i++)
        if (r->lamp_marks[i][0].photo >= 0) shown.needed[r->lamp_marks[i][0].photo] = true;
    while (r->photo_count > wanted) {
        int best = -1;
        double least = HUGE_VAL;
        for (int k = 0; k < r->photo_count; k++) {
            static struct made_room after; /* too large for the stack */
            const double loss = loss_of(r, &shown, k);
            if (shown.needed[k] || loss >= least) continue;
            after = *r;
            memmove(after.photos + k, after.photos + k + 1, (size_t)(r->photo_count - k - 1) * sizeof *after.photos);
            after.photo_count--;
            if (!looks_north(&after)) continue;
            best = k;
            least = loss;
        }
        if (best < 0) return;
        leave_out(r, &shown, best);
    }
}

static void clear_marks(struct made_room *r)
{
    memset(r->picture_marks, 0, sizeof r->picture_marks);
    memset(r->lit, 0, sizeof r->lit);
    memset(&r->cleared_marks, 0, sizeof r->cleared_marks);
    memset(&r->moved_marks, 0, sizeof r->moved_marks);
}

static void shrink(struct made_mark *marks, int count, double by)
{
    for (int i = 0; i < count; i++) {
        marks[i].x0 *= by;
        marks[i].y0 *= by;
        marks[i].x1 *= by;
        marks[i].y1 *= by;
    }
}

static void shrink_marks(struct made_room *r, double by)
{
    shrink(r->wall_marks, r->wall_count, by);
    shrink(r->opening_marks, r->opening_count, by);
    for (int i = 0; i < r->wall_count; i++) shrink(&r->wall_lines[i].mark, 1, by);
    for (int i = 0; i < r->lamp_count; i++) {
        shrink(r->lamp_marks[i], 2, by);
        shrink(r->lit[i].list, r->lit[i].count, by);
    }
    shrink(r->cleared_marks.list, r->cleared_marks.count, by);
    shrink(r->moved_marks.list, r->moved_marks.count, by);
    for (int i = 0; i < r->picture_count; i++) shrink(r->picture_marks[i].list, r->picture_marks[i].count, by);
}

/* ---------------------------------------------------------------------------------------------------------- marks */

/* The pixel of a place where a wall's inside meets the floor or the ceiling; false: it is not seen. */
static bool mark_place(double *u, double *v, const struct made_room *r, const struct sight *s,
                       const struct made_photo *photo, const struct made_wall *w, double along, bool top)
{
    struct vec3 p = made_wall_place(w, along, w->thickness / 2);
    p.z = top ? r->ceiling : 0;
    struct vec3 before = vec3_add(p, vec3_scale(made_wall_normal(w), OFF));
    before.z += top ? -OFF : OFF;
    return photo_project(photo, p, EDGE, u, v) && sight_clear(s, photo->at, before);
}

/* The longest line, in pixels, that a photo shows both ends of. Few small photos give blank walls too few points for a
 * rectangle. */
static struct made_line longest_line(const struct made_room *r, const struct sight *s, const struct made_wall *w)
{
    const double length = made_wall_length(w), inset = 0.25;
    struct made_line best = {.is = false};
    double most = 0;
    for (int k = 0; k < 2 * r->photo_count; k++) {
        double u[STEPS + 1], v[STEPS + 1];
        bool seen[STEPS + 1];
        for (int i = 0; i <= STEPS; i++)
            seen[i] =
                mark_place(&u[i], &v[i], r, s, &r->photos[k / 2], w, inset + (length - 2 * inset) * i / STEPS, k % 2);
        for (int a = 0; a < STEPS; a++)
            for (int b = a + 1; b <= STEPS; b++) {
                const double pixels = hypot(u[b] - u[a], v[b] - v[a]);
                if (!seen[a] || !seen[b] || pixels <= most) continue;
                most = pixels;
                best = (struct made_line){most > SHORTEST, k % 2, {k / 2, u[a], v[a], u[b], v[b]}};
            }
    }
    return best;
}

static void mark_lines(struct made_room *r)
{
    struct sight s;
    sight_build(&s, r);
    for (int i = 0; i < r->wall_count; i++) r->wall_lines[i] = longest_line(r, &s, &r->walls[i]);
}

/* Lamps that are marked in all photos, and in fewer. */
static bool keeps_lamps(const struct made_room *all, const struct made_room *r)
{
    for (int i = 0; i < r->lamp_count; i++)
        if (all->lamp_marks[i][0].photo >= 0 && (r->lamp_marks[i][0].photo < 0 || !r->lit[i].count)) return false;
    return true;
}

void made_small(struct made_room *r)
{
    static struct made_room all; /* too large for the stack */
    bool marked = false;
    all = *r;
    for (int n = r->shape == SHAPE_RECTANGLE ? FEWEST : FEWEST_OF_TWO; !marked && n < all.photo_count; n++) {
        *r = all;
        clear_marks(r);
        thin_out(r, n);
        marked = made_marks(r) && keeps_lamps(&all, r);
    }
    if (!marked) *r = all;
    mark_lines(r);
    r->scale = MADE_SMALL;
    shrink_marks(r, r->scale / MADE_SCALE);
}
