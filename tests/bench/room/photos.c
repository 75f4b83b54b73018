/* photos.c - where the photographer of a made room stands, and where he looks.
 *
 * Random rays from the free floor sample the visible surfaces. A candidate is a place at eye level on the free floor
 * and a direction with an open view. Photos are chosen greedily: a surface point that n photos show already adds
 * 1 / (1 + n)^2, so that all points are soon seen from several places. With two rooms, four photos around the doorway
 * come first, because they connect the rooms. Structure from motion must place every photo, so an attempt whose photos
 * do not overlap is given up.
 *
 * The model's x axis is the wall direction nearest to the right-hand direction of the most central camera
 * (docs/formats/models.md); the mean viewing direction decides between the views of one photo. So that the model has
 * the axes of the scene, the photos nearest to the middle look north, and so does the mean of all. */
#include <stdlib.h>
#include <string.h>

#include "tests/bench/room/sight.h"

enum { POINTS = 700, CANDIDATES = 320, CENTRAL = 3 };
#define CLEAR    0.35 /* between a camera and walls and furniture */
#define APART    0.45 /* between two cameras */
#define OPEN     2.0  /* least free view ahead */
#define NEAREST  0.6  /* what a photo shows: distances, m */
#define FARTHEST 6.0
#define REACH    2.0 /* between two photos that overlap, which show so much of the same: */
#define SHARED   0.2
#define SLANT    0.2 /* least cosine between the view and a surface's normal */

struct point {
    struct vec3 at, normal;
    int seen;
};

struct choice {
    struct made_room *room;
    struct sight sight;
    struct point points[POINTS];
    struct made_photo candidates[CANDIDATES];
    unsigned char sees[CANDIDATES][POINTS];
    double apart;       /* between two cameras */
    bool turns;         /* unless they look elsewhere */
    double north, east; /* sum of directions so far */
};

/* A place on the free floor. */
static bool is_free(const struct made_room *r, double x, double y)
{
    bool doorway = false;
    for (int i = 0; i < r->opening_count; i++) {
        const struct made_opening *o = &r->openings[i];
        const struct made_wall *w = &r->walls[o->wall];
        const struct vec3 a = made_wall_place(w, o->s0, 0), b = made_wall_place(w, o->s1, 0);
        doorway = doorway || (!o->window && x > fmin(a.x, b.x) + CLEAR && x < fmax(a.x, b.x) - CLEAR &&
                              fabs(y - a.y) < w->thickness / 2 + CLEAR);
    }
    if (made_area_of(r, x, y, CLEAR) < 0 && !doorway) return false;
    for (int i = 0; i < r->piece_count; i++)
        if (made_piece_near(&r->pieces[i], x, y, CLEAR - 0.05)) return false;
    return !made_piece_near(&r->after, x, y, CLEAR - 0.05);
}

static bool draw_place(struct vec3 *at, const struct made_room *r, struct dice *d)
{
    for (int i = 0; i < 1000; i++) {
        const struct rect a = r->areas[dice_choose(d, r->area_count)];
        *at = vec3_make(dice_length(d, a.x0, a.x1), dice_length(d, a.y0, a.y1), dice_length(d, 1.42, 1.6));
        if (is_free(r, at->x, at->y)) return true;
    }
    return false;
}

static void draw_points(struct choice *c, struct dice *d)
{
    for (int i = 0; i < POINTS; i++) {
        struct vec3 at;
        if (!draw_place(&at, c->room, d)) return;
        at.z = dice_between(d, 0.6, 2);
        const double z = dice_between(d, -1, 1), turn = dice_between(d, -M_PI, M_PI), flat = sqrt(1 - z * z);
        const struct vec3 way = vec3_make(flat * cos(turn), flat * sin(turn), z);
        const struct sight_hit hit = sight_cast(&c->sight, at, way);
        if (hit.owner == SIGHT_NOTHING) continue;
        c->points[i].at = vec3_add(at, vec3_scale(way, hit.distance));
        c->points[i].normal = hit.normal;
    }
}

/* A photo from a place in a direction, a little downwards; false: the view ends soon. */
static bool take(struct made_photo *photo, const struct choice *c, struct vec3 at, double azimuth)
{
    const struct vec3 way = vec3_make(cos(azimuth), sin(azimuth), 0);
    const double end = sight_cast(&c->sight, at, way).distance;
    struct vec3 look_at = vec3_add(at, vec3_scale(way, 3));
    look_at.x = round(100 * look_at.x) / 100;
    look_at.y = round(100 * look_at.y) / 100;
    look_at.z = 1.15;
    *photo = photo_looking(at, look_at);
    return end > OPEN;
}

