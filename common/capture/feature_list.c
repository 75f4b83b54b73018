/* feature_list.c - reading and writing features of photos. */
#include "common/capture/feature_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/product/product.h"

_Static_assert(sizeof(struct feature) == 4 * sizeof(float) + DESCRIPTOR_SIZE, "features are hashed as bytes");

static int hex_digit(char c) { return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1; }

static enum status read_descriptor(uint8_t *to, struct textfile *t, struct err *err)
{
    char *word;
    if (textfile_word(t, "DESCRIPTOR", &word, err)) return err->status;
    if (strlen(word) != 2 * DESCRIPTOR_SIZE)
        return textfile_error(t, err, word, "a descriptor of %d hexadecimal digits", 2 * DESCRIPTOR_SIZE);
    for (int i = 0; i < DESCRIPTOR_SIZE; i++) {
        const int high = hex_digit(word[2 * i]), low = hex_digit(word[2 * i + 1]);
        if (high < 0 || low < 0)
            return textfile_error(t, err, word, "a descriptor of %d hexadecimal digits", 2 * DESCRIPTOR_SIZE);
        to[i] = (uint8_t)(16 * high + low);
    }
    return ST_OK;
}

static enum status read_feature(struct feature *f, struct textfile *t, struct err *err)
{
    static const char *const names[] = {"X", "Y", "SCALE", "ANGLE"};
    double value[4];
    textfile_expect_line(t, "feature", err);
    for (int k = 0; !err->status && k < 4; k++) textfile_double(t, names[k], &value[k], err);
    if (err->status || read_descriptor(f->descriptor, t, err) || textfile_end(t, err)) return err->status;
    f->x = (float)value[0];
    f->y = (float)value[1];
    f->scale = (float)value[2];
    f->angle = (float)value[3];
    return ST_OK;
}

static enum status read_head(struct feature_list *list, struct textfile *t, struct err *err)
{
    int64_t count = 0;
    if (textfile_expect_line(t, "features", err) || textfile_int(t, "COUNT", 0, MAX_FEATURES, &count, err) ||
        textfile_word_into(t, "HASH", list->hash, sizeof list->hash, err))
        return err->status;
    list->count = (int)count;
    return textfile_end(t, err);
}

enum status feature_list_read_head(struct feature_list *list, const char *path, struct err *err)
{
    struct textfile t = {0};
    *list = (struct feature_list){0};
    if (!product_open(&t, NULL, PRODUCT_FEATURES, path, NULL, err)) read_head(list, &t, err);
    textfile_release(&t);
    return err->status;
}

enum status feature_list_read(struct feature_list *list, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *list = (struct feature_list){0};
    if (!product_open(&t, NULL, PRODUCT_FEATURES, path, prov, err) && !read_head(list, &t, err)) {
        list->features = malloc(((size_t)list->count + 1) * sizeof *list->features);
        if (!list->features) err_nomem(err, "features", (size_t)list->count * sizeof *list->features);
    }
    for (int i = 0; !err->status && i < list->count; i++) read_feature(&list->features[i], &t, err);
    if (!err->status) textfile_end_of_file(&t, err);
    textfile_release(&t);
    if (err->status) feature_list_release(list);
    return err->status;
}

enum status feature_list_write(struct feature_list *list, const char *path, const struct provenance *prov,
                               struct err *err)
{
    struct outfile f = {0};
    char hex[2 * DESCRIPTOR_SIZE + 1];
    hash_bytes(list->hash, list->features, (size_t)list->count * sizeof *list->features);
    if (!product_begin(&f, PRODUCT_FEATURES, path, prov, err)) {
        fprintf(f.fp, "features %d %s\n", list->count, list->hash);
        for (int i = 0; i < list->count; i++) {
            const struct feature *p = &list->features[i];
            for (int k = 0; k < DESCRIPTOR_SIZE; k++) {
                hex[2 * k] = "0123456789abcdef"[p->descriptor[k] >> 4];
                hex[2 * k + 1] = "0123456789abcdef"[p->descriptor[k] & 15];
            }
            hex[2 * DESCRIPTOR_SIZE] = '\0';
            fprintf(f.fp, "feature %.9g %.9g %.9g %.9g %s\n", (double)p->x, (double)p->y, (double)p->scale,
                    (double)p->angle, hex);
        }
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

void feature_list_release(struct feature_list *list)
{
    if (!list) return;
    free(list->features);
    *list = (struct feature_list){0};
}
