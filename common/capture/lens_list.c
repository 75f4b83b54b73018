/* lens_list.c - reading and writing lenses.txt. */
#include "common/capture/lens_list.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/outfile.h"
#include "common/base/sort.h"
#include "common/product/product.h"

enum { NAME_SIZE = 1024 };

enum status lens_read_camera(struct camera *c, const char *model, struct textfile *t, struct err *err)
{
    int64_t width = 0, height = 0;
    struct err why = ERR_INIT;
    if (!camera_model_from_name(model, &c->model)) return textfile_error(t, err, model, "a camera model of COLMAP");
    if (textfile_int(t, "width", 1, INT_MAX, &width, err) || textfile_int(t, "height", 1, INT_MAX, &height, err))
        return err->status;
    c->width = (int)width;
    c->height = (int)height;
    for (int i = 0; i < camera_model_params(c->model); i++)
        if (textfile_double(t, "camera parameter", &c->params[i], err)) return err->status;
    if (camera_check(c, &why)) return err_set(err, ST_DATA, "%s:%d: %s", t->path, t->line, why.text);
    return ST_OK;
}

static enum status read_lens(struct textfile *t, struct lens *l, struct err *err)
{
    char *view, *photo, *model, *turn;
    struct quat *q = &l->view_from_photo;
    if (textfile_word(t, "view", &view, err) || textfile_word(t, "photo", &photo, err) ||
        textfile_word(t, "camera model", &model, err) || lens_read_camera(&l->camera, model, t, err))
        return err->status;
    if (textfile_word(t, "\"turn\"", &turn, err)) return err->status;
    if (strcmp(turn, "turn")) return textfile_error(t, err, turn, "\"turn\"");
    if (textfile_double(t, "W of the turn", &q->w, err) || textfile_double(t, "X of the turn", &q->x, err) ||
        textfile_double(t, "Y of the turn", &q->y, err) || textfile_double(t, "Z of the turn", &q->z, err) ||
        textfile_end(t, err))
        return err->status;
    double length = sqrt(q->w * q->w + q->x * q->x + q->y * q->y + q->z * q->z);
    if (!(fabs(length - 1) < 1e-9))
        return err_set(err, ST_DATA, "%s:%d: found a turn of length %.9g, wanted a quaternion of length 1.", t->path,
                       t->line, length);
    l->view = strdup(view);
    l->photo = strdup(photo);
    return l->view && l->photo ? ST_OK : err_nomem(err, "names", strlen(view) + strlen(photo));
}

enum status lens_list_read(struct lens_list *list, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *list = (struct lens_list){0};
    product_open(&t, NULL, PRODUCT_LENSES, path, prov, err);
    while (!err->status && textfile_next(&t)) {
        if (array_append(&list->lenses, (size_t)list->count, sizeof *list->lenses, "lenses", err)) break;
        struct lens *l = &list->lenses[list->count++];
        *l = (struct lens){0};
        read_lens(&t, l, err);
        if (!err->status && list->count > 1 && strcmp(l[-1].view, l->view) >= 0)
            err_set(err, ST_DATA, "%s:%d: found view %s after %s, wanted each view once, in order of name.", path,
                    t.line, l->view, l[-1].view);
    }
    if (!err->status && !list->count) textfile_error(&t, err, NULL, "a line for each view");
    textfile_release(&t);
    if (err->status) lens_list_release(list);
    return err->status;
}

enum status lens_list_write(const struct lens_list *list, const char *path, const struct provenance *prov,
                            struct err *err)
{
    struct outfile f = {0};
    product_begin(&f, PRODUCT_LENSES, path, prov, err);
    for (int i = 0; !err->status && i < list->count; i++) {
        const struct lens *l = &list->lenses[i];
        struct quat q = l->view_from_photo;
        char view[NAME_SIZE], photo[NAME_SIZE];
        if (textfile_quote(l->view, view, sizeof view, err) || textfile_quote(l->photo, photo, sizeof photo, err))
            break;
        fprintf(f.fp, "%s %s %s %d %d", view, photo, camera_model_name(l->camera.model), l->camera.width,
                l->camera.height);
        for (int k = 0; k < camera_model_params(l->camera.model); k++) fprintf(f.fp, " %.17g", l->camera.params[k]);
        fprintf(f.fp, " turn %.17g %.17g %.17g %.17g\n", q.w, q.x, q.y, q.z);
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

static bool is_before(const void *lens, const void *view)
{
    return strcmp(((const struct lens *)lens)->view, view) < 0;
}

int lens_list_find(const struct lens_list *list, const char *view)
{
    const int at = (int)sort_place(list->lenses, (size_t)list->count, sizeof *list->lenses, is_before, view);
    return at < list->count && !strcmp(list->lenses[at].view, view) ? at : -1;
}

void lens_list_release(struct lens_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) {
        free(list->lenses[i].view);
        free(list->lenses[i].photo);
    }
    free(list->lenses);
    *list = (struct lens_list){0};
}
