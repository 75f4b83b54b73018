/* suggest_script.c - a suggestion as a model script (docs/model-script.md).
 *
 * What may be wrong is written before each line as a comment, and what could not be decided as a comment alone, so that
 * build_model accepts the script as it is. The thickness of a wall between rooms is measured from face to face. The two
 * faces of a room's walls need no sides in the script: it lists walls, and build_model finds the sides. */
#include "stages/suggest_model/suggest_script.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double GLASS_THICKNESS = 0.008; /* as a fraction of the ceiling's height */
static const double MIN_PLACE = 1e-3;        /* of an opening */

void suggest_names_release(struct wall_names *n)
{
    free(n->names);
    n->names = NULL;
}

enum status suggest_names_make(struct wall_names *n, const struct suggestion *s, struct err *err)
{
    static const char *const SIDES[] = {"south", "west", "north", "east"};
    static const double NORMALS[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    int other = 0;
    n->names = calloc((size_t)s->wall_count + 1, sizeof *n->names);
    if (!n->names) return err_nomem(err, "names of walls", (size_t)s->wall_count * sizeof *n->names);
    for (int k = 0; k < 4; k++) {
        int best = -1;
        for (int i = 0; i < s->wall_count; i++) {
            const struct suggested_wall *w = &s->walls[i];
            if (w->between || w->angled || w->line.n[0] * NORMALS[k][0] + w->line.n[1] * NORMALS[k][1] < 0.9) continue;
            if (best < 0 || w->end - w->begin > s->walls[best].end - s->walls[best].begin) best = i;
        }
        if (best >= 0) strcpy(n->names[best], SIDES[k]);
    }
    for (int i = 0; i < s->wall_count; i++)
        if (!n->names[i][0]) snprintf(n->names[i], sizeof n->names[i], "wall%d", ++other);
    return ST_OK;
}

/* S of the script for S of the wall's line: x or y along an axis, else the distance from the first point. */
static double script_s(const struct suggested_wall *w, double s)
{
    double p[2];
    if (w->angled) return s - w->begin;
    line_point(&w->line, s, 0, p);
    return fabs(w->line.n[0]) > 0.5 ? p[1] : p[0];
}

static void print_wall(FILE *to, const struct suggestion *s, const struct wall_names *names, int wall)
{
    const struct suggested_wall *w = &s->walls[wall];
    double a[2], b[2];
    line_point(&w->line, w->begin, 0, a);
    line_point(&w->line, w->end, 0, b);
    fprintf(to, "# %s: confidence %.2f; %.0f %% of its length was seen%s\n", names->names[wall], w->confidence,
            100 * w->covered,
            w->guessed            ? ", from one side only: its thickness is a guess"
            : w->covered < 1e-6   ? ": it is implied by the walls beside it"
            : w->confidence < 0.5 ? "; check it"
                                  : "");
    fprintf(to, "wall %s from %.4f %.4f to %.4f %.4f", names->names[wall], a[0], a[1], b[0], b[1]);
    if (w->thickness > 0) fprintf(to, " thickness %.4f", w->thickness);
    fputs(w->angled ? " angled\n" : "\n", to);
    for (int i = 0; i < s->doubt_count; i++) {
        const struct suggested_doubt *d = &s->doubts[i];
        if (d->kind == DOUBT_STRETCH && d->wall == wall)
            fprintf(to, "# %s: nothing shows it from %.4f %.4f to %.4f %.4f\n", names->names[wall], d->a[0], d->a[1],
                    d->b[0], d->b[1]);
    }
}

static void print_joins(FILE *to, const struct suggestion *s, const struct wall_names *names)
{
    for (int i = 0; i < s->wall_count; i++)
        for (int e = 0; e < 2; e++) {
            const struct suggested_wall *w = &s->walls[i];
            const char *name = names->names[i], *end = e ? "end" : "start";
            if (w->joins[e] == JOIN_CORNER && i < w->others[e])
                fprintf(to, "join %s %s\n", name, names->names[w->others[e]]);
            if (w->joins[e] == JOIN_MEETS) fprintf(to, "extend %s %s to %s\n", name, end, names->names[w->others[e]]);
            if (w->joins[e] == JOIN_NONE && !w->between)
                fprintf(to, "# the %s of %s is joined to nothing: join %s ...\n", end, name, name);
        }
}

static void print_rooms(FILE *to, const struct suggestion *s, const struct wall_names *names)
{
    for (int r = 0; r < s->room_count; r++) {
        const struct suggested_room *room = &s->rooms[r];
        if (!room->closed)
            fprintf(to,
                    "# room%d, about %.4g square units around %.2f %.2f, is not closed: join its walls, and add those "
                    "that are missing\n# ",
                    r + 1, room->area, room->middle[0], room->middle[1]);
        fprintf(to, "room room%d", r + 1);
        for (int k = 0; k < room->count; k++) fprintf(to, " %s", names->names[s->room_walls[room->first + k]]);
        fputs(room->closed ? "\n" : " ...\n", to);
    }
}

static void print_openings(FILE *to, const struct suggestion *s, const struct wall_names *names)
{
    int doors = 0, windows = 0;
    for (int i = 0; i < s->opening_count; i++) {
        const struct suggested_opening *o = &s->openings[i];
        const struct suggested_wall *w = &s->walls[o->wall];
        const double a = script_s(w, o->begin), b = script_s(w, o->end);
        if (fabs(b - a) < MIN_PLACE * s->ceiling || o->top - o->foot < MIN_PLACE * s->ceiling) continue;
        if (o->doubtful) fputs("# bright and without depth: a window, or a patch of light\n# ", to);
        fprintf(to, "%s %s%d on %s from %.4f %.4f to %.4f %.4f\n", o->window ? "window" : "passage",
                o->window ? "window" : "doorway", o->window ? ++windows : ++doors, names->names[o->wall], fmin(a, b),
                o->foot, fmax(a, b), o->top);
    }
}

static void print_doubts(FILE *to, const struct suggestion *s)
{
    for (int i = 0; i < s->doubt_count; i++) {
        const struct suggested_doubt *d = &s->doubts[i];
        if (d->kind == DOUBT_BORDER) {
            fprintf(to, "# what was seen ends from %.4f %.4f to %.4f %.4f: ", d->a[0], d->a[1], d->b[0], d->b[1]);
            if (d->views_beyond)
                fprintf(to, "no wall is there, since %d views were taken from beyond\n", d->views_beyond);
            else
                fprintf(to, "a wall there was seen over %.0f %% of that\n", 100 * d->covered);
        }
        if (d->kind == DOUBT_FACE)
            fprintf(to, "# a face from %.4f %.4f to %.4f %.4f bounds no room: furniture, or a wall seen from afar\n",
                    d->a[0], d->a[1], d->b[0], d->b[1]);
    }
}

void suggest_script_print(FILE *to, const struct suggestion *s, const struct wall_names *names,
                          const struct model_axes *axes, const char *note)
{
    fputs("# A suggestion, made from points: compare it with the photographs and with suggested.svg, correct it, and\n"
          "# keep it as scenes/NAME/model.txt; nothing reads it here. Lengths are those of axes.txt. A confidence is\n"
          "# from 0 to 1.\n",
          to);
    if (note) fprintf(to, "# Nothing was found: %s\n# Draw walls by hand (docs/model-script.md).\n", note);
    if (s->ceiling > 0) {
        if (!(axes->ceiling > 0)) fputs("# axes.txt has no ceiling: a guess from the points of walls\n", to);
        fprintf(to, "set ceiling %.4f\n", s->ceiling);
        if (!(axes->thickness > 0))
            fprintf(to, "# nobody saw the outer walls' other faces: a guess\nset thickness %.4f\n",
                    WALL_THICKNESS * s->ceiling);
        fprintf(to, "set glass %.4f\n\n", GLASS_THICKNESS * s->ceiling);
    }
    for (int w = 0; w < s->wall_count; w++) print_wall(to, s, names, w);
    print_joins(to, s, names);
    print_rooms(to, s, names);
    print_openings(to, s, names);
    print_doubts(to, s);
}
