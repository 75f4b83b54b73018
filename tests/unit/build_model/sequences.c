/* sequences.c - random scripts and random sequences of edits give the solids that they describe.
 *
 * Each sequence draws a base script (a house of rooms, an L, a room with a cut corner, single walls, two houses back to
 * back), adds random statements to it, then applies random edits. A rejected statement must be rejected with file and
 * line, and is left out. After each accepted one: the model is closed, 2-manifold and free of self-intersections; along
 * random lines it has matter where the solids do; if everything is along the axes, its volume is that of
 * script_model.h; faces have the ids of the base by name; a point of the surface that was on the base's surface keeps
 * its face name unless the named thing was touched, or the log records a merge.
 *
 * `make sequences` draws 10 000. In the environment, SEQUENCES=N sets their number, and SEQUENCE=N runs and prints
 * sequence N alone. */
#include "tests/unit/build_model/script_model.h"
#include "tests/unit/build_model/scripted.h"
#include "tests/unit/build_model/unions.h"

#include "common/base/rng.h"

enum { DEFAULT_SEQUENCES = 300, TEXT = 16384, LINE = 256, FURNISHINGS = 6, EDITS = 8, LINES = 10, MAX_HITS = 1024 };
enum { MAX_TOUCHED = 512, MANY_SEQUENCES = 2000 }; /* in many sequences each statement is accepted in some edit */

static struct rng numbers;
static uint64_t sequence, drawn;
static int accepted, rejected, exact_models, points, by_verb[VERB_COUNT];

/* Counts the accepted statement. */
static void count_verb(const char *line)
{
    const size_t length = strcspn(line, " \n");
    for (int v = 0; v < VERB_COUNT; v++)
        by_verb[v] += strlen(verb_name((enum verb)v)) == length && !strncmp(verb_name((enum verb)v), line, length);
}

static double random_unit(void) { return rng_uniform(&numbers, sequence, drawn++); }
static int one_of(int count) { return (int)(random_unit() * count); }

/* On a grid of 5 cm, so that coincidences occur. */
static double uniform(double low, double high) { return round((low + (high - low) * random_unit()) * 20) / 20; }

/* -------------------------------------------------------------------------------------------------- base scripts */

static void append(char *text, const char *fmt, ...) PRINTF_LIKE(2, 3);
static void append(char *text, const char *fmt, ...)
{
    const size_t used = strlen(text);
    va_list args;
    va_start(args, fmt);
    assert_true(vsnprintf(text + used, TEXT - used, fmt, args) < (int)(TEXT - used));
    va_end(args);
}

/* Adds a wall; one in five has its body on the other side, from its second point to the first: returns true. */
static bool add_wall(char *text, const char *name, double x0, double y0, double x1, double y1)
{
    const bool turned = one_of(5) == 0;
    if (turned)
        append(text, "wall %s from %.2f %.2f to %.2f %.2f", name, x1, y1, x0, y0);
    else
        append(text, "wall %s from %.2f %.2f to %.2f %.2f", name, x0, y0, x1, y1);
    if (one_of(6) == 0) append(text, " thickness %.2f", uniform(0.05, 0.4));
    if (one_of(12) == 0) append(text, " top %.2f", uniform(1.5, 3.5));
    append(text, "%s\n", x0 != x1 && y0 != y1 ? " angled" : "");
    return turned;
}

/* Adds a wall that meets two others. */
static void add_partition(char *text, const char *name, double x0, double y0, double x1, double y1, const char *from,
                          const char *to)
{
    const bool turned = add_wall(text, name, x0, y0, x1, y1);
    append(text, "extend %s %s to %s\nextend %s %s to %s\n", name, turned ? "end" : "start", from, name,
           turned ? "start" : "end", to);
}

static void add_room(char *text, const char *name, const char *walls)
{
    append(text, "room %s %s", name, walls);
    if (one_of(6) == 0) append(text, " floor %.2f", uniform(-0.3, 0.3));
    if (one_of(6) == 0) append(text, " ceiling %.2f", uniform(2.2, 3));
    append(text, "\n");
}

