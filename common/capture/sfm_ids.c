/* sfm_ids.c - ids of the records of a model, sorted so that references are found. */
#include "common/capture/sfm_ids.h"

#include <inttypes.h>
#include <stdlib.h>

#include "common/base/sort.h"
#include "common/capture/sfm_model_parts.h"

enum status id_list_add(struct id_list *l, int64_t id, int line, struct err *err)
{
    if (sfm_append(&l->rows, l->count, sizeof *l->rows, "ids", err)) return err->status;
    l->ascending = l->count == 0 || (l->ascending && l->rows[l->count - 1].id < id);
    l->rows[l->count] = (struct id_row){id, l->count, line};
    l->count++;
    return ST_OK;
}

static int compare_rows(const void *a, const void *b)
{
    const struct id_row *x = a, *y = b;
    return x->id != y->id ? (x->id < y->id ? -1 : 1) : (x->line > y->line) - (x->line < y->line);
}

enum status id_list_sort(struct id_list *l, const char *path, const char *what, struct err *err)
{
    if (l->count && !l->ascending) qsort(l->rows, (size_t)l->count, sizeof *l->rows, compare_rows);
    for (int i = 1; i < l->count; i++)
        if (l->rows[i - 1].id == l->rows[i].id)
            return l->rows[i].line
                       ? err_set(err, ST_DATA,
                                 "%s:%d: found %s %" PRId64 " a second time (first on line %d), wanted each id once.",
                                 path, l->rows[i].line, what, l->rows[i].id, l->rows[i - 1].line)
                       : err_set(err, ST_DATA, "%s has %s %" PRId64 " twice, wanted each id once.", path, what,
                                 l->rows[i].id);
    return ST_OK;
}

static bool row_is_below(const void *row, const void *id)
{
    return ((const struct id_row *)row)->id < *(const int64_t *)id;
}

struct id_row *id_list_row(const struct id_list *l, int64_t id)
{
    const int at = (int)sort_place(l->rows, (size_t)l->count, sizeof *l->rows, row_is_below, &id);
    return at < l->count && l->rows[at].id == id ? &l->rows[at] : NULL;
}

int id_list_find(const struct id_list *l, int64_t id)
{
    const struct id_row *row = id_list_row(l, id);
    return row ? row->idx : -1;
}

enum status sfm_sort_points(struct sfm_model *m, struct id_list *ids, const char *path, struct err *err)
{
    if (!ids->count || ids->ascending) return ST_OK;
    if (id_list_sort(ids, path, "point", err)) return err->status;
    struct sfm_point *sorted = malloc((size_t)ids->count * sizeof *sorted);
    if (!sorted) return err_nomem(err, "points", (size_t)ids->count * sizeof *sorted);
    for (int i = 0; i < ids->count; i++) sorted[i] = m->points[ids->rows[i].idx];
    free(m->points);
    m->points = sorted;
    return ST_OK;
}

void id_list_release(struct id_list *l)
{
    free(l->rows);
    *l = (struct id_list){0};
}
