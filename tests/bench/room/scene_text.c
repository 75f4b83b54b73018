/* scene_text.c - the description of a made room (docs/scenes.md): the place, its edits, and the cameras.
 *
 * Colours and scales of textures are drawn here, since nothing else depends on them. */
#include <string.h>

#include "tests/bench/room/made_room.h"

static const char *const look_names[LOOK_COUNT] = {"floor",  "floor2", "overhead", "wall",  "wall2",
                                                   "accent", "wood",   "wood2",    "cloth", "cloth2",
                                                   "linen",  "dark",   "clay",     "books", "pattern"};

const char *made_look_name(enum made_look look) { return look_names[look]; }

#define FLAT 0.004 /* of pictures and rugs before their wall and floor */

/* -------------------------------------------------------------------------------------------------------- materials */

struct colour {
    double r, g, b;
};

/* A colour of some brightness; vivid: 0 grey, 1 as vivid as that brightness allows. */
static struct colour draw_colour(struct dice *d, double low, double high, double vivid)
{
    const double value = dice_between(d, low, high), hue = dice_between(d, 0, 2 * M_PI);
    const double share[3] = {cos(hue), cos(hue - 2 * M_PI / 3), cos(hue + 2 * M_PI / 3)};
    return (struct colour){value * (1 + 0.5 * vivid * share[0]), value * (1 + 0.5 * vivid * share[1]),
                           value * (1 + 0.5 * vivid * share[2])};
}

/* Browns, from pale oak to walnut. */
static struct colour draw_brown(struct dice *d, double low, double high)
{
    const double red = dice_between(d, low, high), green = dice_between(d, 0.62, 0.76);
    return (struct colour){red, red * green, red * green * dice_between(d, 0.5, 0.68)};
}

static struct colour darker(struct colour c, double by) { return (struct colour){c.r * by, c.g * by, c.b * by}; }

static void write_colour(FILE *to, struct colour c) { fprintf(to, "  %.3f %.3f %.3f", c.r, c.g, c.b); }

static void write_plaster(const struct made_room *r, FILE *to, enum made_look look, double scale, double amount,
                          struct colour c, struct dice *d)
{
    fprintf(to, "texture %s%s plaster %.2f %.2f %d", r->prefix, look_names[look], scale, amount,
            1 + dice_choose(d, 1000));
    write_colour(to, c);
    fputs("\n", to);
}

static void write_wood(const struct made_room *r, FILE *to, enum made_look look, double scale, struct colour c,
                       double dark, struct dice *d)
{
    fprintf(to, "texture %s%s wood %.2f %d", r->prefix, look_names[look], scale, 1 + dice_choose(d, 1000));
    write_colour(to, c);
    write_colour(to, darker(c, dark));
    fputs("\n", to);
}

static void write_brick(const struct made_room *r, FILE *to, enum made_look look, double wide, double high,
                        double mortar, struct colour c, struct dice *d)
{
    fprintf(to, "texture %s%s brick %.2f %.3f %.3f %d", r->prefix, look_names[look], wide, high, mortar,
            1 + dice_choose(d, 1000));
    write_colour(to, c);
    write_colour(to, draw_colour(d, 0.45, 0.6, 0.1));
    fputs("\n", to);
}

/* Boards, tiles with joints, or a mottled carpet; whether they are boards, which may be glossy. */
static bool write_floor(const struct made_room *r, FILE *to, enum made_look look, struct dice *d)
{
    const int what = dice_choose(d, 4);
    if (what < 2)
        write_wood(r, to, look, dice_between(d, 0.09, 0.17), draw_brown(d, 0.35, 0.6), dice_between(d, 0.45, 0.65), d);
    else if (what == 2)
        write_brick(r, to, look, 0.4, dice_between(d, 0.2, 0.4), 0.008, draw_colour(d, 0.25, 0.45, 0.25), d);
    else
        write_plaster(r, to, look, dice_between(d, 0.08, 0.2), 0.4, draw_colour(d, 0.2, 0.4, 0.5), d);
    return what < 2;
}

