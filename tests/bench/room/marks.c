/* marks.c - what a person would mark in the photos of a made room: rectangles on walls, corners of openings and lamps,
 * furniture, corners of pictures, walls that a lamp lights.
 *
 * A picture of what each photo shows, in cells of some pixels, gives the largest rectangle that shows one wall alone,
 * and the pixels of a piece of furniture. Corners are projected, and marked where nothing hides them. */
#include <string.h>

#include "tests/bench/room/sight.h"

#define CELL   10
#define INSET  2   /* px between a rectangle and the cells around it */
#define EDGE   6   /* px between a mark and the edge of the photo */
#define FACING 0.3 /* least cosine between a view and the normal of a wall that it marks */

enum { ACROSS = MADE_WIDTH / CELL, DOWN = MADE_HEIGHT / CELL };

struct cells {
    int owner[DOWN][ACROSS];
};

/* What a photo shows; a wall counts only where its inside is seen well. */
static void show(struct cells *cells, const struct made_room *r, const struct sight *s, const struct made_photo *photo)
{
    for (int y = 0; y < DOWN; y++)
        for (int x = 0; x < ACROSS; x++) {
            const struct vec3 ray = photo_ray(photo, (x + 0.5) * CELL, (y + 0.5) * CELL);
            const struct sight_hit hit = sight_cast(s, photo->at, ray);
            const bool wall = hit.owner >= SIGHT_WALL && hit.owner < SIGHT_PIECE;
            cells->owner[y][x] = hit.owner;
            if (!wall) continue;
            const struct vec3 normal = made_wall_normal(&r->walls[hit.owner - SIGHT_WALL]);
            if (vec3_dot(hit.normal, normal) < 0.99 || vec3_dot(ray, normal) > -FACING)
                cells->owner[y][x] = SIGHT_NOTHING;
        }
}

/* ------------------------------------------------------------------------------------------------------------ walls */

/* The largest rectangle of cells of one owner; its number of cells. box: x0 y0 x1 y1, the last ones inside. */
static int largest_rectangle(int box[4], const struct cells *cells, int owner)
{
    int most = 0;
    for (int x0 = 0; x0 < ACROSS; x0++)
        for (int y0 = 0; y0 < DOWN; y0++)
            for (int y1 = y0, x1 = ACROSS; y1 < DOWN; y1++) {
                int x = x0;
                while (x < x1 && cells->owner[y1][x] == owner) x++;
                x1 = x;
                const int size = (x1 - x0) * (y1 - y0 + 1);
                if (size <= most || x1 - x0 < 3 || y1 - y0 < 2) continue;
                most = size;
                memcpy(box, (const int[]){x0, y0, x1 - 1, y1}, 4 * sizeof *box);
            }
    return most;
}

static void mark_walls(struct made_room *r, const struct cells *cells)
{
    for (int w = 0; w < r->wall_count; w++) {
        int most = 0;
        r->wall_marks[w].photo = -1;
        for (int k = 0; k < r->photo_count; k++) {
            int box[4];
            const int size = largest_rectangle(box, &cells[k], SIGHT_WALL + w);
            if (size <= most) continue;
            most = size;
            r->wall_marks[w] = (struct made_mark){k, box[0] * CELL + INSET, box[1] * CELL + INSET,
                                                  (box[2] + 1) * CELL - INSET, (box[3] + 1) * CELL - INSET};
        }
    }
}

/* ---------------------------------------------------------------------------------------------------------- corners */

/* The place at s, z on the inside of a wall. */
static struct vec3 on_wall(const struct made_wall *w, double s, double z)
{
    const struct vec3 p = made_wall_place(w, s, w->thickness / 2);
    return vec3_make(p.x, p.y, z);
}

