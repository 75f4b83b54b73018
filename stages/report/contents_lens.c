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

static enum status read_table(struct contents *c, const char *folder, enum product_id id,
                              enum status (*row)(struct contents *, struct textfile *, struct err *), struct err *err)
{
    struct textfile t = {0};
    struct err problem = ERR_INIT;
    char path[FILE_PATH];
    if (!contents_product(path, folder, id, NULL)) return ST_OK;
    product_open(&t, NULL, id, path, NULL, &problem);
    while (!problem.status && textfile_next(&t)) row(c, &t, &problem);
    textfile_release(&t);
    if (problem.status == ST_NOMEM) return err_set(err, ST_NOMEM, "%s", problem.text);
    return problem.status ? contents_note(c, err, "The cameras' %s is not shown. %s", products[id].file, problem.text)
                          : ST_OK;
}

enum status contents_read_lens(struct contents *c, const char *folder, struct err *err)
{
    if (read_table(c, folder, PRODUCT_LENS_FORMS, read_form, err)) return err->status;
    return c->has_photos ? read_table(c, folder, PRODUCT_RESIDUALS, read_residual, err) : ST_OK;
}
