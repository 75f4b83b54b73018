/* house_text.c - the description of a house (docs/scenes.md), its cameras, and its plan. */
#include "tests/bench/house/house.h"

#define BAY_WALL 0.20
#define LEAF     0.04 /* thickness of a door's leaf */

/* A place of a wall of the house: `along` it, `beside` it. */
static void print_place(const struct house_wall *w, double along, double beside, FILE *to)
{
    if (w->upright)
        fprintf(to, " %.3f %.3f", w->at + beside, along);
    else
        fprintf(to, " %.3f %.3f", along, w->at + beside);
}

static void write_walls(const struct house *h, FILE *to)
{
    for (int i = 0; i < h->wall_count; i++) {
        const struct house_wall *w = &h->walls[i];
        struct dice d = dice_make(64 * h->seed + i, "wall", 0);
        int room = 0;
        for (int k = 0; k < h->room_count; k++) { /* the first room along it decides how it looks */
            const struct rect c = h->cells[k];
            const double low = w->upright ? c.x0 : c.y0, high = w->upright ? c.x1 : c.y1;
            const double from = w->upright ? c.y0 : c.x0, end = w->upright ? c.y1 : c.x1;
            room = k;
            if ((fabs(low - w->at) < 1e-6 || fabs(high - w->at) < 1e-6) && from > w->from - 1e-6 && end < w->to + 1e-6)
                break;
        }
        fprintf(to, "wall w%d", i + 1);
        print_place(w, w->from, 0, to);
        fputs(" ", to);
        print_place(w, w->to, 0, to);
        fprintf(to, "  0 %.2f %.2f r%d-%s\n", h->ceiling, w->thickness, room + 1,
                made_look_name(dice_chance(&d, 0.2)   ? LOOK_ACCENT
                               : dice_chance(&d, 0.4) ? LOOK_WALL2
                                                      : LOOK_WALL));
    }
}

/* The leaf of a door, which turns about one end of the opening. */
static void write_leaf(const struct house *h, int i, FILE *to)
{
    const struct house_door *o = &h->doors[i];
    const struct house_wall *w = &h->walls[o->wall];
    struct dice d = dice_make(64 * h->seed + i, "leaf", 0);
    const double turn =
        o->kind == DOOR_CLOSED ? 0 : round(o->kind == DOOR_AJAR ? dice_between(&d, 25, 60) : dice_between(&d, 80, 95));
    const double way = dice_chance(&d, 0.5) ? 1 : -1, base = w->upright ? 90 : 0, wide = o->to - o->from - 0.01;
    const double a = (base + way * turn) * M_PI / 180, half = wide / 2;
    const double x = (w->upright ? w->at : o->from + 0.005) + half * cos(a);
    const double y = (w->upright ? o->from + 0.005 : w->at) + half * sin(a);
    if (o->kind == DOOR_WIDE) return;
    fprintf(to, "box door%d-leaf %.4f %.4f 0.01  %.4f %.4f %.2f  r%d-%s turn %g\n", i + 1, x - half, y - LEAF / 2,
            x + half, y + LEAF / 2, o->high - 0.01, o->rooms[0] + 1, made_look_name(LOOK_WOOD), base + way * turn);
}