static void write_accent(const struct made_room *r, FILE *to, struct dice *d)
{
    if (dice_chance(d, 0.5))
        write_brick(r, to, LOOK_ACCENT, 0.24, 0.075, 0.012, draw_colour(d, 0.25, 0.5, 0.5), d);
    else
        write_plaster(r, to, LOOK_ACCENT, 0.3, dice_between(d, 0.2, 0.35), draw_colour(d, 0.25, 0.5, 0.6), d);
}

/* Whether the floor of the first room is of boards. */
static bool write_textures(const struct made_room *r, FILE *to, struct dice *d)
{
    const bool boards = write_floor(r, to, LOOK_FLOOR, d);
    write_floor(r, to, LOOK_FLOOR2, d);
    if (dice_chance(d, 0.4))
        write_wood(r, to, LOOK_CEILING, 0.14, draw_colour(d, 0.7, 0.78, 0.06), 0.88, d);
    else
        write_plaster(r, to, LOOK_CEILING, 0.35, 0.2, draw_colour(d, 0.7, 0.78, 0.04), d);
    write_plaster(r, to, LOOK_WALL, dice_between(d, 0.25, 0.35), r->blank ? 0.02 : 0.2, draw_colour(d, 0.6, 0.74, 0.12),
                  d);
    write_plaster(r, to, LOOK_WALL2, dice_between(d, 0.25, 0.35), 0.22, draw_colour(d, 0.5, 0.68, 0.3), d);
    write_accent(r, to, d);
    write_wood(r, to, LOOK_WOOD, dice_between(d, 0.08, 0.15), draw_brown(d, 0.45, 0.65), 0.6, d);
    write_wood(r, to, LOOK_WOOD2, dice_between(d, 0.08, 0.2), draw_brown(d, 0.15, 0.35), 0.5, d);
    write_plaster(r, to, LOOK_CLOTH, dice_between(d, 0.04, 0.08), 0.25, draw_colour(d, 0.2, 0.45, 0.8), d);
    write_plaster(r, to, LOOK_CLOTH2, dice_between(d, 0.04, 0.08), 0.25, draw_colour(d, 0.1, 0.35, 0.8), d);
    write_plaster(r, to, LOOK_LINEN, 0.06, 0.2, draw_colour(d, 0.5, 0.7, 0.2), d);
    write_plaster(r, to, LOOK_CLAY, 0.04, 0.2, draw_colour(d, 0.2, 0.5, 0.7), d);
    fprintf(to, "texture %sdark rgb 0.05 0.05 0.05\n", r->prefix);
    fprintf(to, "texture %sbooks books %d 1.50 0.34\n", r->prefix, 200 + r->seed);
    fprintf(to, "texture %spattern print %d 0.42 0.42\n", r->prefix, 300 + r->seed);
    for (int i = 0; i < r->picture_count; i++)
        fprintf(to, "texture %spicture%d print %d %.2f %.2f\n", r->prefix, i + 1, r->pictures[i].seed,
                r->pictures[i].wide, r->pictures[i].high);
    for (int i = 0; i < r->rug_count; i++)
        fprintf(to, "texture %srug%d print %d %.2f %.2f\n", r->prefix, i + 1, 400 + r->seed + i,
                r->rugs[i].x1 - r->rugs[i].x0, r->rugs[i].y1 - r->rugs[i].y0);
    return boards;
}

void made_write_materials(const struct made_room *r, FILE *to)
{
    struct dice d = dice_make(r->seed, "materials", 0);
    const bool boards = write_textures(r, to, &d);
    const bool glossy = dice_chance(&d, 0.5);
    fputs("\n", to);
    for (int i = 0; i < LOOK_COUNT; i++) {
        const bool gloss = glossy && ((i == LOOK_FLOOR && boards) || i == LOOK_WOOD2);
        fprintf(to, gloss ? "material %s%s ward %s%s 0.04 0.25\n" : "material %s%s lambert %s%s\n", r->prefix,
                look_names[i], r->prefix, look_names[i]);
    }
    for (int i = 0; i < r->picture_count; i++)
        fprintf(to, "material %spicture%d lambert %spicture%d\n", r->prefix, i + 1, r->prefix, i + 1);
    for (int i = 0; i < r->rug_count; i++)
        fprintf(to, "material %srug%d lambert %srug%d\n", r->prefix, i + 1, r->prefix, i + 1);
}

