/* script_text.c - what a person writes of a made room: the model script, its edits, the scale, furniture and lamps.
 *
 * Pixels are those of photos of the size that scene.cfg sets, half of that in cameras.txt (MADE_SCALE) or smaller.
 * The model has the axes of the scene (photos.c), so a move has the same DX and DY in both. */
#include "tests/bench/room/made_room.h"

static void write_mark(FILE *to, const struct made_mark *m)
{
    fprintf(to, " in v%02d %.2f %.2f %.2f %.2f", m->photo, m->x0, m->y0, m->x1, m->y1);
}

/* Walls in order around, clockwise from above. */
static void write_around(const struct made_room *r, FILE *to, int count)
{
    for (int i = count - 1; i >= 0; i--) fprintf(to, " %s", r->walls[i].name);
}

static void write_rooms(const struct made_room *r, FILE *to)
{
    const bool two = r->shape == SHAPE_TWO_ROOMS;
    const int around = two ? r->wall_count - 1 : r->wall_count;
    fputs("\njoin", to);
    write_around(r, to, around);
    fprintf(to, " %s\n", r->walls[around - 1].name);
    if (!two) {
        fputs("room room1", to);
        write_around(r, to, around);
        fputs("\n", to);
        return;
    }
    fputs("extend partition start to west\nextend partition end to east\n", to);
    fputs("room room1 south west partition east\nroom room2 partition west north east\n", to);
}

void made_write_model(const struct made_room *r, FILE *to)
{
    fprintf(to, "remodel-script 1\n# The shell of the room, by marks in its photos.\nset thickness %.2f\n\n",
            r->walls[0].thickness);
    if (r->scale < MADE_SCALE) /* blank ceilings are not found in few small photos; people measure them then */
        fprintf(to, "set ceiling %.2f\n\n", r->ceiling);
    for (int i = 0; i < r->wall_count; i++) {
        const struct made_line *line = &r->wall_lines[i];
        fprintf(to, line->is ? "wall %s %s" : "wall %s", r->walls[i].name, line->top ? "top" : "foot");
        write_mark(to, line->is ? &line->mark : &r->wall_marks[i]);
        if (r->walls[i].thickness < r->walls[0].thickness) fprintf(to, " thickness %.2f", r->walls[i].thickness);
        fputs("\n", to);
    }
    write_rooms(r, to);
    fputs("\n", to);
    for (int i = 0; i < r->opening_count; i++) {
        const struct made_opening *o = &r->openings[i];
        fprintf(to, "%s %s on %s", o->window ? "window" : "passage", o->name, r->walls[o->wall].name);
        write_mark(to, &r->opening_marks[i]);
        fputs("\n", to);
    }
}

static struct vec3 picture_corner(const struct made_room *r, int i)
{
    const struct made_picture *p = &r->pictures[i];
    const struct made_wall *w = &r->walls[p->wall];
    struct vec3 corner = made_wall_place(w, p->s, w->thickness / 2 + 0.004);
    corner.z = p->z + p->high;
    return corner;
}

/* Lengths from the first picture that two photos show to each of the others. */
void made_write_scale(const struct made_room *r, FILE *to)
{
    int first = -1;
    fputs("# the upper left corners of pictures\n", to);
    for (int i = 0; i < r->picture_count; i++) {
        const struct made_marks *m = &r->picture_marks[i];
        for (int k = 0; m->count > 1 && k < m->count; k++)
            fprintf(to, "mark picture%d v%02d %.2f %.2f\n", i + 1, m->list[k].photo, m->list[k].x0, m->list[k].y0);
    }
    for (int i = 0; i < r->picture_count; i++) {
        if (r->picture_marks[i].count < 2) continue;
        if (first < 0)
            first = i;
        else
            fprintf(to, "length picture%d picture%d %.4f\n", first + 1, i + 1,
                    vec3_length(vec3_sub(picture_corner(r, first), picture_corner(r, i))));
    }
}

static void write_thing(const struct made_piece *p, const struct made_marks *marks, FILE *to)
{
    fprintf(to, "thing %s", p->name);
    for (int k = 0; k < marks->count; k++)
        fprintf(to, " in v%02d %.2f %.2f", marks->list[k].photo, marks->list[k].x0, marks->list[k].y0);
    fputs("\n", to);
}

void made_write_things(const struct made_room *r, FILE *to)
{
    fputs("remodel-marked-things 1\n", to);
    write_thing(&r->pieces[r->cleared], &r->cleared_marks, to);
    write_thing(&r->pieces[r->moved], &r->moved_marks, to);
}

void made_write_lights(const struct made_room *r, FILE *to)
{
    fputs("remodel-lamps 1\n", to);
    for (int i = 0; i < r->lamp_count; i++) {
        const struct made_mark *m = r->lamp_marks[i];
        if (m[0].photo < 0) continue;
        fprintf(to, "area lamp%d in v%02d %.2f %.2f %.2f %.2f %.2f %.2f %.2f %.2f\n", i + 1, m[0].photo, m[0].x0,
                m[0].y0, m[0].x1, m[0].y1, m[1].x0, m[1].y0, m[1].x1, m[1].y1);
        for (int k = 0; k < r->lit[i].count; k++) {
            fprintf(to, "lit lamp%d", i + 1);
            write_mark(to, &r->lit[i].list[k]);
            fprintf(to, " of %s\n", made_look_name(r->walls[r->lit[i].walls[k]].look));
        }
    }
}

void made_write_edit_bare(const struct made_room *r, FILE *to)
{
    (void)r;
    fputs("remodel-script 1\n# all furniture goes\nclear all\n", to);
}

void made_write_edit_moved(const struct made_room *r, FILE *to)
{
    const struct made_piece *before = &r->pieces[r->moved], *after = &r->after;
    fprintf(to, "remodel-script 1\nclear %s\nmove %s by %.2f %.2f", r->pieces[r->cleared].name, before->name,
            after->x - before->x, after->y - before->y);
    fprintf(to, r->turned ? " turn %g\n" : "\n", r->turned);
}

/* For a viewer in the room the left end of a window is at its larger s. */
void made_write_edit_window(const struct made_room *r, FILE *to)
{
    const struct made_opening *before = &r->openings[r->widened], *after = &r->larger;
    fprintf(to, "remodel-script 1\nresize %s left %.2f right %.2f bottom %.2f\n", before->name, after->s1 - before->s1,
            before->s0 - after->s0, before->z0 - after->z0);
}