static void write_bay(const struct house *h, int i, FILE *to)
{
    const struct house_bay *b = &h->bays[i];
    const struct house_wall *w = &h->walls[b->wall];
    const double out = b->out * (w->thickness / 2 + b->depth), near = b->out * w->thickness / 4, in = 0.7 * b->depth;
    const double places[4][2] = {{b->from, near}, {b->from + in, out}, {b->to - in, out}, {b->to, near}};
    fprintf(to, "opening bay%d w%d %.2f %.2f  0 %.2f\n", i + 1, b->wall + 1, b->from - w->from, b->to - w->from,
            h->ceiling - 0.2);
    const double far = out + b->out * BAY_WALL, low = fmin(0, far), high = fmax(0, far);
    fprintf(to, "room bay%d-floor", i + 1);
    print_place(w, b->from - BAY_WALL, low, to);
    print_place(w, b->to + BAY_WALL, high, to);
    fprintf(to, "  0 %.2f  r%d-%s r%d-%s\n", h->ceiling, b->room + 1, made_look_name(LOOK_FLOOR), b->room + 1,
            made_look_name(LOOK_CEILING));
    for (int k = 0; k < 3; k++) {
        const double length = hypot(places[k + 1][0] - places[k][0], places[k + 1][1] - places[k][1]);
        fprintf(to, "wall bay%d-%d", i + 1, k + 1);
        print_place(w, places[k][0], places[k][1], to);
        print_place(w, places[k + 1][0], places[k + 1][1], to);
        fprintf(to, "  0 %.2f %.2f r%d-%s\n", h->ceiling, BAY_WALL, b->room + 1, made_look_name(LOOK_WALL));
        if (length > 0.9)
            fprintf(to, "window bay%d-window%d bay%d-%d 0.25 %.2f  0.80 %.2f\n", i + 1, k + 1, i + 1, k + 1,
                    length - 0.25, h->ceiling - 0.3);
    }
}

static void write_slope(const struct house *h, int i, FILE *to)
{
    const struct house_slope *s = &h->slopes[i];
    const struct rect a = h->rooms[s->room].areas[0];
    const double wide = a.x1 - a.x0, deep = a.y1 - a.y0, up = h->ceiling - s->knee;
    const bool along_x = s->side == SIDE_SOUTH || s->side == SIDE_NORTH;
    const double inwards = s->side == SIDE_SOUTH || s->side == SIDE_WEST ? s->deep : -s->deep;
    fprintf(to, "quad slope%d %.3f %.3f %.3f  %.3f %.3f 0  %.3f %.3f %.3f  r%d-%s\n", i + 1,
            s->side == SIDE_EAST ? a.x1 : a.x0, s->side == SIDE_NORTH ? a.y1 : a.y0, s->knee, along_x ? wide : 0,
            along_x ? 0 : deep, along_x ? 0 : inwards, along_x ? inwards : 0, up, s->room + 1,
            made_look_name(LOOK_CEILING));
}

/* The sun shines through the first window. */
static void write_sun(const struct house *h, FILE *to)
{
    const struct house_wall *w = &h->walls[h->windows[0].wall];
    struct dice d = dice_make(h->seed, "sun", 0);
    const double out = w->at < 1e-6 ? -1 : 1, azimuth = w->upright ? (out > 0 ? 0 : 180) : 90 * out;
    made_write_sky(h->seed, round(azimuth + dice_between(&d, -45, 45)), round(dice_between(&d, 25, 45)), to);
}

void house_write_scene(const struct house *h, FILE *to)
{
    fprintf(to, "remodel-scene 2\n# Drawn by made_house from the seed %d: %d rooms.\n\n", h->seed, h->room_count);
    for (int i = 0; i < h->room_count; i++) made_write_materials(&h->rooms[i], to);
    fputs("\n# the shell\n", to);
    for (int i = 0; i < h->room_count; i++) {
        const struct rect c = h->cells[i];
        fprintf(to, "room room%d %.2f %.2f %.2f %.2f  0 %.2f  r%d-%s r%d-%s\n", i + 1, c.x0, c.y0, c.x1, c.y1,
                h->ceiling, i + 1, made_look_name(LOOK_FLOOR), i + 1, made_look_name(LOOK_CEILING));
    }
    write_walls(h, to);
    for (int i = 0; i < h->door_count; i++) {
        const struct house_door *o = &h->doors[i];
        const double from = h->walls[o->wall].from;
        fprintf(to, "opening door%d w%d %.2f %.2f  0 %.2f\n", i + 1, o->wall + 1, o->from - from, o->to - from,
                o->high);
    }
    for (int i = 0; i < h->window_count; i++) {
        const struct house_window *o = &h->windows[i];
        const double from = h->walls[o->wall].from;
        fprintf(to, "window window%d w%d %.2f %.2f  %.2f %.2f\n", i + 1, o->wall + 1, o->from - from, o->to - from,
                o->z0, o->z1);
    }
    for (int i = 0; i < h->door_count; i++) write_leaf(h, i, to);
    for (int i = 0; i < h->bay_count; i++) write_bay(h, i, to);
    for (int i = 0; i < h->slope_count; i++) write_slope(h, i, to);
    fputs("\n# furniture, by pieces\nfurniture on\n", to);
    for (int i = 0; i < h->room_count; i++) made_write_pieces(&h->rooms[i], to);
    fputs("furniture off\n\n# rugs, pictures and light\n", to);
    for (int i = 0; i < h->room_count; i++) {
        made_write_pictures(&h->rooms[i], to);
        made_write_lamps(&h->rooms[i], to);
    }
    write_sun(h, to);
}

