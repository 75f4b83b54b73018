/* contents_lens.c - the forms of lens that were compared, and the residuals of the photographs' cameras. */
#include "stages/report/contents_parts.h"

#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"

/* A number of 0 or more, or - for one that is unknown, which becomes -1. */
static enum status read_known(struct textfile *t, const char *what, double *value, struct err *err)
{
    char *word = NULL;
    *value = -1;
    if (textfile_word(t, what, &word, err)) return err->status;
    if (!strcmp(word, "-")) return ST_OK;
    return scan_double(word, value) && *value >= 0 ? ST_OK : textfile_error(t, err, word, "%s, 0 or more, or -", what);
}

static enum status read_form(struct contents *c, struct textfile *t, struct err *err)
{
    char *kind = NULL;
    double parameters;
    if (textfile_word(t, "form or shift", &kind, err)) return err->status;
    if (strcmp(kind, "form")) return ST_OK;
    if (array_append(&c->lens_forms, (size_t)c->lens_form_count, sizeof *c->lens_forms, "forms of lens", err))
        return err->status;
    struct lens_form_row *f = &c->lens_forms[c->lens_form_count];
    if (textfile_word_into(t, "lens", f->lens, sizeof f->lens, err) ||
        textfile_word_into(t, "principal point", f->center, sizeof f->center, err) ||
        read_known(t, "parameters", &parameters, err) || read_known(t, "median error", &f->median, err) ||
        read_known(t, "noise", &f->noise, err) || read_known(t, "BIC", &f->bic, err) ||
        textfile_word_into(t, "verdict", f->verdict, sizeof f->verdict, err))
        return err->status;
    f->parameters = (int)parameters;
    c->lens_form_count++;
    return ST_OK;
}

/* The errors of one photograph; rows of rings are left to residuals.txt. */
static enum status read_residual(struct contents *c, struct textfile *t, struct err *err)
{
    char *kind = NULL, *id = NULL;
    double observations, median;
    if (textfile_word(t, "photo or radius", &kind, err)) return err->status;
    if (strcmp(kind, "photo")) return ST_OK;
    if (textfile_word(t, "photo", &id, err) || read_known(t, "observations", &observations, err) ||
        read_known(t, "median error", &median, err))
        return err->status;
    const int at = photo_list_find_id(&c->photos, id);
    if (at >= 0 && observations > 0) c->photo_cards[at].residual = median;
    return ST_OK;
}

static enum status read_table(struct contents *c, const char *folder, const char *name, const char *head,
                              enum status (*row)(struct contents *, struct textfile *, struct err *), struct err *err)
{
    struct textfile t = {0};
    struct err problem = ERR_INIT;
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/views/%s", folder, name);
    if (!path_is_file(path)) return ST_OK;
    enum status st = textfile_open(&t, path, &problem);
    if (!st) st = textfile_expect_line(&t, head, &problem);
    while (!st && textfile_next(&t)) st = row(c, &t, &problem);
    textfile_release(&t);
    if (st == ST_NOMEM) return err_set(err, st, "%s", problem.text);
    return st ? contents_note(c, err, "The cameras' %s is not shown. %s", name, problem.text) : ST_OK;
}

enum status contents_read_lens(struct contents *c, const char *folder, struct err *err)
{
    if (read_table(c, folder, "lens_forms.txt", "remodel-lens-forms", read_form, err)) return err->status;
    return c->has_photos ? read_table(c, folder, "residuals.txt", "remodel-residuals", read_residual, err) : ST_OK;
}
