/* line_list.c - reading and writing lines of views. */
#include "common/capture/line_list.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/product/product.h"

enum status line_list_add(struct line_list *list, const struct view_line *line, struct err *err)
{
    if (array_append(&list->lines, (size_t)list->count, sizeof *list->lines, "lines", err)) return err->status;
    list->lines[list->count++] = *line;
    return ST_OK;
}

enum status line_list_read(struct line_list *list, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    struct view_line l;
    *list = (struct line_list){0};
    product_open(&t, NULL, PRODUCT_LINES, path, prov, err);
    while (!err->status && textfile_next(&t)) {
        if (textfile_expect(&t, "line", err) || textfile_double(&t, "U0", &l.u0, err) ||
            textfile_double(&t, "V0", &l.v0, err) || textfile_double(&t, "U1", &l.u1, err) ||
            textfile_double(&t, "V1", &l.v1, err) || textfile_end(&t, err))
            break;
        if (!(hypot(l.u1 - l.u0, l.v1 - l.v0) > 0))
            textfile_wrong_number(&t, 0, "a line that has a length", err);
        else
            line_list_add(list, &l, err);
    }
    textfile_release(&t);
    if (err->status) line_list_release(list);
    return err->status;
}

enum status line_list_write(const struct line_list *list, const char *path, const struct provenance *prov,
                            struct err *err)
{
    struct outfile f = {0};
    if (!product_begin(&f, PRODUCT_LINES, path, prov, err)) {
        for (int i = 0; i < list->count; i++) {
            const struct view_line *l = &list->lines[i];
            fprintf(f.fp, "line %.9g %.9g %.9g %.9g\n", l->u0, l->v0, l->u1, l->v1);
        }
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

void line_list_release(struct line_list *list)
{
    if (!list) return;
    free(list->lines);
    *list = (struct line_list){0};
}
