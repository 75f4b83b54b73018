/* script_words.c - words, numbers, places, lists and options of a statement. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "stages/build_model/script_internal.h"

enum status script_usage_error(struct script_reader *r, const char *found, enum verb verb)
{
    return textfile_error(&r->t, r->err, found, "%s, in a line \"%s\"", found ? "something else" : "more words",
                          script_grammar[verb].usage);
}

const char *script_keep_word(struct script_reader *r, const char *word)
{
    const size_t size = strlen(word) + 1;
    char *kept = r->words + r->used;
    memcpy(kept, word, size);
    r->used += size;
    return kept;
}

bool script_is_name(const char *word)
{
    const size_t length = strlen(word);
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    double number;
    return length && length <= MAX_NAME && word[0] != '-' && strspn(word, letters) == length &&
           !scan_double(word, &number);
}

enum status script_read_name(struct script_reader *r, const char *what, const char **name)
{
    char *word;
    if (textfile_word(&r->t, what, &word, r->err)) return r->err->status;
    if (!script_is_name(word))
        return textfile_error(&r->t, r->err, word, "%s: a name of at most %d letters, digits, _ and -, not a number",
                              what, MAX_NAME);
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

enum status script_expect(struct script_reader *r, const char *wanted, enum verb verb)
{
    char *word;
    if (!textfile_more(&r->t)) return script_usage_error(r, NULL, verb);
    if (textfile_word(&r->t, wanted, &word, r->err)) return r->err->status;
    if (!strcmp(word, wanted)) return ST_OK;
    return textfile_error(&r->t, r->err, word, "\"%s\", in a line \"%s\"", wanted, script_grammar[verb].usage);
}

/* ------------------------------------------------------------------------------------------------------------ parts */

static enum status read_rectangle(struct script_reader *r, struct script_place *p)
{
    static const char *const what[] = {"x0", "y0", "x1", "y1"};
    char *view;
    if (textfile_word(&r->t, "a photo or view", &view, r->err)) return r->err->status;
    p->kind = PLACE_VIEW;
    p->view = script_keep_word(r, view);
    for (int i = 0; i < 4; i++)
        if (script_read_number(r, what[i], &p->a[i])) return r->err->status;
    if (p->a[2] > p->a[0] && p->a[3] > p->a[1]) return ST_OK;
    return err_set(r->err, ST_DATA,
                   "%s:%d: found the rectangle %.9g %.9g %.9g %.9g, wanted X0 Y0 its upper left corner and X1 Y1 its "
                   "lower right one, in pixels of the photo as it is stored.",
                   r->t.path, r->t.line, p->a[0], p->a[1], p->a[2], p->a[3]);
}

static enum status read_from_end(struct script_reader *r, struct script_place *p, enum verb verb)
{
    char *side;
    p->kind = PLACE_FROM_END;
    if (textfile_word(&r->t, "\"left\" or \"right\"", &side, r->err)) return r->err->status;
    p->right = !strcmp(side, "right");
    if (!p->right && strcmp(side, "left"))
        return textfile_error(&r->t, r->err, side, "\"left\" or \"right\": the end of the wall to measure from");
    if (script_read_number(r, "the distance from that end", &p->a[0]) || script_expect(r, "width", verb) ||
        script_read_number(r, "the width", &p->a[1]) || script_expect(r, "from", verb) ||
        script_read_number(r, "the height of the sill", &p->a[2]) || script_expect(r, "to", verb) ||
        script_read_number(r, "the height of the head", &p->a[3]))
        return r->err->status;
    return ST_OK;
}

static enum status read_parallel(struct script_reader *r, struct script_place *p, enum verb verb)
{
    p->kind = PLACE_PARALLEL;
    if (script_expect(r, "to", verb) || script_read_name(r, "a wall", &p->wall) || script_expect(r, "by", verb) ||
        script_read_number(r, "the distance from that wall", &p->a[0]) || script_expect(r, "between", verb) ||
        script_read_name(r, "the wall at one end", &p->between[0]) ||
        script_read_name(r, "the wall at the other end", &p->between[1]))
        return r->err->status;
    return ST_OK;
}

