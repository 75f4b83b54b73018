/* picture_record.c - reads and writes VIEW.txt of a rendered picture; see picture_record.h. */
#include "common/texture/picture_record.h"

#include "common/product/product.h"

enum { MAX_SIZE = 1 << 20 };

enum status picture_record_write(const struct picture_record *record, const char *path, const struct provenance *prov,
                                 struct err *err)
{
    struct outfile out = {0};
    if (outfile_open(&out, path, err)) return err->status;
    fprintf(out.fp, "%s\n", products[PRODUCT_PICTURE_RECORD].head);
    if (prov) provenance_print(prov, out.fp);
    fprintf(out.fp, "size %d %d\nexposure %.9g\nchanged %.6g\n", record->width, record->height, record->exposure,
            record->changed);
    for (int k = 0; k < MADE_COUNT; k++)
        fprintf(out.fp, "made %s %.6g\n", picture_made_kind((enum picture_made)k)->word, record->shares[k]);
    outfile_commit(&out, err);
    outfile_discard(&out);
    return err->status;
}

static enum status read_share(struct textfile *t, double *share, struct err *err)
{
    return textfile_number(t, "a share in percent", 0, 100, share, err) ? err->status : textfile_end(t, err);
}

/* seen: a bit for each kind that was read before. */
static enum status read_made(struct picture_record *record, unsigned *seen, struct textfile *t, struct err *err)
{
    char *word;
    if (textfile_word(t, "what pixels come from", &word, err)) return err->status;
    const int kind = picture_made_find(word);
    if (kind < 0) return textfile_error(t, err, word, "a kind of pixel, such as photo");
    if (*seen & 1u << kind) return textfile_error(t, err, word, "each kind once");
    *seen |= 1u << kind;
    return read_share(t, &record->shares[kind], err);
}

static enum status read_head(struct picture_record *record, struct textfile *t, struct err *err)
{
    int64_t size[2] = {0, 0};
    if (!textfile_expect_line(t, "size", err) && !textfile_int(t, "a width", 1, MAX_SIZE, &size[0], err) &&
        !textfile_int(t, "a height", 1, MAX_SIZE, &size[1], err))
        textfile_end(t, err);
    record->width = (int)size[0];
    record->height = (int)size[1];
    if (!err->status && !textfile_expect_line(t, "exposure", err))
        textfile_double(t, "an exposure", &record->exposure, err);
    if (!err->status && !(record->exposure > 0)) textfile_wrong_number(t, record->exposure, "an exposure above 0", err);
    if (!err->status && !textfile_end(t, err) && !textfile_expect_line(t, "changed", err))
        read_share(t, &record->changed, err);
    return err->status;
}

enum status picture_record_read(struct picture_record *record, const char *path, struct provenance *prov,
                                struct err *err)
{
    struct textfile t = {0};
    unsigned seen = 0;
    *record = (struct picture_record){0};
    if (product_open(&t, NULL, PRODUCT_PICTURE_RECORD, path, prov, err)) return err->status;
    read_head(record, &t, err);
    while (!err->status && textfile_next(&t))
        if (!textfile_expect(&t, "made", err)) read_made(record, &seen, &t, err);
    if (err->status) *record = (struct picture_record){0};
    textfile_release(&t);
    return err->status;
}
