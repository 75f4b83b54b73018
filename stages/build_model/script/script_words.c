/* script_words.c - words, numbers, places, faces, lists and options of a statement. */
#include "stages/build_model/script/script_words.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"

static const char *const OPTIONS[OPTION_COUNT] = {"thickness", "foot",     "top",    "floor", "ceiling", "turn",
                                                  "at",        "left",     "right",  "front", "back",    "bottom",
                                                  "angled",    "interior", "closed", "open"};

static const char *const FILLINGS[FILL_COUNT] = {"nothing", "leaf", "glass", "wall"};

const char *script_option_name(enum option option) { return OPTIONS[option]; }

const char *script_filling_name(enum filling filling) { return FILLINGS[filling]; }

enum status script_usage_error(struct script_reader *r, const char *found)
{
    return textfile_error(&r->t, r->err, found, "%s, in a line \"%s\"", found ? "something else" : "more words",
                          r->verb->usage);
}

const char *script_keep_word(struct script_reader *r, const char *word)
{
    const size_t size = strlen(word) + 1;
    char *kept = r->words + r->used;
    memcpy(kept, word, size);
    r->used += size;
    return kept;
}

const char *script_next_word(const struct script_reader *r) { return r->t.cursor + strspn(r->t.cursor, " \t"); }

bool script_next_is(const struct script_reader *r, const char *word)
{
    const char *next = script_next_word(r);
    const size_t length = strlen(word);
    return !strncmp(next, word, length) && (!next[length] || strchr(" \t\r", next[length]));
}

enum status script_read_name(struct script_reader *r, const char *what, const char **name)
{
    char *word;
    if (textfile_word(&r->t, what, &word, r->err)) return r->err->status;
    if (!scan_is_name(word))
        return textfile_error(&r->t, r->err, word, "%s: a name of at most %d letters, digits, _ and -, not a number",
                              what, SCAN_NAME);
    *name = script_keep_word(r, word);
    return ST_OK;
}

enum status script_read_number(struct script_reader *r, const char *what, double *value)
{
    if (textfile_double(&r->t, what, value, r->err)) return r->err->status;
    if (fabs(*value) <= MAX_NUMBER) return ST_OK;
    char text[32];
    snprintf(text, sizeof text, "%.9g", *value);
    return textfile_error(&r->t, r->err, text, "%s within 1e6", what);
}

enum status script_expect(struct script_reader *r, const char *wanted)
{
    char *word;
    if (!textfile_more(&r->t)) return script_usage_error(r, NULL);
    if (textfile_word(&r->t, wanted, &word, r->err)) return r->err->status;
    if (!strcmp(word, wanted)) return ST_OK;
    return textfile_error(&r->t, r->err, word, "\"%s\", in a line \"%s\"", wanted, r->verb->usage);
}

/* ------------------------------------------------------------------------------------------------------------ parts */

static enum status read_view(struct script_reader *r, const char **view)
{
    char *word;
    if (textfile_word(&r->t, "a photo or view", &word, r->err)) return r->err->status;
    *view = script_keep_word(r, word);
    return ST_OK;
}

static enum status read_pixels(struct script_reader *r, struct script_place *p, enum place_kind kind)
{
    static const char *const what[] = {"x0", "y0", "x1", "y1"};
    p->kind = kind;
    if (read_view(r, &p->view)) return r->err->status;
    for (int i = 0; i < 4; i++)
        if (script_read_number(r, what[i], &p->a[i])) return r->err->status;
    return ST_OK;
}

static enum status read_rectangle(struct script_reader *r, struct script_place *p)
{
    if (read_pixels(r, p, PLACE_VIEW)) return r->err->status;
    if (p->a[2] > p->a[0] && p->a[3] > p->a[1]) return ST_OK;
    return err_set(r->err, ST_DATA,
                   "%s:%d: found the rectangle %.9g %.9g %.9g %.9g, wanted X0 Y0 its upper left corner and X1 Y1 its "
                   "lower right one, in pixels of the photo as it is stored.",
                   r->t.path, r->t.line, p->a[0], p->a[1], p->a[2], p->a[3]);
}

