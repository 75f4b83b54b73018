/* film_views.c - reading, writing and applying the choice of a film's views. */
#include "common/film/film_views.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/memory_text.h"
#include "common/product/product.h"

enum { MAX_FILM_VIEWS = 1000000, NAME_SIZE = 1024 };

void film_views_release(struct film_views *v)
{
    if (!v) return;
    for (int i = 0; i < v->count; i++) free(v->names[i]);
    free(v->names);
    *v = (struct film_views){0};
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static int compare_names(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

static enum status read_name(struct film_views *v, struct textfile *t, struct err *err)
{
    char *name;
    if (textfile_expect_line(t, "view", err) || textfile_word(t, "a view's name", &name, err)) return err->status;
    if (array_append(&v->names, (size_t)v->count, sizeof *v->names, "views of a film", err)) return err->status;
    v->names[v->count] = strdup(name);
    if (!v->names[v->count]) return err_nomem(err, "a view's name", strlen(name));
    v->count++;
    return textfile_end(t, err);
}

static enum status read_views(struct film_views *v, struct textfile *t, struct err *err)
{
    static const char wanted[] = "\"all\" or \"views\" and their number";
    int64_t count = 0;
    char *word;
    if (!textfile_next(t)) return textfile_error(t, err, NULL, wanted);
    if (textfile_word(t, wanted, &word, err)) return err->status;
    v->all = !strcmp(word, "all");
    if (!v->all && strcmp(word, "views")) return textfile_error(t, err, word, wanted);
    if (!v->all && textfile_int(t, "number of views", 1, MAX_FILM_VIEWS, &count, err)) return err->status;
    if (textfile_end(t, err)) return err->status;
    for (int i = 0; i < count; i++)
        if (read_name(v, t, err)) return err->status;
    if (textfile_end_of_file(t, err)) return err->status;
    if (v->count) qsort(v->names, (size_t)v->count, sizeof *v->names, compare_names);
    for (int i = 1; i < v->count; i++)
        if (!strcmp(v->names[i], v->names[i - 1]))
            return err_set(err, ST_DATA, "%s: found view %s twice, wanted each view once.", t->path, v->names[i]);
    return ST_OK;
}

enum status film_views_read(struct film_views *v, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *v = (struct film_views){0};
    if (!product_open(&t, NULL, PRODUCT_FILM_VIEWS, path, prov, err)) read_views(v, &t, err);
    textfile_release(&t);
    if (err->status) film_views_release(v);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

static enum status print_views(FILE *to, const struct camera_set *set, const bool *keep, struct err *err)
{
    char name[NAME_SIZE];
    int count = 0;
    fprintf(to, "%s\n", products[PRODUCT_FILM_VIEWS].head);
    for (int i = 0; keep && i < set->view_count; i++) count += keep[i];
    if (keep)
        fprintf(to, "views %d\n", count);
    else
        fputs("all\n", to);
    for (int i = 0; keep && i < set->view_count; i++) {
        if (!keep[i]) continue;
        if (textfile_quote(set->views[i].name, name, sizeof name, err)) return err->status;
        fprintf(to, "view %s\n", name);
    }
    return ST_OK;
}

enum status film_views_write(const struct camera_set *set, const bool *keep, const char *path,
                             const struct provenance *prov, struct err *err)
{
    struct memory_text m = {0};
    if (memory_text_open(&m, "the views of a film", err)) return err->status;
    if (prov) provenance_print(prov, m.to);
    print_views(m.to, set, keep, err);
    if (!memory_text_close(&m, "the views of a film", err)) outfile_write_if_changed(path, m.text, m.size, err);
    memory_text_release(&m);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- applying */

enum status film_views_keep(struct camera_set *set, const char *path, struct provenance *prov, struct err *err)
{
    struct film_views v = {0};
    bool *keep = NULL;
    if (!path) return ST_OK;
    const int inputs = prov->count;
    if (!film_views_read(&v, path, prov, err) && v.all) provenance_keep(prov, inputs);
    if (!err->status && !v.all) {
        keep = calloc((size_t)set->view_count + 1, sizeof *keep);
        if (!keep) err_nomem(err, "the views of a film", (size_t)set->view_count);
        for (int i = 0; !err->status && i < v.count; i++) {
            const int at = camera_set_find(set, v.names[i]);
            if (at < 0)
                err_set(err, ST_DATA, "%s: found view %s, which the scene does not have; choose the views again.", path,
                        v.names[i]);
            else
                keep[at] = true;
        }
        if (!err->status) camera_set_keep(set, keep, err);
    }
    free(keep);
    film_views_release(&v);
    return err->status;
}