/* The pixel of a place on a wall's inside that nothing hides. */
static bool mark_corner(double *u, double *v, const struct made_photo *photo, const struct sight *s,
                        const struct made_wall *w, struct vec3 p)
{
    const struct vec3 before = vec3_add(p, vec3_scale(made_wall_normal(w), 0.02));
    const struct vec3 back = vec3_sub(photo->at, p);
    return vec3_dot(back, made_wall_normal(w)) > 0.15 * vec3_length(back) && photo_project(photo, p, EDGE, u, v) &&
           sight_clear(s, photo->at, before);
}

/* For a viewer in the room the left end of an opening is at its larger s. */
static void mark_opening(struct made_room *r, const struct sight *s, int i)
{
    const struct made_opening *o = &r->openings[i];
    const struct made_wall *w = &r->walls[o->wall];
    double most = 0;
    r->opening_marks[i].photo = -1;
    for (int k = 0; k < r->photo_count; k++) {
        struct made_mark m = {.photo = k};
        if (!mark_corner(&m.x0, &m.y0, &r->photos[k], s, w, on_wall(w, o->s1, o->z1)) ||
            !mark_corner(&m.x1, &m.y1, &r->photos[k], s, w, on_wall(w, o->s0, o->z0)))
            continue;
        if (m.x1 < m.x0 + EDGE || m.y1 < m.y0 + EDGE || (m.x1 - m.x0) * (m.y1 - m.y0) <= most) continue;
        most = (m.x1 - m.x0) * (m.y1 - m.y0);
        r->opening_marks[i] = m;
    }
}

/* All four corners of a lamp in one photo, the one that shows it largest, of those in which nothing hides a corner. */
static void mark_lamp(struct made_room *r, const struct sight *s, int i)
{
    const struct made_lamp *lamp = &r->lamps[i];
    const double x = lamp->x, y = lamp->y, far = lamp->side, z = r->ceiling - 0.012;
    const struct vec3 corner[4] = {{x, y, z}, {x + far, y, z}, {x + far, y + far, z}, {x, y + far, z}};
    double most = 0;
    r->lamp_marks[i][0].photo = -1;
    for (int k = 0; k < r->photo_count; k++) {
        double u[4], v[4], area = 0;
        bool all = true;
        for (int c = 0; c < 4; c++) {
            const struct vec3 below = vec3_sub(corner[c], vec3_make(0, 0, 0.02));
            all = all && photo_project(&r->photos[k], corner[c], EDGE, &u[c], &v[c]) &&
                  sight_clear(s, r->photos[k].at, below);
        }
        if (!all) continue;
        for (int c = 0; c < 4; c++) area += 0.5 * (u[c] * v[(c + 1) % 4] - u[(c + 1) % 4] * v[c]);
        if (fabs(area) <= most) continue;
        most = fabs(area);
        for (int c = 0; c < 2; c++)
            r->lamp_marks[i][c] = (struct made_mark){k, u[2 * c], v[2 * c], u[2 * c + 1], v[2 * c + 1]};
    }
}

/* ------------------------------------------------------------------------------------------------- what lamps light */

#define WALL_EDGE 0.15 /* m between a lit square and the ends, floor and ceiling of its wall, and pictures */
#define AT_LAMP   0.35 /* least cosine between the way to a lamp and the normals of the wall and of the lamp */
#define LIT_STEP  4    /* px, by which half of a lit square grows, */
#define LIT_MOST  40   /* at most to this */
#define LIT_TRIES 150  /* of which the largest square is marked */

