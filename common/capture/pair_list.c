/* pair_list.c - reading and writing pairs of photos. */
#include "common/capture/pair_list.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/product/product.h"

enum status pair_list_add(struct pair_list *list, const char *first, const char *second, struct err *err)
{
    if (array_append(&list->pairs, (size_t)list->count, sizeof *list->pairs, "pairs of photos", err))
        return err->status;
    struct id_pair *pair = &list->pairs[list->count++];
    *pair = (struct id_pair){strdup(first), strdup(second)};
    return pair->first && pair->second ? ST_OK : err_nomem(err, "a pair of photos", strlen(first) + strlen(second) + 2);
}

enum status pair_list_read(struct pair_list *list, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *list = (struct pair_list){0};
    product_open(&t, NULL, PRODUCT_PAIRS, path, prov, err);
    while (!err->status && textfile_next(&t)) {
        char *first, *second;
        if (!textfile_expect(&t, "pair", err) && !textfile_word(&t, "FIRST", &first, err) &&
            !textfile_word(&t, "SECOND", &second, err) && !textfile_end(&t, err))
            pair_list_add(list, first, second, err);
    }
    textfile_release(&t);
    if (err->status) pair_list_release(list);
    return err->status;
}

enum status pair_list_write(const struct pair_list *list, const char *path, const struct provenance *prov,
                            struct err *err)
{
    struct outfile f = {0};
    if (!product_begin(&f, PRODUCT_PAIRS, path, prov, err)) {
        for (int i = 0; i < list->count; i++)
            fprintf(f.fp, "pair %s %s\n", list->pairs[i].first, list->pairs[i].second);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

void pair_list_release(struct pair_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) {
        free(list->pairs[i].first);
        free(list->pairs[i].second);
    }
    free(list->pairs);
    *list = (struct pair_list){0};
}
