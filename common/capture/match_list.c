/* match_list.c - reading and writing matches of photos. */
#include "common/capture/match_list.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/capture/feature_list.h"
#include "common/product/product.h"

struct matched_pair *match_list_add(struct match_list *list, const char *other, const char *hash, struct err *err)
{
    if (array_append(&list->pairs, (size_t)list->count, sizeof *list->pairs, "pairs of photos", err)) return NULL;
    struct matched_pair *pair = &list->pairs[list->count];
    *pair = (struct matched_pair){.other = strdup(other)};
    if (!pair->other) {
        err_nomem(err, "the name of a photo", strlen(other) + 1);
        return NULL;
    }
    snprintf(pair->hash, sizeof pair->hash, "%s", hash);
    list->count++;
    return pair;
}

const struct matched_pair *match_list_find(const struct match_list *list, const char *other)
{
    for (int i = 0; i < list->count; i++)
        if (!strcmp(list->pairs[i].other, other)) return &list->pairs[i];
    return NULL;
}

static enum status read_match(struct index_match *m, int above, struct textfile *t, struct err *err)
{
    int64_t first = 0, second = 0;
    if (textfile_expect_line(t, "match", err) || textfile_int(t, "I", above + 1, MAX_FEATURES - 1, &first, err) ||
        textfile_int(t, "J", 0, MAX_FEATURES - 1, &second, err))
        return err->status;
    *m = (struct index_match){(int)first, (int)second};
    return textfile_end(t, err);
}

static enum status read_pair(struct match_list *list, struct textfile *t, struct err *err)
{
    char *other = NULL, hash[HASH_TEXT];
    int64_t count = 0;
    struct matched_pair *pair = NULL;
    if (textfile_expect(t, "pair", err) || textfile_word(t, "OTHER", &other, err) ||
        textfile_word_into(t, "HASH", hash, sizeof hash, err) ||
        textfile_int(t, "COUNT", 0, MAX_FEATURES, &count, err) || textfile_end(t, err) ||
        !(pair = match_list_add(list, other, hash, err)))
        return err->status;
    pair->matches = malloc(((size_t)count + 1) * sizeof *pair->matches);
    if (!pair->matches) return err_nomem(err, "matches", (size_t)count * sizeof *pair->matches);
    for (; !err->status && pair->count < count; pair->count++)
        read_match(&pair->matches[pair->count], pair->count ? pair->matches[pair->count - 1].first : -1, t, err);
    return err->status;
}

enum status match_list_read(struct match_list *list, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *list = (struct match_list){0};
    if (!product_open(&t, NULL, PRODUCT_MATCHES, path, prov, err) && !textfile_expect_line(&t, "limits", err) &&
        !textfile_double(&t, "RATIO", &list->max_ratio, err) && !textfile_double(&t, "ANGLE", &list->max_angle, err) &&
        !textfile_end(&t, err) && !textfile_expect_line(&t, "photo", err) &&
        !textfile_word_into(&t, "HASH", list->hash, sizeof list->hash, err))
        textfile_end(&t, err);
    while (!err->status && textfile_next(&t)) read_pair(list, &t, err);
    textfile_release(&t);
    if (err->status) match_list_release(list);
    return err->status;
}

enum status match_list_write(const struct match_list *list, const char *path, const struct provenance *prov,
                             struct err *err)
{
    struct outfile f = {0};
    if (!product_begin(&f, PRODUCT_MATCHES, path, prov, err)) {
        fprintf(f.fp, "limits %.17g %.17g\nphoto %s\n", list->max_ratio, list->max_angle, list->hash);
        for (int i = 0; i < list->count; i++) {
            const struct matched_pair *p = &list->pairs[i];
            fprintf(f.fp, "pair %s %s %d\n", p->other, p->hash, p->count);
            for (int k = 0; k < p->count; k++)
                fprintf(f.fp, "match %d %d\n", p->matches[k].first, p->matches[k].second);
        }
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

void match_list_release(struct match_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) {
        free(list->pairs[i].other);
        free(list->pairs[i].matches);
    }
    free(list->pairs);
    *list = (struct match_list){0};
}