/* The line where a wall meets the floor or the ceiling. */
static enum status read_line(struct script_reader *r, struct script_place *p, enum place_kind kind)
{
    if (script_expect(r, "in") || read_pixels(r, p, kind)) return r->err->status;
    if (p->a[0] != p->a[2] || p->a[1] != p->a[3]) return ST_OK;
    return err_set(r->err, ST_DATA, "%s:%d: found the pixel %.9g %.9g of %s twice, wanted two pixels of a line.",
                   r->t.path, r->t.line, p->a[0], p->a[1], p->view);
}

static enum status read_from_end(struct script_reader *r, struct script_place *p)
{
    char *side;
    p->kind = PLACE_FROM_END;
    if (textfile_word(&r->t, "\"left\" or \"right\"", &side, r->err)) return r->err->status;
    p->right = !strcmp(side, "right");
    if (!p->right && strcmp(side, "left"))
        return textfile_error(&r->t, r->err, side, "\"left\" or \"right\": the end of the wall to measure from");
    if (script_read_number(r, "the distance from that end", &p->a[0]) || script_expect(r, "width") ||
        script_read_number(r, "the width", &p->a[1]) || script_expect(r, "from") ||
        script_read_number(r, "the height of the sill", &p->a[2]) || script_expect(r, "to") ||
        script_read_number(r, "the height of the head", &p->a[3]))
        return r->err->status;
    return ST_OK;
}

static enum status read_parallel(struct script_reader *r, struct script_place *p)
{
    p->kind = PLACE_PARALLEL;
    if (script_expect(r, "to") || script_read_name(r, "a wall", &p->wall) || script_expect(r, "by") ||
        script_read_number(r, "the distance from that wall", &p->a[0]) || script_expect(r, "between") ||
        script_read_name(r, "the wall at one end", &p->between[0]) ||
        script_read_name(r, "the wall at the other end", &p->between[1]))
        return r->err->status;
    return ST_OK;
}

enum status script_read_place(struct script_reader *r, struct script_place *p, unsigned more)
{
    char *word;
    if (!textfile_more(&r->t)) return script_usage_error(r, NULL);
    if (textfile_word(&r->t, "\"in\" or \"from\"", &word, r->err)) return r->err->status;
    if (!strcmp(word, "in")) return read_rectangle(r, p);
    if (!strcmp(word, "at") && more & 1u << PLACE_FROM_END) return read_from_end(r, p);
    if (!strcmp(word, "parallel") && more & 1u << PLACE_PARALLEL) return read_parallel(r, p);
    if (!strcmp(word, "foot") && more & 1u << PLACE_FOOT) return read_line(r, p, PLACE_FOOT);
    if (!strcmp(word, "top") && more & 1u << PLACE_TOP) return read_line(r, p, PLACE_TOP);
    if (strcmp(word, "from"))
        return textfile_error(&r->t, r->err, word, "\"in VIEW\" or \"from\", in a line \"%s\"", r->verb->usage);
    p->kind = PLACE_COORDINATES;
    if (script_read_number(r, "a coordinate", &p->a[0]) || script_read_number(r, "a coordinate", &p->a[1]) ||
        script_expect(r, "to") || script_read_number(r, "a coordinate", &p->a[2]) ||
        script_read_number(r, "a coordinate", &p->a[3]))
        return r->err->status;
    return ST_OK;
}

enum status script_read_along(struct script_reader *r, struct script_place *p)
{
    if (!script_next_is(r, "along")) return ST_OK;
    return script_expect(r, "along") || script_read_name(r, "x, y or a wall", &p->along) ? r->err->status : ST_OK;
}