/* The lens of made rooms, at another size; exposures a factor of four apart. */
void house_write_cameras(const struct house *h, const struct house_camera *camera, FILE *to)
{
    static const double seconds[3] = {0.016666666667, 0.004166666667, 0.066666666667};
    fputs("remodel-shoot 1\n# A 16 mm equisolid fisheye on a 36 mm wide sensor.\n", to);
    fprintf(to, "lens fisheye equisolid %d %d %.9f %g %g\n", camera->width, camera->height,
            MADE_FOCAL / MADE_WIDTH * camera->width, camera->width / 2.0, camera->height / 2.0);
    for (int i = 0; i < camera->exposures; i++)
        fprintf(to, "exposure %.12f\n", camera->exposures == 1 ? seconds[0] : seconds[i == 0 ? 1 : i == 1 ? 0 : 2]);
    fprintf(to, "sensor 30000 6 60 %d\nquality 94\n\n", h->seed);
    for (int k = 0, n = 0; k < h->room_count; k++)
        for (int i = 0; i < h->rooms[k].photo_count; i++) {
            const struct made_photo *p = &h->rooms[k].photos[i];
            fprintf(to, "photo v%03d fisheye %.2f %.2f %.2f  %.2f %.2f %.2f\n", n++, p->at.x, p->at.y, p->at.z,
                    p->look_at.x, p->look_at.y, p->look_at.z);
        }
}

void house_write_plan(const struct house *h, FILE *to)
{
    static const char *const kinds[DOOR_KINDS] = {"wide", "open", "ajar", "closed"};
    fprintf(to, "# metres; walls by centre lines, openings by their places along them\nceiling %.2f\n", h->ceiling);
    for (int i = 0; i < h->room_count; i++)
        fprintf(to, "room %.3f %.3f %.3f %.3f%s\n", h->rooms[i].areas[0].x0, h->rooms[i].areas[0].y0,
                h->rooms[i].areas[0].x1, h->rooms[i].areas[0].y1, h->corridor[i] ? " corridor" : "");
    for (int i = 0; i < h->wall_count; i++) {
        fputs("wall", to);
        print_place(&h->walls[i], h->walls[i].from, 0, to);
        print_place(&h->walls[i], h->walls[i].to, 0, to);
        fprintf(to, " %.2f\n", h->walls[i].thickness);
    }
    for (int i = 0; i < h->door_count; i++) {
        fputs("door", to);
        print_place(&h->walls[h->doors[i].wall], h->doors[i].from, 0, to);
        print_place(&h->walls[h->doors[i].wall], h->doors[i].to, 0, to);
        fprintf(to, " 0 %.2f %s\n", h->doors[i].high, kinds[h->doors[i].kind]);
    }
    for (int i = 0; i < h->bay_count; i++) {
        fputs("bay", to);
        print_place(&h->walls[h->bays[i].wall], h->bays[i].from, 0, to);
        print_place(&h->walls[h->bays[i].wall], h->bays[i].to, 0, to);
        fprintf(to, " 0 %.2f %.2f\n", h->ceiling - 0.2, h->bays[i].depth);
    }
    for (int i = 0; i < h->window_count; i++) {
        fputs("window", to);
        print_place(&h->walls[h->windows[i].wall], h->windows[i].from, 0, to);
        print_place(&h->walls[h->windows[i].wall], h->windows[i].to, 0, to);
        fprintf(to, " %.2f %.2f\n", h->windows[i].z0, h->windows[i].z1);
    }
}