/* Adds columns x rows of rooms; all names end with `tag`. Partitions run from south to north, other walls between. */
static void add_house(char *text, double x0, double y0, int columns, int rows, char tag)
{
    double x[4] = {x0}, y[3] = {y0};
    char outer[4][32], across[4][32], between[4][32], name[32], walls[LINE]; /* across[0]: the west wall */
    for (int i = 0; i < columns; i++) x[i + 1] = x[i] + uniform(1.5, 4);
    for (int k = 0; k < rows; k++) y[k + 1] = y[k] + uniform(1.5, 4);
    for (int i = 0; i < 4; i++) snprintf(outer[i], sizeof outer[i], "%.2s%c", &"sowenoea"[2 * i], tag);
    add_wall(text, outer[0], x[columns], y0, x0, y0);
    add_wall(text, outer[1], x0, y0, x0, y[rows]);
    add_wall(text, outer[2], x0, y[rows], x[columns], y[rows]);
    add_wall(text, outer[3], x[columns], y[rows], x[columns], y0);
    append(text, "join %s %s %s %s %s\n", outer[0], outer[1], outer[2], outer[3], outer[0]);
    strcpy(across[0], outer[1]);
    strcpy(across[columns], outer[3]);
    for (int i = 1; i < columns; i++) {
        snprintf(across[i], sizeof across[i], "v%d%c", i, tag);
        add_partition(text, across[i], x[i], y0 + 0.5, x[i], y[rows] - 0.5, outer[0], outer[2]);
    }
    for (int i = 0; i < columns && rows > 1; i++) {
        snprintf(between[i], sizeof between[i], "h%d%c", i, tag);
        const double at = i && one_of(2) ? uniform(y0 + 1, y[2] - 1) : y[1];
        add_partition(text, between[i], x[i] + 0.5, at, x[i + 1] - 0.5, at, across[i], across[i + 1]);
    }
    for (int i = 0; i < columns; i++)
        for (int k = 0; k < rows; k++) {
            snprintf(name, sizeof name, "r%d%d%c", i, k, tag);
            snprintf(walls, sizeof walls, "%s %s %s %s", k ? between[i] : outer[0], across[i],
                     rows > 1 && !k ? between[i] : outer[2], across[i + 1]);
            add_room(text, name, walls);
        }
}

static void add_corners(char *text, const double (*p)[2], int count)
{
    char name[32], walls[LINE] = "";
    append(text, "%s", "");
    for (int i = 0; i < count; i++) { /* corners are counter-clockwise, walls clockwise */
        snprintf(name, sizeof name, "w%d", i);
        add_wall(text, name, p[(i + 1) % count][0], p[(i + 1) % count][1], p[i][0], p[i][1]);
        append(walls, "%s ", name);
    }
    append(text, "join %sw0\n", walls);
    add_room(text, "hall", walls);
}

static void add_base(char *text)
{
    const double a = uniform(3, 6), b = uniform(3, 6), c = uniform(0.5, a - 1), d = uniform(0.5, b - 1);
    strcpy(text, "remodel-script 1\n");
    if (one_of(2)) append(text, "set thickness %.2f\n", uniform(0.1, 0.3));
    if (one_of(4) == 0) append(text, "set slab %.2f\n", uniform(0.1, 0.4));
    if (one_of(4) == 0) append(text, "set floor %.2f\n", uniform(-0.2, 0.2));
    if (one_of(4) == 0) append(text, "set ceiling %.2f\n", uniform(2, 3));
    switch (one_of(8)) {
    case 0:
    case 1:
    case 2:
        add_house(text, 0, 0, 1 + one_of(3), 1 + one_of(2), 'a');
        break;
    case 3: /* back to back, close together, or with overlapping walls */
        add_house(text, 0, 0, 1, 1 + one_of(2), 'a');
        add_house(text, uniform(-1, 4), uniform(-4, 4), 1 + one_of(2), 1, 'b');
        break;
    case 4:
        add_corners(text, (const double[6][2]){{0, 0}, {a, 0}, {a, d}, {c, d}, {c, b}, {0, b}}, 6);
        break;
    case 5:
        add_corners(text, (const double[5][2]){{0, 0}, {a, 0}, {a, d}, {c, b}, {0, b}}, 5);
        break;
    case 6:
        add_corners(text,
                    (const double[8][2]){
                        {0, 0}, {a, 0}, {a, b}, {c + 0.8, b}, {c + 0.8, d}, {c - 0.2, d}, {c - 0.2, b}, {0, b}},
                    8);
        break;
    default:
        add_wall(text, "alone", 0, 0, a, 0);
        add_wall(text, "other", c, uniform(-2, 2), c, b);
        if (one_of(2)) append(text, "join alone other\n");
    }
}

/* ---------------------------------------------------------------------------------------------------- statements */

static const char *some_wall(const struct expected *t) { return t->walls[one_of(t->wall_count)].name; }

static const char *some_thing(const struct expected *t)
{
    switch (one_of(6)) {
    case 0:
        return some_wall(t);
    case 1:
        return t->box_count ? t->boxes[one_of(t->box_count)].name : "nothing";
    case 2:
        return t->slot_count ? t->slots[one_of(t->slot_count)].name : "nothing";
    default:
        return t->hole_count ? t->holes[one_of(t->hole_count)].name : "nothing";
    }
}

static void random_place(const struct expected *t, int wall, double s[2])
{
    const struct expected_wall *w = &t->walls[wall];
    const double low = expected_reach(t, w, 0), high = expected_reach(t, w, 1);
    s[0] = uniform(low - 0.2, high);
    s[1] = s[0] + uniform(0.1, 1.6);
}

