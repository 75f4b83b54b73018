/* metric_rows.c - see metric_rows.h. */
#include "stages/report/metric_rows.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/textfile.h"

static enum status read_row(struct metric_rows *r, struct textfile *t, bool of_views, struct err *err)
{
    struct metric_row m = {0};
    char *view = NULL;
    if (array_append(&r->rows, (size_t)r->count, sizeof *r->rows, "metrics", err) ||
        (of_views && textfile_word(t, "view", &view, err)) ||
        textfile_word_into(t, "metric", m.name, sizeof m.name, err) || textfile_double(t, "value", &m.value, err) ||
        textfile_word_into(t, "unit", m.unit, sizeof m.unit, err) ||
        textfile_word_into(t, "direction", m.direction, sizeof m.direction, err) || textfile_end(t, err))
        return err->status;
    if (!(m.view = strdup(view ? view : ""))) return err_nomem(err, "metrics", sizeof m);
    r->rows[r->count++] = m;
    return ST_OK;
}

/* Keeps the text of a comment that is for the page. */
static enum status read_note(struct metric_rows *r, const char *text, struct err *err)
{
    if (strncmp(text, "# skipped ", 10) && strncmp(text, "# note: ", 8)) return ST_OK;
    if (array_append(&r->notes, (size_t)r->note_count, sizeof *r->notes, "notes", err)) return err->status;
    char *note = strdup(text + (text[2] == 'n' ? 8 : 2));
    if (!note) return err_nomem(err, "a note", strlen(text));
    r->notes[r->note_count++] = note;
    return ST_OK;
}

enum status metric_rows_read(struct metric_rows *r, const char *path, bool of_views, struct err *err)
{
    struct textfile t = {0};
    *r = (struct metric_rows){0};
    textfile_open(&t, path, err);
    while (!err->status && textfile_next_raw(&t)) {
        if (t.cursor[0] == '#')
            read_note(r, t.cursor, err);
        else if (textfile_more(&t))
            read_row(r, &t, of_views, err);
    }
    textfile_release(&t);
    if (err->status) metric_rows_release(r);
    return err->status;
}

const struct metric_row *metric_rows_find(const struct metric_rows *r, const char *view, const char *name)
{
    for (int i = 0; i < r->count; i++)
        if (!strcmp(r->rows[i].view, view) && !strcmp(r->rows[i].name, name)) return &r->rows[i];
    return NULL;
}

void metric_rows_release(struct metric_rows *r)
{
    for (int i = 0; i < r->count; i++) free(r->rows[i].view);
    for (int i = 0; i < r->note_count; i++) free(r->notes[i]);
    free(r->rows);
    free(r->notes);
    *r = (struct metric_rows){0};
}
