/* viewpoint_pairs.c - reads and writes pairs.txt; see viewpoint_pairs.h. */
#include "common/texture/viewpoint_pairs.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/product/product.h"

enum { NAME_SIZE = 1024 };

void viewpoint_pairs_release(struct viewpoint_pairs *pairs)
{
    if (!pairs) return;
    for (int i = 0; i < pairs->count; i++) {
        free(pairs->list[i].frame);
        free(pairs->list[i].photos[0]);
        free(pairs->list[i].photos[1]);
    }
    free(pairs->list);
    *pairs = (struct viewpoint_pairs){0};
}

enum status viewpoint_pairs_add(struct viewpoint_pairs *pairs, const char *frame, const char *from, const char *to,
                                double t, struct err *err)
{
    if (array_append(&pairs->list, (size_t)pairs->count, sizeof *pairs->list, "frames", err)) return err->status;
    struct viewpoint_pair *pair = &pairs->list[pairs->count++];
    *pair = (struct viewpoint_pair){strdup(frame), {strdup(from), strdup(to)}, t};
    if (pair->frame && pair->photos[0] && pair->photos[1]) return ST_OK;
    return err_nomem(err, "the photos of a frame", strlen(from) + strlen(to));
}

enum status viewpoint_pairs_write(const struct viewpoint_pairs *pairs, const char *path, const struct provenance *prov,
                                  struct err *err)
{
    struct outfile file = {0};
    char names[3][NAME_SIZE];
    if (!outfile_open(&file, path, err)) {
        fprintf(file.fp, "%s\n", products[PRODUCT_TOUR_PAIRS].head);
        if (prov) provenance_print(prov, file.fp);
    }
    for (int i = 0; !err->status && i < pairs->count; i++) {
        const struct viewpoint_pair *p = &pairs->list[i];
        if (!textfile_quote(p->frame, names[0], NAME_SIZE, err) &&
            !textfile_quote(p->photos[0], names[1], NAME_SIZE, err) &&
            !textfile_quote(p->photos[1], names[2], NAME_SIZE, err))
            fprintf(file.fp, "frame %s %s %s %.17g\n", names[0], names[1], names[2], p->t);
    }
    if (!err->status) outfile_commit(&file, err);
    outfile_discard(&file);
    return err->status;
}

static enum status read_frame(struct viewpoint_pairs *pairs, struct textfile *t, struct err *err)
{
    char *frame, *from, *to;
    double share;
    if (textfile_expect(t, "frame", err) || textfile_word(t, "a frame", &frame, err) ||
        textfile_word(t, "a photo", &from, err) || textfile_word(t, "a photo", &to, err) ||
        textfile_number(t, "a share", 0, 1, &share, err) || textfile_end(t, err))
        return err->status;
    if (viewpoint_pairs_find(pairs, frame)) return textfile_error(t, err, frame, "each frame once");
    return viewpoint_pairs_add(pairs, frame, from, to, share, err);
}

enum status viewpoint_pairs_read(struct viewpoint_pairs *pairs, const char *path, struct provenance *prov,
                                 struct err *err)
{
    struct textfile t = {0};
    *pairs = (struct viewpoint_pairs){0};
    product_open(&t, NULL, PRODUCT_TOUR_PAIRS, path, prov, err);
    while (!err->status && textfile_next(&t)) read_frame(pairs, &t, err);
    if (err->status) viewpoint_pairs_release(pairs);
    textfile_release(&t);
    return err->status;
}

const struct viewpoint_pair *viewpoint_pairs_find(const struct viewpoint_pairs *pairs, const char *frame)
{
    for (int i = pairs->count - 1; i >= 0; i--)
        if (!strcmp(pairs->list[i].frame, frame)) return &pairs->list[i];
    return NULL;
}
