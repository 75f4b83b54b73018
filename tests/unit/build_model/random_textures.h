/* random_textures.h - random statements about textures, colours, clutter and light for sequences.c. */
#ifndef REMODEL_TESTS_RANDOM_TEXTURES_H
#define REMODEL_TESTS_RANDOM_TEXTURES_H

#include "common/model/solid_mesh.h"
#include "tests/unit/build_model/random_script.h"

static inline void add_words(char *line, const char *fmt, ...) PRINTF_LIKE(2, 3);
static inline void add_words(char *line, const char *fmt, ...)
{
    const size_t used = strlen(line);
    va_list args;
    va_start(args, fmt);
    assert_true(vsnprintf(line + used, LINE - used, fmt, args) < (int)(LINE - used));
    va_end(args);
}

/* A face of the base, or one that a statement of the edit may have made. */
static inline void some_face(const struct expected *t, const struct solid_mesh *base, char face[FACE_SIZE])
{
    static const char *const parts[] = {"left", "right", "head", "bottom", "top"};
    const struct expected_hole *h = t->hole_count ? &t->holes[one_of(t->hole_count)] : NULL;
    const char *part = parts[one_of(5)];
    switch (one_of(8)) {
    case 0:
        snprintf(face, FACE_SIZE, "wall/%s/%s", some_wall(t), one_of(3) ? "in" : "out");
        break;
    case 1:
        snprintf(face, FACE_SIZE, "box/%s/%s", t->box_count ? t->boxes[one_of(t->box_count)].name : "nothing", part);
        break;
    case 2:
        snprintf(face, FACE_SIZE, "%s/%s/%s",
                 !h               ? "door"
                 : h->kind == 'w' ? "glass"
                 : h->kind == 'd' ? "door"
                                  : "passage",
                 h ? h->name : "nothing", h && h->kind == 'w' ? "in" : part);
        break;
    default:
        snprintf(face, FACE_SIZE, "%s", base->names[one_of(base->name_count)].name);
    }
}

/* A face on which places can be given, mostly. */
static inline void some_placed_face(const struct expected *t, const struct solid_mesh *base, char face[FACE_SIZE])
{
    for (int i = 0; i < 8; i++) {
        some_face(t, base, face);
        const char *last = strrchr(face, '/');
        if (!strncmp(face, "wall/", 5) && (!strcmp(last, "/in") || !strcmp(last, "/out"))) return;
        if ((!strncmp(face, "floor/", 6) || !strncmp(face, "ceiling/", 8)) && last == strchr(face, '/')) return;
    }
}

static inline void add_face_place(const struct expected *t, char *line, const char *face, double least)
{
    char item[NAME_SIZE] = "";
    if (!strncmp(face, "wall/", 5)) snprintf(item, sizeof item, "%.*s", (int)strcspn(face + 5, "/"), face + 5);
    const int wall = expected_wall(t, item);
    double s[2] = {uniform(0, 3), 0};
    if (wall >= 0) random_place(t, wall, s);
    const double z = uniform(0, 2), width = uniform(least, 2), height = uniform(least, 2);
    if (wall >= 0 && one_of(3) == 0)
        add_words(line, " at %s %.2f width %.2f from %.2f to %.2f", one_of(2) ? "left" : "right", uniform(0, 1), width,
                  z, z + height);
    else
        add_words(line, " from %.2f %.2f to %.2f %.2f", s[0], z, s[0] + width, z + height);
}

static inline void add_colour(char *line)
{
    add_words(line, " %.2f %.2f %.2f", uniform(0, 1), uniform(0, 1), uniform(0, 1));
}

static inline void colour_statement(const struct expected *t, const struct solid_mesh *base, char *line)
{
    char face[FACE_SIZE];
    some_face(t, base, face);
    char *slash = strchr(face, '/'), *last = strrchr(face, '/');
    if (last != slash && one_of(3) == 0) *last = '\0'; /* all parts */
    snprintf(line, LINE, "colour %s", face);
    add_colour(line);
}