enum status script_read_corners(struct script_reader *r, struct statement *s)
{
    while (script_next_is(r, "corner")) {
        if (array_append(&s->corners, (size_t)s->corner_count, sizeof *s->corners, "corners", r->err))
            return r->err->status;
        struct script_corner *c = &s->corners[s->corner_count++];
        if (script_expect(r, "corner") || script_expect(r, "in") || read_view(r, &c->view) ||
            script_read_number(r, "x", &c->x) || script_read_number(r, "y", &c->y))
            return r->err->status;
    }
    return s->corner_count < 2 ? script_usage_error(r, NULL) : ST_OK;
}

/* The names of all options that the verb has. */
static const char *verb_option(const void *ctx, int i)
{
    const struct verb *v = ctx;
    for (int o = 0, n = 0; o < OPTION_COUNT; o++)
        if (v->options & 1u << o && n++ == i) return OPTIONS[o];
    return NULL;
}

/* An option and its number come next. */
static bool option_is_next(const struct script_reader *r)
{
    const char *next = script_next_word(r);
    for (int o = 0; o < OPTION_ANGLED; o++) {
        const size_t length = strlen(OPTIONS[o]);
        if (r->verb->options & 1u << o && !strncmp(next, OPTIONS[o], length) &&
            (next[length] == ' ' || next[length] == '\t'))
            return true;
    }
    return false;
}

enum status script_read_list(struct script_reader *r, struct statement *s, int min_count)
{
    while (textfile_more(&r->t) && !option_is_next(r)) {
        if (array_append(&s->names, (size_t)s->name_count, sizeof *s->names, "names of walls", r->err) ||
            script_read_name(r, "a wall", &s->names[s->name_count]))
            return r->err->status;
        s->name_count++;
    }
    return s->name_count < min_count ? script_usage_error(r, NULL) : ST_OK;
}

enum status script_read_face(struct script_reader *r, const char **name)
{
    static const char wanted[] = "a face, such as wall/south/in (docs/model-script.md lists their names)";
    char *word;
    if (textfile_word(&r->t, wanted, &word, r->err)) return r->err->status;
    for (const char *c = word; *c; c++)
        if ((unsigned char)*c <= ' ' || *c == '#' || *c == '"') return textfile_error(&r->t, r->err, word, wanted);
    if (strlen(word) > 2 * SCAN_NAME || !strchr(word, '/')) return textfile_error(&r->t, r->err, word, wanted);
    *name = script_keep_word(r, word);
    return ST_OK;
}

enum status script_read_colour(struct script_reader *r, struct statement *s)
{
    static const char *const what[] = {"a share of red light", "a share of green light", "a share of blue light"};
    for (int i = 0; i < 3; i++) {
        if (script_read_number(r, what[i], &s->values[i])) return r->err->status;
        if (!(s->values[i] >= 0 && s->values[i] <= 1))
            return textfile_wrong_number(&r->t, s->values[i], "a share of light, from 0 to 1", r->err);
    }
    s->value_count = 3;
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- options */

static enum status unknown_option(struct script_reader *r, const char *word)
{
    const char *near = scan_nearest(word, verb_option, r->verb);
    if (near)
        return textfile_error(&r->t, r->err, word,
                              "the end of the line or an option; did you mean %s? The line is \"%s\"", near,
                              r->verb->usage);
    return textfile_error(&r->t, r->err, word, "the end of the line or an option, in a line \"%s\"", r->verb->usage);
}

enum status script_read_options(struct script_reader *r, struct statement *s)
{
    while (textfile_more(&r->t)) {
        char *word;
        int o = 0;
        if (textfile_word(&r->t, "an option", &word, r->err)) return r->err->status;
        while (o < OPTION_COUNT && !(r->verb->options & 1u << o && !strcmp(word, OPTIONS[o]))) o++;
        if (o == OPTION_COUNT) return unknown_option(r, word);
        if (s->has_option[o]) return textfile_error(&r->t, r->err, word, "each option once");
        if (o < OPTION_ANGLED && script_read_number(r, OPTIONS[o], &s->options[o])) return r->err->status;
        s->has_option[o] = true;
    }
    return ST_OK;
}