static void look(unsigned char sees[POINTS], const struct choice *c, const struct made_photo *photo)
{
    for (int i = 0; i < POINTS; i++) {
        const struct point *p = &c->points[i];
        const struct vec3 back = vec3_sub(photo->at, p->at);
        const double distance = vec3_length(back);
        double u, v;
        sees[i] = distance > NEAREST && distance < FARTHEST && vec3_dot(back, p->normal) > SLANT * distance &&
                  photo_project(photo, p->at, 5, &u, &v) && sight_clear(&c->sight, photo->at, p->at);
    }
}

static bool draw_candidates(struct choice *c, struct dice *d)
{
    for (int i = 0; i < CANDIDATES; i++) {
        struct vec3 at;
        int tries = 0;
        do
            if (++tries > 200 || !draw_place(&at, c->room, d)) return false;
        while (!take(&c->candidates[i], c, at, dice_between(d, -M_PI, M_PI)));
        look(c->sees[i], c, &c->candidates[i]);
    }
    return true;
}

static void add_photo(struct choice *c, const struct made_photo *photo, const unsigned char sees[POINTS])
{
    struct made_room *r = c->room;
    r->photos[r->photo_count++] = *photo;
    c->east += photo->cam_from_world.m[2][0];
    c->north += photo->cam_from_world.m[2][1];
    for (int i = 0; i < POINTS; i++) c->points[i].seen += sees[i];
}

/* How much a candidate adds; those that keep the sum of directions in the north count more. */
static double gain_of(const struct choice *c, int k)
{
    const struct made_photo *photo = &c->candidates[k];
    const double *forward = photo->cam_from_world.m[2];
    double sum = 0;
    for (int i = 0; i < c->room->photo_count; i++) {
        const struct made_photo *other = &c->room->photos[i];
        const bool same_way = vec3_dot(mat3_row(other->cam_from_world, 2), mat3_row(photo->cam_from_world, 2)) > 0.5;
        if ((same_way || !c->turns) && vec3_length(vec3_sub(other->at, photo->at)) < c->apart) return 0;
    }
    for (int i = 0; i < POINTS; i++)
        if (c->sees[k][i]) sum += 1.0 / ((1 + c->points[i].seen) * (1 + c->points[i].seen));
    return sum * (1 + 0.25 * forward[1] - 0.1 * forward[0] * (c->east > 0 ? 1 : -1));
}

static bool choose_photos(struct choice *c, int wanted)
{
    while (c->room->photo_count < wanted) {
        int best = -1;
        double most = 0;
        for (int k = 0; k < CANDIDATES; k++) {
            const double gain = gain_of(c, k);
            if (gain <= most) continue;
            most = gain;
            best = k;
        }
        if (best < 0) return false;
        add_photo(c, &c->candidates[best], c->sees[best]);
    }
    return true;
}