static void new_hole(const struct expected *t, char *line, int step)
{
    static const char *const words[3][3] = {{"", " closed", " closed"}, {"", "", ""}, {"", " open", " interior"}};
    static const char *const kinds[3] = {"door", "passage", "window"};
    const int kind = one_of(3), wall = one_of(t->wall_count);
    const double z = kind == 2 || one_of(4) == 0 ? uniform(0, 1.5) : t->walls[wall].foot;
    double s[2];
    random_place(t, wall, s);
    if (one_of(4) == 0) {
        snprintf(line, LINE, "%s n%d on %s at %s %.2f width %.2f from %.2f to %.2f%s\n", kinds[kind], step,
                 t->walls[wall].name, one_of(2) ? "left" : "right", uniform(-0.1, 2), uniform(0.1, 1.6), z,
                 z + uniform(0.2, 2.2), words[kind][one_of(3)]);
        return;
    }
    snprintf(line, LINE, "%s n%d on %s from %.2f %.2f to %.2f %.2f%s\n", kinds[kind], step, t->walls[wall].name, s[0],
             z, s[1], z + uniform(0.2, 2.2), words[kind][one_of(3)]);
}

static void new_box(char *line, int step)
{
    const double x = uniform(-1, 6), y = uniform(-1, 6), z = one_of(2) ? 0 : uniform(-0.5, 2);
    snprintf(line, LINE, "box n%d from %.2f %.2f to %.2f %.2f", step, x, y, x + uniform(0.1, 2), y + uniform(0.1, 2));
    if (z != 0) snprintf(line + strlen(line), LINE - strlen(line), " foot %.2f", z);
    if (one_of(2)) snprintf(line + strlen(line), LINE - strlen(line), " top %.2f", z + uniform(0.1, 2.5));
    if (one_of(12) == 0) snprintf(line + strlen(line), LINE - strlen(line), " turn %d", 15 * one_of(25));
    strcat(line, "\n");
}

static void adjust(const struct expected *t, char *line)
{
    const char *name = some_thing(t);
    const int wall = expected_wall(t, name), hole = expected_hole(t, name);
    if (wall >= 0) {
        const double at = t->walls[wall].in + uniform(-0.5, 0.5);
        const double p[4] = {t->walls[wall].axis ? at : 0, t->walls[wall].axis ? 0 : at, t->walls[wall].axis ? at : 1,
                             t->walls[wall].axis ? 1 : at};
        snprintf(line, LINE, "adjust %s from %.2f %.2f to %.2f %.2f\n", name, p[0], p[1], p[2], p[3]);
    } else if (hole >= 0) {
        double s[2];
        random_place(t, t->holes[hole].wall, s);
        const double z = one_of(2) ? t->holes[hole].z[0] : uniform(0, 1.5);
        snprintf(line, LINE, "adjust %s from %.2f %.2f to %.2f %.2f\n", name, s[0], z, s[1], z + uniform(0.2, 2));
    } else {
        const double x = uniform(-1, 6), y = uniform(-1, 6);
        snprintf(line, LINE, "adjust %s from %.2f %.2f to %.2f %.2f\n", name, x, y, x + uniform(0.1, 2),
                 y + uniform(0.1, 2));
    }
}

static void new_wall(const struct expected *t, char *line, int step)
{
    const double x = uniform(-1, 6), y = uniform(-1, 6), by = uniform(-3, 3);
    const int kind = one_of(8);
    char options[64] = "";
    if (one_of(4) == 0) snprintf(options, sizeof options, " foot %.2f top %.2f", uniform(-0.5, 1), uniform(1.5, 3));
    if (kind == 0)
        snprintf(line, LINE, "wall n%d from %.2f %.2f to %.2f %.2f%s angled\n", step, x, y, x + uniform(-2, 2),
                 y + uniform(-2, 2), options);
    else if (kind < 5)
        snprintf(line, LINE, "wall n%d from %.2f %.2f to %.2f %.2f%s\n", step, x, y, x + by, y, options);
    else
        snprintf(line, LINE, "wall n%d from %.2f %.2f to %.2f %.2f%s\n", step, x, y, x, y + by, options);
    (void)t;
}

static const char *some_room(const struct expected *t)
{
    return t->room_count ? t->rooms[one_of(t->room_count)].name : "nothing";
}

static void new_slot(const struct expected *t, char *line, int step)
{
    const double x = uniform(-0.5, 5), y = uniform(-0.5, 5);
    const bool sky = one_of(2);
    snprintf(line, LINE, "%s n%d on %s from %.2f %.2f to %.2f %.2f%s\n", sky ? "skylight" : "hatch", step, some_room(t),
             x, y, x + uniform(0.1, 1.5), y + uniform(0.1, 1.5),
             one_of(3) ? ""
             : sky     ? " open"
                       : " closed");
}

static void change(const struct expected *t, char *line)
{
    switch (one_of(5)) {
    case 0:
        snprintf(line, LINE, "change %s top %.2f\n", some_wall(t), uniform(1.5, 3.5));
        break;
    case 1:
        snprintf(line, LINE, "change %s thickness %.2f foot %.2f\n", some_wall(t), uniform(0.05, 0.4),
                 uniform(-0.3, 0.3));
        break;
    case 2:
        snprintf(line, LINE, "change %s foot %.2f top %.2f\n", t->box_count ? t->boxes[one_of(t->box_count)].name : "x",
                 uniform(-0.5, 1), uniform(1, 3));
        break;
    default:
        snprintf(line, LINE, "change %s ceiling %.2f\n", some_room(t), uniform(1.8, 3.4));
    }
}