static inline void paint_statement(const struct expected *t, const struct solid_mesh *base, char *line)
{
    char face[FACE_SIZE];
    some_placed_face(t, base, face);
    snprintf(line, LINE, "paint %s", face);
    if (one_of(4)) add_face_place(t, line, face, 0.05);
    add_colour(line);
}

/* Lamps, gloss and objects. */
static inline void light_statement(const struct expected *t, const struct solid_mesh *base, char *line)
{
    static const char *const names[] = {"a", "b", "c"};
    const char *name = names[one_of(3)];
    char face[FACE_SIZE];
    switch (one_of(6)) {
    case 0:
        snprintf(line, LINE, "lamp %s off", name);
        break;
    case 1:
        snprintf(line, LINE, "lamp %s scale %.2f %.2f %.2f", name, uniform(0, 2), uniform(0, 2), uniform(0, 2));
        break;
    case 2:
    case 3:
        some_face(t, base, face);
        if (strrchr(face, '/') != strchr(face, '/') && one_of(3) == 0) *strrchr(face, '/') = '\0'; /* all parts */
        snprintf(line, LINE, "material %s ", face);
        if (one_of(3))
            add_words(line, "ward %.3f %.2f", uniform(0, 0.2), uniform(0.02, 1));
        else
            add_words(line, one_of(2) ? "matt" : "phong 0.01 20");
        break;
    case 4:
        snprintf(line, LINE, "remove object %s", name);
        break;
    default:
        snprintf(line, LINE, "object %s x.obj at %.2f 0 0 matt 0.5 0.5 0.5", name, uniform(-3, 3));
    }
}

static inline void copy_statement(const struct expected *t, const struct solid_mesh *base, char *line)
{
    char face[FACE_SIZE];
    some_placed_face(t->unedited, base, face);
    snprintf(line, LINE, "copy texture %s", face);
    add_face_place(t->unedited, line, face, 0.1);
    const bool whole = one_of(2);
    if (whole)
        some_face(t, base, face);
    else
        some_placed_face(t, base, face);
    add_words(line, " to %s", face);
    if (!whole) add_face_place(t, line, face, 0.05);
}

static inline void zone_statement(const struct expected *t, char *line)
{
    const int kind = one_of(4);
    if (kind == 0)
        snprintf(line, LINE, "clear all");
    else if (kind == 1)
        snprintf(line, LINE, "clear %s", some_room(t));
    else
        snprintf(line, LINE, "%s from %.2f %.2f to %.2f %.2f", kind == 2 ? "clear" : "keep", uniform(-1, 3),
                 uniform(-1, 3), uniform(3, 6), uniform(3, 6));
    if (one_of(4) == 0) add_words(line, " foot %.2f", uniform(-0.5, 1));
    if (one_of(4) == 0) add_words(line, " top %.2f", uniform(0.5, 3));
}

/* base: the unedited model. */
static inline void texture_statement(const struct expected *t, const struct solid_mesh *base, char *line)
{
    switch (one_of(12)) {
    case 0:
    case 1:
        colour_statement(t, base, line);
        break;
    case 2:
    case 3:
    case 4:
        copy_statement(t, base, line);
        break;
    case 5:
        snprintf(line, LINE, "texture %s %s",
                 one_of(2)   ? some_thing(t)
                 : one_of(2) ? some_wall(t)
                             : some_room(t),
                 one_of(2) ? "stretch" : "crop");
        break;
    case 6:
        snprintf(line, LINE, "set colour");
        add_colour(line);
        break;
    case 7:
    case 8:
        paint_statement(t, base, line);
        break;
    case 9:
    case 10:
        light_statement(t, base, line);
        break;
    default:
        zone_statement(t, line);
    }
    add_words(line, "\n");
}

#endif
