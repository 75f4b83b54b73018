/* split_grid.c - the layout of the pictures of a multi-lens camera in its photograph.
 *
 * The rules are in split_grid.h. Columns and rows are treated alike: a column is dark if few of its samples are
 * brighter than the threshold; dark runs near the positions of an even division are the borders of pictures. */
#include "stages/import_photos/split_grid.h"

#include <stdbool.h>
#include <stdlib.h>

enum { MAX_BRIGHT = 50, MAX_SHIFT = 8, MAX_UNEQUAL = 16 }; /* 1 in so many: samples of a line, of a picture */

enum status split_grid_parse(struct split_grid *g, const char *text, const struct photo_params *params, struct err *err)
{
    struct split_size size;
    split_size_parse(&size, text, err);
    *g = (struct split_grid){size.columns, size.rows, params->split_border, params->split_gap, params->split_dark};
    return err->status;
}

/* One direction of the photo: its columns or its rows. */
struct direction {
    const char *what; /* "columns" or "rows" */
    const char *name; /* of the photo */
    int size, count;  /* pixels, pictures */
    bool *dark;       /* of each column or row; NULL: not determined */
};

static enum status too_small(const struct direction *s, int size, struct err *err)
{
    return err_set(err, ST_DATA,
                   "%s: cutting its %d px into %d %s leaves %d px for a picture, wanted at least %d; correct SPLIT, or "
                   "[import_photos] split_border, split_gap, split_dark.",
                   s->name, s->size, s->count, s->what, size < 0 ? 0 : size, MIN_SPLIT_SIDE);
}

static enum status divide_evenly(int *size, int *starts, int *over, const struct direction *s, int border, int gap,
                                 struct err *err)
{
    const int inner = s->size - 2 * border + gap; /* as if the last picture were followed by a gap, too */
    *size = inner / s->count - gap;
    if (*size < MIN_SPLIT_SIDE) return too_small(s, *size, err);
    for (int i = 0; i < s->count; i++) starts[i] = border + (int)((int64_t)i * inner / s->count);
    *over = inner % s->count;
    return ST_OK;
}

/* Moves *at to the next dark column, *past behind its run. False: there is none before `end`. */
static bool next_line(const struct direction *s, int *at, int *past, int end)
{
    while (*at < end && !s->dark[*at]) ++*at;
    for (*past = *at; *past < s->size && s->dark[*past];) ++*past;
    return *at < end;
}

static enum status divide_by_lines(int *size, int *starts, int *over, const struct direction *s, struct err *err)
{
    int ends[MAX_SPLIT], first = 0, last = s->size, min = s->size, max = 0;
    while (first < s->size && s->dark[first]) first++;
    while (last > first && s->dark[last - 1]) last--;
    starts[0] = first;
    ends[s->count - 1] = last;
    const int pitch = (last - first) / s->count;
    if (pitch < MIN_SPLIT_SIDE) return too_small(s, pitch, err);
    for (int i = 1; i < s->count; i++) {
        const int middle = first + (int)((int64_t)i * (last - first) / s->count), reach = pitch / MAX_SHIFT;
        int widest = 0, at = middle - reach, past = 0;
        while (at > 0 && s->dark[at] && s->dark[at - 1]) at--; /* to the beginning of the run */
        for (; next_line(s, &at, &past, middle + reach); at = past)
            if (past - at > widest) {
                widest = past - at;
                ends[i - 1] = at;
                starts[i] = past;
            }
        if (!widest)
            return err_set(err, ST_DATA,
                           "%s: %s %d to %d contain no dark line between pictures %d and %d; raise [import_photos] "
                           "split_dark, or set it to 0 and give split_border and split_gap.",
                           s->name, s->what, middle - reach, middle + reach - 1, i, i + 1);
    }
    for (int i = 0; i < s->count; i++) {
        const int width = ends[i] - starts[i];
        if (width < min) min = width;
        if (width > max) max = width;
    }
    if (min < MIN_SPLIT_SIDE) return too_small(s, min, err);
    if ((max - min) * MAX_UNEQUAL > max)
        return err_set(
            err, ST_DATA,
            "%s: the pictures between the dark lines are %d to %d %s wide, wanted equal widths; correct SPLIT or "
            "[import_photos] split_dark, or set split_dark to 0 and give split_border and split_gap.",
            s->name, min, max, s->what);
    *size = min;
    *over = 0;
    for (int i = 0; i < s->count; i++) starts[i] += (ends[i] - starts[i] - min) / 2;
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
        rows[y] = (int64_t)bright_in_row * MAX_BRIGHT <= width;
    }
    for (int x = 0; x < width; x++) columns[x] = (int64_t)bright_in_column[x] * MAX_BRIGHT <= height;
}

enum status split_layout_find(struct split_layout *l, const struct split_grid *g, const struct photo *p,
                              const char *name, struct err *err)
{
    struct direction across = {"columns", name, p->info.width, g->columns, NULL};
    struct direction down = {"rows", name, p->info.height, g->rows, NULL};
    *l = (struct split_layout){0};
    if (!g->dark)
        return divide_evenly(&l->width, l->x, &l->over_width, &across, g->border, g->gap, err) ||
                       divide_evenly(&l->height, l->y, &l->over_height, &down, g->border, g->gap, err)
                   ? err->status
                   : ST_OK;
    int *bright = calloc((size_t)across.size, sizeof *bright);
    across.dark = calloc((size_t)across.size, sizeof *across.dark);
    down.dark = calloc((size_t)down.size, sizeof *down.dark);
    if (bright && across.dark && down.dark) {
        find_dark(across.dark, down.dark, bright, p, g->dark);
        if (!divide_by_lines(&l->width, l->x, &l->over_width, &across, err))
            divide_by_lines(&l->height, l->y, &l->over_height, &down, err);
    } else {
        err_nomem(err, "a photo's lines", (size_t)across.size * sizeof *bright);
    }
    free(bright);
    free(across.dark);
    free(down.dark);
    return err->status;
}