enum status script_read_place(struct script_reader *r, struct script_place *p, enum verb verb)
{
    char *word;
    if (!textfile_more(&r->t)) return script_usage_error(r, NULL, verb);
    if (textfile_word(&r->t, "\"in\" or \"from\"", &word, r->err)) return r->err->status;
    if (!strcmp(word, "in")) return read_rectangle(r, p);
    if (!strcmp(word, "at") && verb != VERB_WALL && verb != VERB_BOX && verb != VERB_CLEAR && verb != VERB_KEEP)
        return read_from_end(r, p, verb);
    if (!strcmp(word, "parallel") && verb == VERB_WALL) return read_parallel(r, p, verb);
    if (strcmp(word, "from"))
        return textfile_error(&r->t, r->err, word, "\"in VIEW\" or \"from\", in a line \"%s\"",
                              script_grammar[verb].usage);
    p->kind = PLACE_COORDINATES;
    if (script_read_number(r, "a coordinate", &p->a[0]) || script_read_number(r, "a coordinate", &p->a[1]) ||
        script_expect(r, "to", verb) || script_read_number(r, "a coordinate", &p->a[2]) ||
        script_read_number(r, "a coordinate", &p->a[3]))
        return r->err->status;
    return ST_OK;
}

enum status script_read_list(struct script_reader *r, struct statement *s, int min_count, unsigned options)
{
    while (textfile_more(&r->t)) {
        char *before = r->t.cursor;
        for (int o = 0; o < OPTION_COUNT; o++) {
            const size_t length = strlen(option_name((enum option)o));
            const char *at = before + strspn(before, " \t");
            if (options & (1u << o) && !strncmp(at, option_name((enum option)o), length) &&
                (at[length] == ' ' || at[length] == '\t'))
                goto done;
        }
        if (array_append(&s->names, (size_t)s->name_count, sizeof *s->names, "names of walls", r->err) ||
            script_read_name(r, "a wall", &s->names[s->name_count]))
            return r->err->status;
        s->name_count++;
    }
done:
    return s->name_count < min_count ? script_usage_error(r, NULL, s->verb) : ST_OK;
}

static const char *known_flag_or_option(const void *ctx, int i)
{
    static const char *const flags[] = {"angled", "interior", "closed", "open", NULL};
    const struct script_grammar_row *g = ctx;
    int n = 0;
    for (int o = 0; o < OPTION_COUNT; o++)
        if (g->options & (1u << o) && n++ == i) return option_name((enum option)o);
    for (int f = 0; flags[f]; f++)
        if (strstr(g->flags, flags[f]) && n++ == i) return flags[f];
    return NULL;
}

enum status script_read_options(struct script_reader *r, struct statement *s)
{
    const struct script_grammar_row *g = &script_grammar[s->verb];
    while (textfile_more(&r->t)) {
        char *word, padded[32];
        if (textfile_word(&r->t, "an option", &word, r->err)) return r->err->status;
        int o = 0;
        while (o < OPTION_COUNT && !(g->options & (1u << o) && !strcmp(word, option_name((enum option)o)))) o++;
        if (o < OPTION_COUNT) {
            if (s->has_option[o]) return textfile_error(&r->t, r->err, word, "each option once");
            if (script_read_number(r, option_name((enum option)o), &s->options[o])) return r->err->status;
            s->has_option[o] = true;
            continue;
        }
        bool *flag = NULL;
        snprintf(padded, sizeof padded, " %.20s ", word);
        if (word[0] && strstr(g->flags, padded))
            flag = !strcmp(word, "angled")     ? &s->angled
                   : !strcmp(word, "interior") ? &s->interior
                   : !strcmp(word, "closed")   ? &s->closed
                                               : &s->open;
        if (!flag) {
            const char *near = scan_nearest(word, known_flag_or_option, g);
            if (near)
                return textfile_error(&r->t, r->err, word,
                                      "the end of the line or an option; did you mean %s? The line is \"%s\"", near,
                                      g->usage);
            return textfile_error(&r->t, r->err, word, "the end of the line or an option, in a line \"%s\"", g->usage);
        }
        if (*flag) return textfile_error(&r->t, r->err, word, "each option once");
        *flag = true;
    }
    return ST_OK;
}