static void resize(const struct expected *t, char *line)
{
    const char *name = some_thing(t);
    const bool slot = expected_slot(t, name) >= 0;
    snprintf(line, LINE, "resize %s left %.2f", name, uniform(-0.3, 0.3));
    if (one_of(2)) snprintf(line + strlen(line), LINE - strlen(line), " right %.2f", uniform(-0.3, 0.3));
    snprintf(line + strlen(line), LINE - strlen(line), " %s %.2f", slot ? "front" : "bottom", uniform(-0.3, 0.3));
    snprintf(line + strlen(line), LINE - strlen(line), " %s %.2f\n", slot ? "back" : "top", uniform(-0.3, 0.3));
}

static void shape_ceiling(const struct expected *t, char *line)
{
    if (!t->room_count) {
        strcpy(line, "slope\n");
        return;
    }
    const struct expected_room *r = &t->rooms[one_of(t->room_count)];
    const int at = one_of(r->wall_count);
    const char *a = t->walls[r->walls[at]].name, *b = t->walls[r->walls[(at + 2) % r->wall_count]].name;
    const double low = uniform(1.8, 3), high = uniform(1.8, 3);
    if (one_of(2)) {
        snprintf(line, LINE, "slope %s from %s %.2f to %s %.2f\n", r->name, a, low, b, high);
        return;
    }
    snprintf(line, LINE, "gable %s from %s %.2f to %s %.2f ridge %.2f", r->name, a, low, b, high,
             fmax(low, high) + uniform(0.1, 1.5));
    if (one_of(2)) snprintf(line + strlen(line), LINE - strlen(line), " at %.2f", uniform(0.2, 2.5));
    strcat(line, "\n");
}

static void random_statement(const struct expected *t, char *line, int step)
{
    static const char *const fillings[] = {"leaf", "glass", "wall", "nothing"};
    static const char *const quantities[] = {"thickness", "slab", "glass", "leaf", "floor", "ceiling"};
    const char *wall = some_wall(t);
    const double s = uniform(-1, 6);
    switch (one_of(31)) {
    case 0:
    case 1:
    case 2:
        snprintf(line, LINE, "move %s by %.2f\n", wall, uniform(-0.6, 0.6));
        break;
    case 3:
    case 4:
        if (expected_box(t, wall = some_thing(t)) >= 0)
            snprintf(line, LINE, "move %s by %.2f %.2f %.2f\n", wall, uniform(-0.6, 0.6), uniform(-0.6, 0.6),
                     one_of(2) ? 0 : uniform(-0.6, 0.6));
        else if (one_of(2))
            snprintf(line, LINE, "move %s by %.2f %.2f\n", wall, uniform(-0.6, 0.6), uniform(-0.6, 0.6));
        else
            snprintf(line, LINE, "move %s by %.2f\n", wall, uniform(-0.6, 0.6));
        break;
    case 5:
    case 6:
    case 7:
        adjust(t, line);
        break;
    case 8:
        snprintf(line, LINE, "%s %s\n", one_of(2) ? "open" : "close", some_thing(t));
        break;
    case 9:
    case 10:
    case 11:
    case 12:
        new_hole(t, line, step);
        break;
    case 13:
    case 14:
        new_box(line, step);
        break;
    case 15:
        snprintf(line, LINE, "remove %s\n", one_of(4) || !t->room_count ? some_thing(t) : t->rooms[0].name);
        break;
    case 16:
        snprintf(line, LINE, "split %s from %.2f to %.2f into n%d\n", wall, s, s + uniform(0.1, 1.5), step);
        break;
    case 17:
        if (one_of(2))
            snprintf(line, LINE, "extend %s %s to %s\n", wall, one_of(2) ? "start" : "end", some_wall(t));
        else
            snprintf(line, LINE, "extend %s %s to %.2f\n", wall, one_of(2) ? "start" : "end", s);
        break;
    case 18:
        snprintf(line, LINE, "join %s %s\n", one_of(2) ? wall : t->walls[t->wall_count - 1].name, some_wall(t));
        break;
    case 19:
        new_wall(t, line, step);
        break;
    case 20:
        if (one_of(3))
            snprintf(line, LINE, "set %s %.2f\n", quantities[one_of(6)], uniform(0.05, 0.4));
        else
            shape_ceiling(t, line);
        break;
    case 21:
    case 22:
    case 23:
        new_slot(t, line, step);
        break;
    case 24:
    case 25:
        change(t, line);
        break;
    case 26:
    case 27:
        resize(t, line);
        break;
    case 28:
        snprintf(line, LINE, "fill %s with %s\n", some_thing(t), fillings[one_of(4)]);
        break;
    case 29:
        snprintf(line, LINE, "wall n%d parallel to %s by %.2f between %s %s\n", step, wall, uniform(-1, 3),
                 some_wall(t), some_wall(t));
        break;
    default:
        snprintf(line, LINE, "room n%d %s %s %s %s\n", step, wall, some_wall(t), some_wall(t), some_wall(t));
    }
}