/* ------------------------------------------------------------------------------------------------------------ items */

static void write_shell(const struct made_room *r, FILE *to)
{
    const double split = r->shape == SHAPE_TWO_ROOMS ? r->divide : r->deep;
    fprintf(to, "room room1 0 0 %.2f %.2f  0 %.2f  floor overhead\n", r->wide, split, r->ceiling);
    if (r->shape == SHAPE_TWO_ROOMS)
        fprintf(to, "room room2 0 %.2f %.2f %.2f  0 %.2f  floor2 overhead\n", split, r->wide, r->deep, r->ceiling);
    for (int i = 0; i < r->wall_count; i++) {
        const struct made_wall *w = &r->walls[i];
        fprintf(to, "wall %s %.3f %.3f  %.3f %.3f  0 %.2f %.2f %s\n", w->name, w->x0, w->y0, w->x1, w->y1, r->ceiling,
                w->thickness, look_names[w->look]);
    }
    for (int i = 0; i < r->opening_count; i++) {
        const struct made_opening *o = &r->openings[i];
        fprintf(to, "%s %s %s %.2f %.2f  %.2f %.2f\n", o->window ? "window" : "opening", o->name,
                r->walls[o->wall].name, o->s0, o->s1, o->z0, o->z1);
    }
}

static void write_piece(const struct made_room *r, const struct made_piece *p, FILE *to)
{
    for (int k = 0; k < made_box_count(p); k++) {
        const struct made_box b = made_box_of(p, k);
        fprintf(to, "box %s%s-%s %.4f %.4f %.4f  %.4f %.4f %.4f  %s%s turn %g\n", r->prefix, p->name, b.name,
                b.middle.x - b.half.x, b.middle.y - b.half.y, b.middle.z - b.half.z, b.middle.x + b.half.x,
                b.middle.y + b.half.y, b.middle.z + b.half.z, r->prefix, look_names[b.look], fmod(b.turn, 360));
    }
}

void made_write_pieces(const struct made_room *r, FILE *to)
{
    for (int i = 0; i < r->piece_count; i++) write_piece(r, &r->pieces[i], to);
}

void made_write_pictures(const struct made_room *r, FILE *to)
{
    for (int i = 0; i < r->rug_count; i++)
        fprintf(to, "quad %srug%d %.2f %.2f %.3f  %.2f 0 0  0 %.2f 0  %srug%d\n", r->prefix, i + 1, r->rugs[i].x0,
                r->rugs[i].y0, FLAT, r->rugs[i].x1 - r->rugs[i].x0, r->rugs[i].y1 - r->rugs[i].y0, r->prefix, i + 1);
    for (int i = 0; i < r->picture_count; i++) {
        const struct made_picture *p = &r->pictures[i];
        const struct made_wall *w = &r->walls[p->wall];
        const struct vec3 left = made_wall_place(w, p->s, w->thickness / 2 + FLAT);
        const struct vec3 right = made_wall_place(w, p->s - p->wide, w->thickness / 2 + FLAT);
        fprintf(to, "quad %spicture%d %.4f %.4f %.2f  %.4f %.4f 0  0 0 %.2f  %spicture%d\n", r->prefix, i + 1, left.x,
                left.y, p->z, right.x - left.x, right.y - left.y, p->high, r->prefix, i + 1);
    }
}

void made_write_lamps(const struct made_room *r, FILE *to)
{
    for (int i = 0; i < r->lamp_count; i++) {
        const struct made_lamp *l = &r->lamps[i];
        fprintf(to, "lamp %slamp%d quad %.3f %.3f %.3f  0 %.2f 0  %.2f 0 0  %.1f %.1f %.1f\n", r->prefix, i + 1, l->x,
                l->y, r->ceiling - 0.012, l->side, l->side, l->radiance[0], l->radiance[1], l->radiance[2]);
    }
}

void made_write_sky(int seed, double azimuth, double elevation, FILE *to)
{
    struct dice d = dice_make(seed, "sky", 0);
    const double sun = dice_between(&d, 900, 1300), sky = dice_between(&d, 1.4, 2.2);
    fprintf(to, "sun %g %g 1.5  %.0f %.0f %.0f\n", azimuth, elevation, sun, 0.93 * sun, 0.8 * sun);
    fprintf(to, "panorama %d  %.2f %.2f %.2f  0.8 0.8 0.6\n", 1 + dice_choose(&d, 100), sky, 1.15 * sky, 1.35 * sky);
}

