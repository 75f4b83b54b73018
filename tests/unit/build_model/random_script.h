/* random_script.h - random model scripts and statements for sequences.c. */
#ifndef REMODEL_TESTS_RANDOM_SCRIPT_H
#define REMODEL_TESTS_RANDOM_SCRIPT_H

#include "common/base/rng.h"
#include "tests/unit/build_model/script_volume.h"

enum { TEXT = 16384, LINE = 256 };

static struct rng numbers;
static uint64_t sequence, drawn;

static inline double random_unit(void) { return rng_uniform(&numbers, sequence, drawn++); }
static inline int one_of(int count) { return (int)(random_unit() * count); }

/* On a grid of 5 cm, so that coincidences occur. */
static inline double uniform(double low, double high) { return round((low + (high - low) * random_unit()) * 20) / 20; }

/* -------------------------------------------------------------------------------------------------- base scripts */

static inline void append(char *text, const char *fmt, ...) PRINTF_LIKE(2, 3);
static inline void append(char *text, const char *fmt, ...)
{
    const size_t used = strlen(text);
    va_list args;
    va_start(args, fmt);
    assert_true(vsnprintf(text + used, TEXT - used, fmt, args) < (int)(TEXT - used));
    va_end(args);
}

/* Adds a wall; one in five has its body on the other side, from its second point to the first: returns true. */
static inline bool add_wall(char *text, const char *name, double x0, double y0, double x1, double y1)
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
static inline void add_partition(char *text, const char *name, double x0, double y0, double x1, double y1,
                                 const char *from, const char *to)
{
    const bool turned = add_wall(text, name, x0, y0, x1, y1);
    append(text, "extend %s %s to %s\nextend %s %s to %s\n", name, turned ? "end" : "start", from, name,
           turned ? "start" : "end", to);
}

static inline void layout_add_room(char *text, const char *name, const char *walls)
{
    append(text, "room %s %s", name, walls);
    if (one_of(6) == 0) append(text, " floor %.2f", uniform(-0.3, 0.3));
    if (one_of(6) == 0) append(text, " ceiling %.2f", uniform(2.2, 3));
    append(text, "\n");
}

/* Adds columns x rows of rooms; all names end with `tag`. Partitions run from south to north, other walls between. */
static inline void add_house(char *text, double x0, double y0, int columns, int rows, char tag)
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
            layout_add_room(text, name, walls);
        }
}

static inline void add_corners(char *text, const double (*p)[2], int count)
{
    char name[32], walls[LINE] = "";
    append(text, "%s", "");
    for (int i = 0; i < count; i++) { /* corners are counter-clockwise, walls clockwise */
        snprintf(name, sizeof name, "w%d", i);
        add_wall(text, name, p[(i + 1) % count][0], p[(i + 1) % count][1], p[i][0], p[i][1]);
        append(walls, "%s ", name);
    }
    append(text, "join %sw0\n", walls);
    layout_add_room(text, "hall", walls);
}

static inline void add_base(char *text)
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

static inline const char *some_wall(const struct expected *t) { return t->walls[one_of(t->wall_count)].name; }

static inline const char *some_thing(const struct expected *t)
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

static inline void random_place(const struct expected *t, int wall, double s[2])
{
    const struct expected_wall *w = &t->walls[wall];
    const double low = expected_reach(t, w, 0), high = expected_reach(t, w, 1);
    s[0] = uniform(low - 0.2, high);
    s[1] = s[0] + uniform(0.1, 1.6);
}

static inline void new_hole(const struct expected *t, char *line, int step)
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

static inline void new_box(char *line, int step)
{
    const double x = uniform(-1, 6), y = uniform(-1, 6), z = one_of(2) ? 0 : uniform(-0.5, 2);
    snprintf(line, LINE, "box n%d from %.2f %.2f to %.2f %.2f", step, x, y, x + uniform(0.1, 2), y + uniform(0.1, 2));
    if (z != 0) snprintf(line + strlen(line), LINE - strlen(line), " foot %.2f", z);
    if (one_of(2)) snprintf(line + strlen(line), LINE - strlen(line), " top %.2f", z + uniform(0.1, 2.5));
    if (one_of(12) == 0) snprintf(line + strlen(line), LINE - strlen(line), " turn %d", 15 * one_of(25));
    strcat(line, "\n");
}

static inline void adjust(const struct expected *t, char *line)
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

static inline void new_wall(const struct expected *t, char *line, int step)
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

static inline const char *some_room(const struct expected *t)
{
    return t->room_count ? t->rooms[one_of(t->room_count)].name : "nothing";
}

static inline void new_slot(const struct expected *t, char *line, int step)
{
    const double x = uniform(-0.5, 5), y = uniform(-0.5, 5);
    const bool sky = one_of(2);
    snprintf(line, LINE, "%s n%d on %s from %.2f %.2f to %.2f %.2f%s\n", sky ? "skylight" : "hatch", step, some_room(t),
             x, y, x + uniform(0.1, 1.5), y + uniform(0.1, 1.5),
             one_of(3) ? ""
             : sky     ? " open"
                       : " closed");
}

static inline void change(const struct expected *t, char *line)
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

static inline void resize(const struct expected *t, char *line)
{
    const char *name = some_thing(t);
    const bool slot = expected_slot(t, name) >= 0;
    snprintf(line, LINE, "resize %s left %.2f", name, uniform(-0.3, 0.3));
    if (one_of(2)) snprintf(line + strlen(line), LINE - strlen(line), " right %.2f", uniform(-0.3, 0.3));
    snprintf(line + strlen(line), LINE - strlen(line), " %s %.2f", slot ? "front" : "bottom", uniform(-0.3, 0.3));
    snprintf(line + strlen(line), LINE - strlen(line), " %s %.2f\n", slot ? "back" : "top", uniform(-0.3, 0.3));
}

static inline void shape_ceiling(const struct expected *t, char *line)
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

static inline void random_statement(const struct expected *t, char *line, int step)
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
static inline bool with_crumbs(void) { return sequence % 4 == 3; }

static inline void add_crumbs(char *line)
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

/* A statement that uses a default: a wall, an opening or a box. */
static inline void new_user(const struct expected *t, char *line, int step)
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

#endif