/* Every fourth sequence has nearly equal numbers: differences of millionths, the resolution of models, and less. */
static bool with_crumbs(void) { return sequence % 4 == 3; }

static void add_crumbs(char *line)
{
    char old[LINE], *to = line;
    snprintf(old, sizeof old, "%s", line);
    for (const char *at = old; *at; at++) {
        *to++ = *at;
        if (at - old < 3 || at[-2] != '.' || (at[1] != ' ' && at[1] != '\n') || one_of(4)) continue;
        to += sprintf(to, "%s%02d", one_of(2) ? "000" : "0000", one_of(100));
        assert_true(to - line < LINE - 16);
    }
    *to = 0;
}

/* -------------------------------------------------------------------------------------------------------- models */

struct model {
    struct plan plan;
    struct solid_list list;
    struct solid_mesh mesh;
    struct solid_report report;
    struct unite_log log;
};

static void drop_model(struct model *m)
{
    unite_log_release(&m->log);
    solid_report_release(&m->report);
    solid_mesh_release(&m->mesh);
    drop(&m->plan, &m->list);
}

static void explain(const char *base, const char *edit)
{
    fprintf(stderr, "sequence %d:\n%s%s%s", (int)sequence, base, edit ? "---- edit\n" : "", edit ? edit : "");
}

/* Makes the model of a script and an edit (or NULL). False: the plan was rejected with an error message; line: of the
 * statement that it must name, 0 for any. */
static bool make_model(struct model *m, const char *base, const char *edit, int line)
{
    struct err err = ERR_INIT;
    *m = (struct model){0};
    if (scripted(&m->plan, base, edit, &err)) {
        char place[64];
        if (edit && line)
            snprintf(place, sizeof place, "/edit.txt:%d: ", line);
        else
            strcpy(place, edit ? "/edit.txt:" : "/model.txt:");
        if (err.status != ST_DATA || !strstr(err.text, place) || !strchr(".?", err.text[strlen(err.text) - 1])) {
            explain(base, edit);
            fail_msg("rejected without file and line: %s", err.text);
        }
        plan_release(&m->plan);
        return false;
    }
    if (layout_solids(&m->list, &m->plan, &err) || solids_unite(&m->mesh, &m->list, &m->log, &err) ||
        solid_mesh_check(&m->mesh, 0, &m->report, &err)) {
        explain(base, edit);
        fail_msg("accepted, but not a solid: %s", err.text);
    }
    return true;
}

/* --------------------------------------------------------------------------------------------------------- lines */

struct ray {
    struct vec3 o, d;
};

struct hit {
    double t;
    int way; /* 1 into matter, -1 out of it */
    const char *name, *body;
};

static int compare_hits(const void *a, const void *b)
{
    const struct hit *x = a, *y = b;
    return (x->t > y->t) - (x->t < y->t);
}

static bool on_face(const struct solid_mesh *mesh, const struct solid_face *f, struct vec3 p)
{
    const double n[3] = {fabs(f->normal.x), fabs(f->normal.y), fabs(f->normal.z)};
    const int drop_axis = n[0] > n[1] ? (n[0] > n[2] ? 0 : 2) : n[1] > n[2] ? 1 : 2;
    const int u = (drop_axis + 1) % 3, v = (drop_axis + 2) % 3;
    const double at[3] = {p.x, p.y, p.z};
    bool in = false;
    for (int l = f->loop; l < f->loop + f->loops; l++) {
        int h = mesh->loops[l].half_edge;
        do {
            const struct vec3 a = mesh->vertices[mesh->half_edges[h].origin].p;
            h = mesh->half_edges[h].next;
            const struct vec3 b = mesh->vertices[mesh->half_edges[h].origin].p;
            const double x[3] = {a.x, a.y, a.z}, y[3] = {b.x, b.y, b.z};
            if ((x[v] > at[v]) != (y[v] > at[v]) && x[u] + (at[v] - x[v]) / (y[v] - x[v]) * (y[u] - x[u]) > at[u])
                in = !in;
        } while (h != mesh->loops[l].half_edge);
    }
    return in;
}

static int hit_mesh(const struct solid_mesh *mesh, const struct ray *r, struct hit hits[MAX_HITS])
{
    int n = 0;
    for (int f = 0; f < mesh->face_count; f++) {
        const struct solid_face *face = &mesh->faces[f];
        const double slant = vec3_dot(face->normal, r->d);
        const double t = (face->offset - vec3_dot(face->normal, r->o)) / slant;
        if (!isfinite(t) || !on_face(mesh, face, vec3_add(r->o, vec3_scale(r->d, t)))) continue;
        assert_true(n < MAX_HITS);
        hits[n++] = (struct hit){t, slant < 0 ? 1 : -1, solid_face_name(mesh, f), mesh->bodies[face->body].name};
    }
    if (n) qsort(hits, (size_t)n, sizeof *hits, compare_hits);
    return n;
}

