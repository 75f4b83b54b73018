/* split_grid.c - see split_grid.h. */
#include "stages/import_photos/split_grid.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BRIGHT_PART = 50, REACH_PART = 8, UNEQUAL_PART = 16 };

enum status split_grid_parse(struct split_grid *g, const char *text, const struct import_params *params,
                             struct err *err)
{
    const bool digits = strspn(text, "0123456789x") == strlen(text) && text[0] != '0' && !strstr(text, "x0");
    int end = 0;
    *g = (struct split_grid){0, 0, params->split_border, params->split_gap, params->split_dark};
    if (!digits || strlen(text) > 5 || sscanf(text, "%dx%d%n", &g->columns, &g->rows, &end) != 2 || text[end] ||
        g->columns > SPLIT_MOST || g->rows > SPLIT_MOST)
        return err_set(
            err, ST_USAGE,
            "--split %.40s: wanted COLUMNSxROWS, such as 3x2: how many pictures a photo holds, 1 to %d a side.", text,
            SPLIT_MOST);
    if (g->columns * g->rows == 1)
        return err_set(err, ST_USAGE,
                       "--split 1x1 cuts nothing; leave it out, or say how many pictures a photo holds.");
    return ST_OK;
}

/* One side of the photo: columns, or rows. */
struct side {
    const char *what; /* "columns" or "rows" */
    const char *name; /* the photo's */
    int size, count;  /* pixels, pictures */
    bool *dark;       /* of each column or row; NULL: not looked for */
};

static enum status too_small(const struct side *s, int size, struct err *err)
{
    return err_set(err, ST_DATA,
                   "%s: cutting its %d px into %d %s leaves %d px for a picture, wanted %d at least; mend SPLIT, or "
                   "[import_photos] split_border, split_gap, split_dark.",
                   s->name, s->size, s->count, s->what, size < 0 ? 0 : size, SPLIT_SIDE_LEAST);
}

static enum status divide_evenly(int *size, int *starts, int *over, const struct side *s, int border, int gap,
                                 struct err *err)
{
    const int inner = s->size - 2 * border + gap; /* a gap behind the last picture as behind the others */
    *size = inner / s->count - gap;
    if (*size < SPLIT_SIDE_LEAST) return too_small(s, *size, err);
    for (int i = 0; i < s->count; i++) starts[i] = border + (int)((int64_t)i * inner / s->count);
    *over = inner % s->count;
    return ST_OK;
}

/* The run of dark columns around or next behind `at`; false: there is none before `end`. */
static bool next_line(const struct side *s, int *at, int *past, int end)
{
    while (*at < end && !s->dark[*at]) ++*at;
    for (*past = *at; *past < s->size && s->dark[*past];) ++*past;
    return *at < end;
}

static enum status divide_by_lines(int *size, int *starts, int *over, const struct side *s, struct err *err)
{
    int ends[SPLIT_MOST], first = 0, last = s->size, least = s->size, most = 0;
    while (first < s->size && s->dark[first]) first++;
    while (last > first && s->dark[last - 1]) last--;
    starts[0] = first;
    ends[s->count - 1] = last;
    const int pitch = (last - first) / s->count;
    if (pitch < SPLIT_SIDE_LEAST) return too_small(s, pitch, err);
    for (int i = 1; i < s->count; i++) {
        const int middle = first + (int)((int64_t)i * (last - first) / s->count), reach = pitch / REACH_PART;
        int widest = 0, at = middle - reach, past = 0;
        while (at > 0 && s->dark[at] && s->dark[at - 1]) at--; /* its beginning */
        for (; next_line(s, &at, &past, middle + reach); at = past)
            if (past - at > widest) {
                widest = past - at;
                ends[i - 1] = at;
                starts[i] = past;
            }
        if (!widest)
            return err_set(err, ST_DATA,
                           "%s: %s %d to %d hold no dark line, which parts pictures %d and %d; raise [import_photos] "
                           "split_dark, or set it to 0 and say split_border and split_gap.",
                           s->name, s->what, middle - reach, middle + reach - 1, i, i + 1);
    }
    for (int i = 0; i < s->count; i++) {
        const int place = ends[i] - starts[i];
        if (place < least) least = place;
        if (place > most) most = place;
    }
    if (least < SPLIT_SIDE_LEAST) return too_small(s, least, err);
    if ((most - least) * UNEQUAL_PART > most)
        return err_set(
            err, ST_DATA,
            "%s: between the dark lines pictures are %d to %d %s wide, which are no equal pictures; mend SPLIT "
            "or [import_photos] split_dark, or set that to 0 and say split_border and split_gap.",
            s->name, least, most, s->what);
    *size = least;
    *over = 0;
    for (int i = 0; i < s->count; i++) starts[i] += (ends[i] - starts[i] - least) / 2;
    return ST_OK;
}

static void find_dark(bool *columns, bool *rows, int *bright_in_column, const struct photo *p, int dark)
{
    const int width = p->info.width, height = p->info.height, limit = p->info.bits == 16 ? dark * 257 : dark;
    for (int y = 0; y < height; y++) {
        const uint16_t *s = p->samples + (size_t)y * (size_t)width * 3;
        int bright_in_row = 0;
        for (int x = 0; x < width; x++, s += 3) {
            const int bright = s[0] > limit || s[1] > limit || s[2] > limit;
            bright_in_row += bright;
            bright_in_column[x] += bright;
        }
        rows[y] = (int64_t)bright_in_row * BRIGHT_PART <= width;
    }
    for (int x = 0; x < width; x++) columns[x] = (int64_t)bright_in_column[x] * BRIGHT_PART <= height;
}

enum status split_layout_find(struct split_layout *l, const struct split_grid *g, const struct photo *p,
                              const char *name, struct err *err)
{
    struct side across = {"columns", name, p->info.width, g->columns, NULL};
    struct side down = {"rows", name, p->info.height, g->rows, NULL};
    *l = (struct split_layout){0};
    if (!g->dark) {
        enum status st = divide_evenly(&l->width, l->x, &l->over_width, &across, g->border, g->gap, err);
        return st ? st : divide_evenly(&l->height, l->y, &l->over_height, &down, g->border, g->gap, err);
    }
    int *bright = calloc((size_t)across.size, sizeof *bright);
    across.dark = calloc((size_t)across.size, sizeof *across.dark);
    down.dark = calloc((size_t)down.size, sizeof *down.dark);
    enum status st = bright && across.dark && down.dark
                         ? ST_OK
                         : err_nomem(err, "a photo's lines", (size_t)across.size * sizeof *bright);
    if (!st) find_dark(across.dark, down.dark, bright, p, g->dark);
    if (!st) st = divide_by_lines(&l->width, l->x, &l->over_width, &across, err);
    if (!st) st = divide_by_lines(&l->height, l->y, &l->over_height, &down, err);
    free(bright);
    free(across.dark);
    free(down.dark);
    return st;
}