/* The wall that a pixel shows where a lamp lights it in full and the sun does not; -1: none. */
static int lit_wall(const struct made_room *r, const struct sight *s, const struct made_lamp *lamp, int photo, double u,
                    double v)
{
    const struct vec3 ray = photo_ray(&r->photos[photo], u, v);
    const struct sight_hit hit = sight_cast(s, r->photos[photo].at, ray);
    if (hit.owner < SIGHT_WALL || hit.owner >= SIGHT_PIECE) return -1;
    const int wall = hit.owner - SIGHT_WALL;
    const struct made_wall *w = &r->walls[wall];
    const struct vec3 normal = made_wall_normal(w), p = vec3_add(r->photos[photo].at, vec3_scale(ray, hit.distance));
    const double along =
        vec3_dot(vec3_sub(p, made_wall_place(w, 0, 0)), vec3_normalize(vec3_make(w->x1 - w->x0, w->y1 - w->y0, 0)));
    if (vec3_dot(hit.normal, normal) < 0.99 || vec3_dot(ray, normal) > -FACING) return -1;
    if (p.z < WALL_EDGE || p.z > r->ceiling - WALL_EDGE || along < WALL_EDGE ||
        along > made_wall_length(w) - WALL_EDGE || made_on_picture(r, wall, along, p.z, WALL_EDGE))
        return -1;
    const struct vec3 before = vec3_add(p, vec3_scale(normal, 0.02));
    for (int k = 0; k < 4; k++) { /* the lamp's corners */
        const struct vec3 corner =
            vec3_make(lamp->x + lamp->side * (k & 1), lamp->y + lamp->side * (k >> 1), r->ceiling - 0.02);
        const struct vec3 way = vec3_normalize(vec3_sub(corner, before));
        if (vec3_dot(way, normal) < AT_LAMP || way.z < AT_LAMP || !sight_clear(s, before, corner)) return -1;
    }
    const double azimuth = r->sun_azimuth * M_PI / 180, elevation = r->sun_elevation * M_PI / 180;
    const struct vec3 sun = vec3_make(cos(azimuth) * cos(elevation), sin(azimuth) * cos(elevation), sin(elevation));
    return sight_cast(s, before, sun).owner == SIGHT_NOTHING ? -1 : wall;
}

/* Half of the side of the largest square about a pixel that shows one wall, lit as above; 0: there is none. */
static int lit_square(const struct made_room *r, const struct sight *s, const struct made_lamp *lamp, int photo,
                      double u, double v)
{
    const int wall = lit_wall(r, s, lamp, photo, u, v);
    int half = 0;
    for (bool all = wall >= 0; all && half < LIT_MOST; half += all * LIT_STEP) {
        const int next = half + LIT_STEP;
        for (int k = 0; all && k < 8; k++) { /* around its edge */
            const int x = k < 3 ? -1 : k < 5 ? 0 : 1, y = k < 3 ? k - 1 : k < 5 ? 2 * k - 7 : k - 6;
            all = lit_wall(r, s, lamp, photo, u + x * next, v + y * next) == wall;
        }
    }
    return half;
}

/* Large squares of plain wall, as a person would choose them: lit by the lamp, without sun, shadow or picture. */
static void mark_lit(struct made_room *r, const struct sight *s, int i)
{
    struct dice d = dice_make(r->seed, "lit", i);
    struct made_lit *lit = &r->lit[i];
    for (int n = 0; n < MADE_LIT; n++) {
        struct made_mark best = {.photo = -1};
        int most = 0;
        for (int k = 0; k < LIT_TRIES; k++) {
            const int photo = dice_choose(&d, r->photo_count);
            const double u = round(dice_between(&d, EDGE, MADE_WIDTH - EDGE));
            const double v = round(dice_between(&d, EDGE, MADE_HEIGHT - EDGE));
            const int half = lit_square(r, s, &r->lamps[i], photo, u, v);
            if (half <= most || u - half < EDGE || u + half > MADE_WIDTH - EDGE || v - half < EDGE ||
                v + half > MADE_HEIGHT - EDGE)
                continue;
            most = half;
            best = (struct made_mark){photo, u - half, v - half, u + half, v + half};
            lit->walls[lit->count] = lit_wall(r, s, &r->lamps[i], photo, u, v);
        }
        if (best.photo >= 0) lit->list[lit->count++] = best;
    }
}