/* Where the line enters and leaves each solid; false: it grazes a plane, so that rounding would matter. */
static bool hit_solids(const struct solid_list *list, const struct ray *r, struct hit hits[MAX_HITS], int *count)
{
    *count = 0;
    for (int i = 0; i < list->count; i++) {
        const struct solid *s = &list->solids[i];
        double from = -HUGE_VAL, to = HUGE_VAL;
        for (int k = 0; k < s->count; k++) {
            const double slant = vec3_dot(s->half_spaces[k].normal, r->d);
            const double t = (s->half_spaces[k].offset - vec3_dot(s->half_spaces[k].normal, r->o)) / slant;
            if (fabs(slant) < 0.02 * vec3_length(s->half_spaces[k].normal)) return false;
            if (slant < 0)
                from = fmax(from, t);
            else
                to = fmin(to, t);
        }
        if (to <= from) continue;
        assert_true(*count + 2 <= MAX_HITS);
        hits[(*count)++] = (struct hit){from, 1, NULL, s->body};
        hits[(*count)++] = (struct hit){to, -1, NULL, s->body};
    }
    if (*count) qsort(hits, (size_t)*count, sizeof *hits, compare_hits);
    return true;
}

/* Length of the line on which only one of mesh and solids has matter of the body. */
static double line_difference(const struct hit *mesh, int mesh_count, const struct hit *solids, int solid_count,
                              const char *body)
{
    double wrong = 0, before = 0;
    for (int i = 0, k = 0, in = 0, depth = 0; i < mesh_count || k < solid_count;) {
        const bool next_mesh = k == solid_count || (i < mesh_count && mesh[i].t < solids[k].t);
        const double t = next_mesh ? mesh[i].t : solids[k].t;
        if (in != (depth > 0)) wrong += t - before;
        before = t;
        if (next_mesh && !strcmp(mesh[i].body, body)) in += mesh[i].way;
        if (!next_mesh && !strcmp(solids[k].body, body)) depth += solids[k].way;
        if (next_mesh)
            i++;
        else
            k++;
    }
    return wrong;
}

