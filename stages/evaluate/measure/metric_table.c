/* metric_table.c - see metric_table.h. */
#include "stages/evaluate/measure/metric_table.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/outfile.h"

enum status metric_add(struct metric_table *t, const char *view, const char *name, double value, struct err *err)
{
    struct metric_kind kind;
    if (!isfinite(value)) return err_set(err, ST_INTERNAL, "the metric %s has no finite value.", name);
    if (!metric_kind_find(&kind, name))
        return err_set(err, ST_INTERNAL, "the metric %s is not declared in metric_kinds.def.", name);
    if (array_append(&t->metrics, (size_t)t->count, sizeof *t->metrics, "metrics", err)) return err->status;
    struct metric *m = &t->metrics[t->count];
    *m = (struct metric){.view = strdup(view ? view : ""), .value = value, .kind = kind};
    snprintf(m->name, sizeof m->name, "%s", name);
    if (!m->view) return err_nomem(err, "metrics", sizeof *m);
    t->count++;
    return ST_OK;
}

enum status metric_note(struct metric_table *t, struct err *err, const char *fmt, ...)
{
    char text[1024];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    for (char *p = text; *p; p++)
        if (*p == '\n' || *p == '\r') *p = ' ';
    if (array_append(&t->notes, (size_t)t->note_count, sizeof *t->notes, "notes", err)) return err->status;
    if (!(t->notes[t->note_count] = strdup(text))) return err_nomem(err, "a note", strlen(text));
    t->note_count++;
    return ST_OK;
}

static int compare_metrics(const void *a, const void *b)
{
    const struct metric *x = a, *y = b;
    int order = strcmp(x->view, y->view);
    return order ? order : strcmp(x->name, y->name);
}

enum status metric_table_write(struct metric_table *t, bool of_views, const char *path, const struct provenance *prov,
                               struct err *err)
{
    struct outfile f = {0};
    if (!outfile_open(&f, path, err)) {
        if (prov) provenance_print(prov, f.fp);
        for (int i = 0; !of_views && i < t->note_count; i++) fprintf(f.fp, "# %s\n", t->notes[i]);
        fprintf(f.fp, "# %sname\tvalue\tunit\tdirection\n", of_views ? "view\t" : "");
        if (t->count) qsort(t->metrics, (size_t)t->count, sizeof *t->metrics, compare_metrics);
        for (int i = 0; i < t->count; i++) {
            const struct metric *m = &t->metrics[i];
            if (of_views != (m->view[0] != 0)) continue;
            if (of_views) fprintf(f.fp, "%s\t", m->view);
            fprintf(f.fp, "%s\t%.9g\t%s\t%s\n", m->name, m->value + 0.0, m->kind.unit, m->kind.direction);
        }
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

void metric_table_release(struct metric_table *t)
{
    for (int i = 0; i < t->count; i++) free(t->metrics[i].view);
    for (int i = 0; i < t->note_count; i++) free(t->notes[i]);
    free(t->metrics);
    free(t->notes);
    *t = (struct metric_table){0};
}