/* A picture's upper left corner, in the photo that is first to show it and in those farthest from it. */
static void mark_picture(struct made_room *r, const struct sight *s, int i)
{
    const struct made_picture *p = &r->pictures[i];
    const struct made_wall *w = &r->walls[p->wall];
    struct vec3 corner = on_wall(w, p->s, p->z + p->high);
    struct made_marks *marks = &r->picture_marks[i];
    corner = vec3_add(corner, vec3_scale(made_wall_normal(w), 0.004));
    while (marks->count < MADE_MARKS) {
        double farthest = 0.6; /* m between the photos */
        struct made_mark best = {.photo = -1};
        for (int k = 0; k < r->photo_count; k++) {
            struct made_mark m = {.photo = k};
            double apart = HUGE_VAL;
            if (!mark_corner(&m.x0, &m.y0, &r->photos[k], s, w, corner)) continue;
            for (int n = 0; n < marks->count; n++)
                apart = fmin(apart, vec3_length(vec3_sub(r->photos[k].at, r->photos[marks->list[n].photo].at)));
            if (apart <= farthest) continue;
            farthest = apart;
            best = m;
        }
        if (best.photo < 0) return;
        marks->list[marks->count++] = best;
    }
}

/* -------------------------------------------------------------------------------------------------------- furniture */

/* The cell of an owner that is nearest to the middle of all of them; their number. */
static int middle_cell(struct made_mark *m, const struct cells *cells, int owner)
{
    double x_sum = 0, y_sum = 0, nearest = HUGE_VAL;
    int n = 0;
    for (int y = 0; y < DOWN; y++)
        for (int x = 0; x < ACROSS; x++) {
            if (cells->owner[y][x] != owner) continue;
            x_sum += x;
            y_sum += y;
            n++;
        }
    for (int y = 0; y < DOWN; y++)
        for (int x = 0; x < ACROSS; x++) {
            if (cells->owner[y][x] != owner) continue;
            const double off = hypot(x - x_sum / n, y - y_sum / n);
            if (off >= nearest) continue;
            nearest = off;
            m->x0 = (x + 0.5) * CELL;
            m->y0 = (y + 0.5) * CELL;
        }
    return n;
}

/* In the photos that show most of the piece. */
static void mark_piece(struct made_marks *marks, const struct made_room *r, const struct cells *cells, int piece)
{
    int before = ACROSS * DOWN + 1;
    while (marks->count < MADE_MARKS) {
        struct made_mark best = {.photo = -1};
        int most = 4;
        for (int k = 0; k < r->photo_count; k++) {
            struct made_mark m = {.photo = k};
            const int n = middle_cell(&m, &cells[k], SIGHT_PIECE + piece);
            if (n <= most || n >= before) continue;
            most = n;
            best = m;
        }
        if (best.photo < 0) return;
        before = most;
        marks->list[marks->count++] = best;
    }
}

static bool all_marked(const struct made_room *r)
{
    int pictures = 0;
    for (int i = 0; i < r->wall_count; i++)
        if (r->wall_marks[i].photo < 0) return false;
    for (int i = 0; i < r->opening_count; i++)
        if (r->opening_marks[i].photo < 0) return false;
    for (int i = 0; i < r->picture_count; i++) pictures += r->picture_marks[i].count > 1;
    return pictures >= 2 && r->cleared_marks.count > 1 && r->moved_marks.count > 1;
}

bool made_marks(struct made_room *r)
{
    static struct cells cells[MADE_PHOTOS]; /* too large for the stack */
    struct sight s;
    sight_build(&s, r);
    for (int k = 0; k < r->photo_count; k++) show(&cells[k], r, &s, &r->photos[k]);
    mark_walls(r, cells);
    for (int i = 0; i < r->opening_count; i++) mark_opening(r, &s, i);
    for (int i = 0; i < r->lamp_count; i++) {
        mark_lamp(r, &s, i);
        mark_lit(r, &s, i);
    }
    for (int i = 0; i < r->picture_count; i++) mark_picture(r, &s, i);
    mark_piece(&r->cleared_marks, r, cells, r->cleared);
    mark_piece(&r->moved_marks, r, cells, r->moved);
    return all_marked(r);
}