static struct ray random_ray(const struct solid_mesh *mesh)
{
    struct vec3 low = mesh->vertices[0].p, high = low, d;
    for (int i = 0; i < mesh->vertex_count; i++) {
        const struct vec3 p = mesh->vertices[i].p;
        low = vec3_make(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high = vec3_make(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    const struct vec3 at = {low.x + random_unit() * (high.x - low.x), low.y + random_unit() * (high.y - low.y),
                            low.z + random_unit() * (high.z - low.z)};
    do d = vec3_make(random_unit() - 0.5, random_unit() - 0.5, random_unit() - 0.5);
    while (fmin(fabs(d.x), fmin(fabs(d.y), fabs(d.z))) < 0.05);
    return (struct ray){at, vec3_normalize(d)};
}

/* -------------------------------------------------------------------------------------------------------- identity */

struct touched {
    char names[MAX_TOUCHED][NAME_SIZE];
    int count;
    char beside[MAX_TOUCHED][NAME_SIZE]; /* rooms and walls at a touched wall, whose common border may have moved */
    int beside_count;
};

static void keep_name(char names[MAX_TOUCHED][NAME_SIZE], int *count, const char *name)
{
    assert_true(*count < MAX_TOUCHED);
    snprintf(names[(*count)++], NAME_SIZE, "%s", name);
}

static void touch_wall(struct touched *touched, const struct expected *t, int wall)
{
    for (int i = 0; i < t->hole_count; i++)
        if (t->holes[i].wall == wall) keep_name(touched->names, &touched->count, t->holes[i].name);
    for (int i = 0; i < t->room_count; i++)
        for (int k = 0; k < t->rooms[i].wall_count; k++)
            if (t->rooms[i].walls[k] == wall) keep_name(touched->beside, &touched->beside_count, t->rooms[i].name);
    for (int i = 0; i < t->wall_count; i++)
        for (int e = 0; e < 2; e++)
            if (t->walls[i].ends[e].kind != MODEL_FREE && t->walls[i].ends[e].other == wall)
                keep_name(touched->beside, &touched->beside_count, t->walls[i].name);
}

/* Records all names in the line, the openings of its walls, which move with them, and the things beside these. */
static void touch_line(struct touched *touched, const struct expected *t, const char *line)
{
    char text[LINE], *rest = text;
    snprintf(text, sizeof text, "%s", line);
    for (char *word; (word = strtok_r(rest, " \n", &rest));) {
        const int wall = expected_wall(t, word);
        if (wall < 0 && expected_hole(t, word) < 0 && expected_box(t, word) < 0 && expected_room(t, word) < 0 &&
            expected_slot(t, word) < 0)
            continue;
        keep_name(touched->names, &touched->count, word);
        if (wall >= 0) touch_wall(touched, t, wall);
    }
}

static bool is_among(const char (*names)[NAME_SIZE], int count, const char *face)
{
    const char *from = strchr(face, '/') + 1;
    const size_t length = strcspn(from, "/");
    for (int i = 0; i < count; i++)
        if (strlen(names[i]) == length && !strncmp(names[i], from, length)) return true;
    return false;
}

static bool merges(const struct unite_log *log, const char *name, const char *into)
{
    bool found = !strcmp(name, into);
    for (int i = 0; i < log->count && !found; i++)
        found = log->notes[i].event == UNITE_MERGED && !strcmp(log->notes[i].name, name) &&
                !strcmp(log->notes[i].into, into);
    return found;
}

/* Whether a surface may be named `a` in model m and `b` in model n. */
static bool same_surface(const struct model *m, const char *a, const struct model *n, const char *b)
{
    if (merges(&m->log, b, a) || merges(&n->log, a, b)) return true;
    for (int i = 0; i < m->log.count; i++)
        if (m->log.notes[i].event == UNITE_MERGED && !strcmp(m->log.notes[i].into, a) &&
            merges(&n->log, m->log.notes[i].name, b))
            return true;
    return false;
}

/* Whether the face's name, or one merged into it, belongs to something beside a touched wall. */
static bool is_beside(const struct touched *t, const struct unite_log *log, const char *face)
{
    bool found = is_among(t->beside, t->beside_count, face);
    for (int i = 0; i < log->count && !found; i++)
        found = merges(log, log->notes[i].name, face) && is_among(t->beside, t->beside_count, log->notes[i].name);
    return found;
}

static bool may_differ(const struct touched *t, const struct model *m, const char *a, const struct model *n,
                       const char *b)
{
    return is_among(t->names, t->count, a) || is_among(t->names, t->count, b) || same_surface(m, a, n, b) ||
           (is_beside(t, &m->log, a) && is_beside(t, &n->log, b));
}

static void check_identity(const struct model *base, struct model *m, const struct touched *touched,
                           const struct ray *rays, const char *text, const char *edit)
{
    static struct hit old[MAX_HITS], new[MAX_HITS];
    const struct solid_mesh *b = &base->mesh, *e = &m->mesh;
    struct err err = ERR_INIT;
    assert_ok(solid_mesh_carry_ids(&m->mesh, &base->mesh, &err), err);
    const int max_id = b->names[b->name_count - 1].id;
    for (int i = 0; i < e->name_count; i++) {
        int k = 0;
        while (k < b->name_count && strcmp(b->names[k].name, e->names[i].name)) k++;
        if (k < b->name_count ? e->names[i].id == b->names[k].id : e->names[i].id > max_id) continue;
        explain(text, edit);
        fail_msg("%s has the id %d", e->names[i].name, e->names[i].id);
    }
    for (int r = 0; r < LINES; r++) {
        const int count = hit_mesh(b, &rays[r], old), edited = hit_mesh(e, &rays[r], new);
        for (int i = 0, k = 0; i < count; i++) {
            while (k < edited && new[k].t < old[i].t - 1e-9) k++;
            if (k == edited || new[k].t > old[i].t + 1e-9 || new[k].way != old[i].way ||
                strcmp(new[k].body, old[i].body))
                continue;
            points++;
            if (!strcmp(new[k].name, old[i].name) || may_differ(touched, base, old[i].name, m, new[k].name)) continue;
            explain(text, edit);
            fail_msg("a point of %s is now on %s", old[i].name, new[k].name);
        }
    }
}

static void check_model(const struct model *m, struct expected *expected, const struct ray *rays, const char *text,
                        const char *edit)
{
    static struct hit mesh[MAX_HITS], solids[MAX_HITS];
    for (int i = 0; i < m->mesh.name_count; i++) {
        const char *end = strrchr(m->mesh.names[i].name, '/');
        if (strcmp(end, "/cut")) continue;
        explain(text, edit);
        fail_msg("a cut between a wall's pieces is on the surface: %s", m->mesh.names[i].name);
    }
    for (int r = 0; r < LINES; r++) {
        int count;
        if (!hit_solids(&m->list, &rays[r], solids, &count)) continue;
        const int found = hit_mesh(&m->mesh, &rays[r], mesh);
        for (int b = 0; b < m->mesh.body_count; b++) {
            const double off = line_difference(mesh, found, solids, count, m->mesh.bodies[b].name);
            if (off < 1e-3) continue;
            explain(text, edit);
            fail_msg("along a line, body %s differs from its solids over a length of %g", m->mesh.bodies[b].name, off);
        }
    }
    if (!expected->exact) return;
    double solid, panes, found[2] = {0, 0};
    expected_volumes(expected, &solid, &panes);
    exact_models++;
    for (int b = 0; b < m->mesh.body_count; b++)
        found[!!strcmp(m->mesh.bodies[b].name, "walls")] += solid_mesh_volume(&m->mesh, b);
    /* surfaces are rounded to the lattice, by half a step at most; positions within a step of each other are equal */
    const double tolerance = 1e-8 * (1 + solid) + (with_crumbs() ? 1.5e-6 * m->report.area : 0);
    if (fabs(found[0] - solid) < tolerance && fabs(found[1] - panes) < tolerance) return;
    explain(text, edit);
    for (int i = 0, shown = 0; i < 1000000 && shown < 3; i++) { /* where */
        const double p[3] = {random_unit() * 14 - 4, random_unit() * 14 - 5, random_unit() * 5 - 1};
        if (expected_has_matter(expected, p) == (inside(&m->list, "walls", p[0], p[1], p[2]) > 0)) continue;
        print_message("at %.3f %.3f %.3f the script has %smatter\n", p[0], p[1], p[2],
                      expected_has_matter(expected, p) ? "" : "no ");
        shown++;
    }
    fail_msg("volume %.12g and panes %.12g, but the script describes %.12g and %.12g", found[0], found[1], solid,
             panes);
}

static void interpret(struct expected *expected, const char *text)
{
    char copy[TEXT], *rest = copy;
    expected_begin(expected);
    snprintf(copy, sizeof copy, "%s", text);
    for (char *line; (line = strtok_r(rest, "\n", &rest));)
        if (strncmp(line, "remodel", 7)) expected_apply(expected, line);
}

/* A statement that uses a default: a wall, an opening or a box. */
static void new_user(const struct expected *t, char *line, int step)
{
    switch (one_of(3)) {
    case 0:
        new_wall(t, line, step);
        break;
    case 1:
        new_hole(t, line, step);
        break;
    default:
        new_box(line, step);
    }
}

static void accept_line(struct expected *expected, const char *line)
{
    accepted++;
    count_verb(line);
    expected_apply(expected, line);
}

static void one_sequence(void)
{
    static char base[TEXT], edit[TEXT], tried[TEXT];
    static struct expected expected, before;
    struct touched touched = {.count = 0};
    struct model m, edited;
    struct ray rays[LINES];
    char line[LINE];
    int step = 0, lines = 1;

    drawn = 0;
    do add_base(base);
    while (!make_model(&m, base, NULL, 0)); /* rejected if walls are thicker than rooms */
    drop_model(&m);
    interpret(&expected, base);
    for (int i = 0; i < FURNISHINGS; i++) {
        random_statement(&expected, line, ++step);
        if (with_crumbs()) add_crumbs(line);
        strcpy(tried, base);
        append(tried, "%s", line);
        if (!make_model(&m, tried, NULL, 0)) continue;
        drop_model(&m);
        strcpy(base, tried);
        expected_apply(&expected, line);
    }
    assert_true(make_model(&m, base, NULL, 0));
    if (!m.mesh.face_count) {
        drop_model(&m);
        return;
    }
    for (int r = 0; r < LINES; r++) rays[r] = random_ray(&m.mesh);
    check_model(&m, &expected, rays, base, NULL);
    strcpy(edit, "remodel-script 1\n");
    for (int i = 0; i < EDITS; i++) {
        char user[LINE] = ""; /* of a default: a set that no statement uses is rejected */
        random_statement(&expected, line, ++step);
        if (!strncmp(line, "set ", 4)) new_user(&expected, user, ++step);
        if (with_crumbs()) add_crumbs(line);
        strcpy(tried, edit);
        append(tried, "%s%s", line, user);
        if (!make_model(&edited, base, tried, *user ? 0 : lines + 1)) {
            rejected++;
            continue;
        }
        strcpy(edit, tried);
        lines += *user ? 2 : 1;
        before = expected;
        accept_line(&expected, line);
        if (*user) accept_line(&expected, user);
        touch_line(&touched, &before, line);
        touch_line(&touched, &expected, line);
        touch_line(&touched, &expected, user);
        check_model(&edited, &expected, rays, base, edit);
        check_identity(&m, &edited, &touched, rays, base, edit);
        if (i == EDITS - 1) assert_triangles_closed(&edited.mesh);
        drop_model(&edited);
    }
    drop_model(&m);
    if (getenv("SEQUENCE")) explain(base, edit);
}

static void random_sequences_of_edits_give_the_described_solids(void **state)
{
    const char *wanted = getenv("SEQUENCES"), *one = getenv("SEQUENCE");
    const int count = wanted ? atoi(wanted) : DEFAULT_SEQUENCES;
    (void)state;
    numbers = rng_make(11, "build_model", "sequences");
    for (int i = 0; i < count && !one; i++) {
        sequence = (uint64_t)i;
        one_sequence();
    }
    if (one) {
        sequence = (uint64_t)atoll(one);
        one_sequence();
        return;
    }
    print_message("%d sequences: %d edits accepted, %d rejected; %d volumes, %d points compared\n", count, accepted,
                  rejected, exact_models, points);
    for (int v = 0; v < VERB_COUNT; v++) {
        print_message("%s %d%s", verb_name((enum verb)v), by_verb[v],
                      v + 1 < VERB_COUNT ? ", " : " accepted in edits\n");
        assert_true(by_verb[v] > 0 || count < MANY_SEQUENCES);
    }
    assert_true(accepted >= 3 * count / 2 && rejected >= count && exact_models >= 2 * count && points >= 10 * count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_sequences_of_edits_give_the_described_solids)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
