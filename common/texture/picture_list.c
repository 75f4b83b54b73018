/* picture_list.c - see picture_list.h. */
#include "common/texture/picture_list.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/product/product.h"

void picture_list_release(struct picture_list *l)
{
    if (!l) return;
    for (int i = 0; i < l->count; i++) free(l->names[i]);
    free(l->names);
    *l = (struct picture_list){0};
}

enum status picture_list_add(struct picture_list *l, const char *name, struct err *err)
{
    char *copy = strdup(name);
    if (!copy) return err_nomem(err, "a name", strlen(name));
    if (array_append(&l->names, (size_t)l->count, sizeof *l->names, "pictures", err)) {
        free(copy);
        return err->status;
    }
    l->names[l->count++] = copy;
    return ST_OK;
}

enum status picture_list_read(struct picture_list *l, const char *folder, struct provenance *prov, struct err *err)
{
    char path[FILE_PATH], *name;
    struct textfile t = {0};
    if (!product_path_in(path, folder, PRODUCT_PICTURE_LIST, NULL, err))
        product_open(&t, NULL, PRODUCT_PICTURE_LIST, path, prov, err);
    while (!err->status && textfile_next(&t))
        if (!textfile_expect(&t, "picture", err) && !textfile_word(&t, "a picture's name", &name, err) &&
            !textfile_end(&t, err))
            picture_list_add(l, name, err);
    textfile_release(&t);
    return err->status;
}

enum status picture_list_write(const struct picture_list *l, const char *folder, const struct provenance *prov,
                               struct err *err)
{
    char path[FILE_PATH], quoted[2 * FILE_PATH];
    struct outfile f = {0};
    if (product_path_in(path, folder, PRODUCT_PICTURE_LIST, NULL, err) || outfile_open(&f, path, err))
        return err->status;
    fprintf(f.fp, "%s\n", products[PRODUCT_PICTURE_LIST].head);
    provenance_print(prov, f.fp);
    for (int i = 0; !err->status && i < l->count; i++)
        if (!textfile_quote(l->names[i], quoted, sizeof quoted, err)) fprintf(f.fp, "picture %s\n", quoted);
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