/* Before, in and behind the doorway; all look through it or away from it along y. */
static bool add_doorway_photos(struct choice *c)
{
    const struct made_opening *o = &c->room->openings[0];
    const struct made_wall *w = &c->room->walls[o->wall];
    const struct vec3 middle = made_wall_place(w, (o->s0 + o->s1) / 2, 0);
    static const double before[4] = {-1.5, -0.5, 0.1, 1.5};
    for (int i = 0; i < 4; i++) {
        struct made_photo photo;
        unsigned char sees[POINTS];
        struct vec3 at = vec3_add(middle, vec3_make(0, before[i], 1.5));
        at.y = round(100 * at.y) / 100;
        if (!is_free(c->room, at.x, at.y) || !take(&photo, c, at, i < 3 ? M_PI / 2 : -M_PI / 2)) return false;
        look(sees, c, &photo);
        add_photo(c, &photo, sees);
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------------ their order */

static struct vec3 centroid_of(const struct made_room *r)
{
    struct vec3 sum = {0, 0, 0};
    for (int i = 0; i < r->photo_count; i++) sum = vec3_add(sum, r->photos[i].at);
    return vec3_scale(sum, 1.0 / r->photo_count);
}

static void swap_photos(struct made_room *r, int a, int b)
{
    const struct made_photo photo = r->photos[a];
    r->photos[a] = r->photos[b];
    r->photos[b] = photo;
}

/* Swaps the photo nearest to a place to index k, of those from k on. */
static void bring_nearest(struct made_room *r, int k, struct vec3 to)
{
    int best = k;
    for (int i = k + 1; i < r->photo_count; i++)
        if (vec3_length(vec3_sub(r->photos[i].at, to)) < vec3_length(vec3_sub(r->photos[best].at, to))) best = i;
    swap_photos(r, k, best);
}

/* The central photos look north, as far as walls let them. */
static bool face_north(struct choice *c)
{
    struct made_room *r = c->room;
    const struct vec3 middle = centroid_of(r);
    for (int k = 0; k < CENTRAL; k++) {
        bring_nearest(r, k, middle);
        const struct made_photo *photo = &r->photos[k];
        if (photo->cam_from_world.m[2][1] > 0.85) continue;
        if (photo->cam_from_world.m[2][1] < -0.85 && r->shape == SHAPE_TWO_ROOMS) return false;
        const struct vec3 at = photo->at;
        for (int i = 0; i < 9; i++) /* 0, -0.1, 0.1, -0.2, ... */
            if (take(&r->photos[k], c, at, M_PI / 2 + 0.1 * ((i + 1) / 2) * (i % 2 ? -1 : 1))) break;
        if (sight_cast(&c->sight, photo->at, vec3_make(0, 1, 0)).distance < OPEN / 2) return false;
    }
    return true;
}

/* A walk: from the photo nearest to the origin always to the nearest. */
static void order_photos(struct made_room *r)
{
    bring_nearest(r, 0, vec3_make(0, 0, 1.5));
    for (int k = 1; k < r->photo_count; k++) bring_nearest(r, k, r->photos[k - 1].at);
}

static bool look_north(const struct made_room *r)
{
    double east = 0, north = 0;
    for (int i = 0; i < r->photo_count; i++) {
        east += r->photos[i].cam_from_world.m[2][0];
        north += r->photos[i].cam_from_world.m[2][1];
    }
    return north > fabs(east) + 2.5;
}

/* Whether no photo looks out of a window, or at a wall, from near it. */
static bool look_inside(const struct made_room *r)
{
    for (int i = 0; i < r->photo_count; i++) {
        const struct vec3 ahead = vec3_add(r->photos[i].at, mat3_row(r->photos[i].cam_from_world, 2));
        if (made_area_of(r, ahead.x, ahead.y, 0) < 0) return false;
    }
    return true;
}

/* Whether two photos show enough of the same from places near enough that their features match. */
static bool overlap(const struct choice *c, int a, int b, unsigned char sees[MADE_PHOTOS][POINTS])
{
    int both = 0, of_a = 0, of_b = 0;
    if (vec3_length(vec3_sub(c->room->photos[a].at, c->room->photos[b].at)) > REACH) return false;
    for (int i = 0; i < POINTS; i++) {
        both += sees[a][i] && sees[b][i];
        of_a += sees[a][i];
        of_b += sees[b][i];
    }
    return both >= SHARED * (of_a < of_b ? of_a : of_b);
}

/* Whether each photo overlaps at least two others, and steps between overlapping photos lead from the first to all. */
static bool are_connected(const struct choice *c)
{
    static unsigned char sees[MADE_PHOTOS][POINTS]; /* too large for the stack */
    const int count = c->room->photo_count;
    int reached[MADE_PHOTOS] = {0}, reached_count = 1, neighbours[MADE_PHOTOS] = {0};
    bool known[MADE_PHOTOS] = {true};
    for (int k = 0; k < count; k++) look(sees[k], c, &c->room->photos[k]);
    for (int i = 0; i < reached_count; i++)
        for (int k = 0; k < count; k++) {
            if (k == reached[i] || !overlap(c, reached[i], k, sees)) continue;
            neighbours[reached[i]]++;
            if (known[k]) continue;
            known[k] = true;
            reached[reached_count++] = k;
        }
    for (int k = 0; k < count; k++)
        if (neighbours[k] < 2) return false;
    return reached_count == count;
}

static void begin(struct choice *c, struct made_room *r, double apart, struct dice *d)
{
    memset(c, 0, sizeof *c);
    c->room = r;
    c->apart = apart;
    sight_build(&c->sight, r);
    draw_points(c, d);
}

int made_photos_of_area(struct made_room *r, int wanted, double apart)
{
    static struct choice c; /* too large for the stack */
    struct dice d = dice_make(r->seed, "photos", 0);
    begin(&c, r, apart, &d);
    c.turns = true;
    if (draw_candidates(&c, &d)) choose_photos(&c, wanted < MADE_PHOTOS ? wanted : MADE_PHOTOS);
    return r->photo_count;
}

bool made_photos(struct made_room *r, int attempt)
{
    static struct choice c; /* too large for the stack */
    struct dice d = dice_make(r->seed, "photos", attempt);
    const int wanted = (r->shape == SHAPE_RECTANGLE ? 20 : 23) + dice_choose(&d, 4);
    begin(&c, r, APART, &d);
    if (r->shape == SHAPE_TWO_ROOMS && !add_doorway_photos(&c)) return false;
    if (!draw_candidates(&c, &d) || !choose_photos(&c, wanted) || !face_north(&c)) return false;
    order_photos(r);
    return look_north(r) && look_inside(r) && are_connected(&c);
}