void made_write_scene(const struct made_room *r, FILE *to)
{
    static const char *const shapes[SHAPE_COUNT] = {"a rectangle", "an L", "two rooms"};
    fprintf(to, "remodel-scene 2\n# Drawn by made_room from the seed %d: %s.\n\n", r->seed, shapes[r->shape]);
    made_write_materials(r, to);
    fputs("\n# the shell\n", to);
    write_shell(r, to);
    fputs("\n# furniture, by pieces\nfurniture on\n", to);
    made_write_pieces(r, to);
    fputs("furniture off\n\n# rugs, pictures and light\n", to);
    made_write_pictures(r, to);
    made_write_lamps(r, to);
    made_write_sky(r->seed, r->sun_azimuth, r->sun_elevation, to);
}

/* ------------------------------------------------------------------------------------------------------------ edits */

static void write_drop(const struct made_piece *p, FILE *to)
{
    fputs("drop", to);
    for (int k = 0; k < made_box_count(p); k++) fprintf(to, " %s-%s", p->name, made_box_of(p, k).name);
    fputs("\n", to);
}

void made_write_bare(const struct made_room *r, FILE *to)
{
    fputs("remodel-scene 2\nbase scene.txt\n# All furniture is gone; pictures and rugs stay.\n", to);
    for (int i = 0; i < r->piece_count; i++) write_drop(&r->pieces[i], to);
}

void made_write_moved(const struct made_room *r, FILE *to)
{
    fprintf(to, "remodel-scene 2\nbase scene.txt\n# %s is gone, %s stands elsewhere.\n", r->pieces[r->cleared].name,
            r->after.name);
    write_drop(&r->pieces[r->cleared], to);
    write_drop(&r->after, to);
    fputs("furniture on\n", to);
    write_piece(r, &r->after, to);
}

/* Pictures that would hang in the larger window are gone. */
void made_write_window(const struct made_room *r, FILE *to)
{
    const struct made_opening *o = &r->larger;
    fprintf(to, "remodel-scene 2\nbase scene.txt\n# %s is larger on three sides.\ndrop %s", o->name, o->name);
    for (int i = 0; i < r->picture_count; i++) {
        const struct made_picture *p = &r->pictures[i];
        const bool beside = p->s <= o->s0 || p->s - p->wide >= o->s1 || p->z + p->high <= o->z0 || p->z >= o->z1;
        if (p->wall == o->wall && !beside) fprintf(to, " picture%d", i + 1);
    }
    fprintf(to, "\nwindow %s %s %.2f %.2f  %.2f %.2f\n", o->name, r->walls[o->wall].name, o->s0, o->s1, o->z0, o->z1);
}

/* The lens and the exposures of scenes/loft. */
void made_write_cameras(const struct made_room *r, FILE *to)
{
    fprintf(to,
            "remodel-shoot 1\n# A 16 mm equisolid fisheye on a 36 mm wide sensor; three exposures, a factor of four "
            "apart.\n");
    fprintf(to, "lens fisheye equisolid %.0f %.0f %.9f %.0f %.0f\n", MADE_WIDTH / MADE_SCALE, MADE_HEIGHT / MADE_SCALE,
            MADE_FOCAL / MADE_SCALE, MADE_WIDTH / MADE_SCALE / 2, MADE_HEIGHT / MADE_SCALE / 2);
    fputs("exposure 0.004166666667\nexposure 0.016666666667\nexposure 0.066666666667\n", to);
    fprintf(to, "sensor 30000 6 60 %d\nquality 94\n\n", r->seed);
    for (int i = 0; i < r->photo_count; i++) {
        const struct made_photo *p = &r->photos[i];
        fprintf(to, "photo v%02d fisheye %.2f %.2f %.2f  %.2f %.2f %.2f\n", i, p->at.x, p->at.y, p->at.z, p->look_at.x,
                p->look_at.y, p->look_at.z);
    }
}
