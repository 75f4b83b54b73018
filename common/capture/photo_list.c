/* photo_list.c - reading and writing the records of a scene's photographs.
 *
 * A record, photos/ID.txt, has what the pixels do not say: file name, hash, size, bits, EXIF orientation and
 * exposure, camera. Of a view of several exposures it also lists these, in ascending order, with the middle one and
 * the exposure that is white. photos/list.txt lists the ids.
 *
 * Records are rewritten only if their text changes (outfile_write_if_changed()), because products depend on their
 * time: a photo that did not change redoes nothing. EXIF values are 0 where they are unknown.
 *
 * Photos are in order of id, so that a look-up is a binary search. */
#include "common/capture/photo_list.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/memory_text.h"
#include "common/product/product.h"

enum { QUOTED_SIZE = 1024 /* a file name has at most 255 bytes */, MAX_BRACKETS = 1000 /* of one view */ };

static enum status keep_word(char **kept, const char *word, struct err *err)
{
    *kept = strdup(word);
    return *kept ? ST_OK : err_nomem(err, "a name", strlen(word) + 1);
}

static enum status read_int(struct textfile *t, const char *what, int min, int max, int *value, struct err *err)
{
    int64_t wide = 0;
    if (!textfile_int(t, what, min, max, &wide, err)) *value = (int)wide;
    return err->status;
}

/* A number from EXIF; 0: unknown. */
static enum status read_exif(struct textfile *t, const char *what, double *value, struct err *err)
{
    if (!textfile_double(t, what, value, err) && *value < 0)
        textfile_error(t, err, "a negative number", "%s, 0 or more", what);
    return err->status;
}

static enum status read_hash(struct textfile *t, char hash[HASH_TEXT], struct err *err)
{
    char *word = NULL;
    if (!textfile_word(t, "hash", &word, err) &&
        (strlen(word) != HASH_TEXT - 1 || strspn(word, "0123456789abcdef") != HASH_TEXT - 1))
        textfile_error(t, err, word, "a hash of %d hexadecimal digits", HASH_TEXT - 1);
    if (!err->status) strcpy(hash, word);
    return err->status;
}

static enum status read_exposure(struct textfile *t, const char *what, double *value, struct err *err)
{
    textfile_double(t, what, value, err);
    char found[32];
    if (err->status || *value > 0) return err->status;
    snprintf(found, sizeof found, "%.9g", *value);
    return textfile_error(t, err, found, "%s above 0", what);
}

static enum status read_bracket(struct photo_record *r, struct textfile *t, struct err *err)
{
    struct bracket *b = &r->brackets[r->bracket_count], *before = r->bracket_count ? b - 1 : NULL;
    char *word = NULL;
    if (textfile_expect_line(t, "bracket", err) || textfile_word(t, "file name", &word, err) ||
        keep_word(&b->file, word, err))
        return err->status;
    r->bracket_count++; /* from here on it is released with the record */
    if (!read_hash(t, b->hash, err)) read_exposure(t, "exposure", &b->exposure, err);
    if (!err->status && before && before->exposure > b->exposure)
        textfile_error(t, err, b->file, "exposures in ascending order");
    if (!err->status) textfile_end(t, err);
    return err->status;
}

static enum status read_brackets(struct photo_record *r, struct textfile *t, struct err *err)
{
    int count = 0;
    char *word = NULL;
    if (!textfile_word(t, "brackets", &word, err) && strcmp(word, "brackets"))
        textfile_error(t, err, word, "a line \"brackets ...\", or the end");
    if (!err->status && !read_int(t, "number of exposures", 1, MAX_BRACKETS, &count, err) &&
        !read_int(t, "index of the middle exposure", 0, count - 1, &r->middle, err) &&
        !read_exposure(t, "exposure of white", &r->white, err))
        textfile_end(t, err);
    if (!err->status && !(r->brackets = calloc((size_t)count, sizeof *r->brackets)))
        err_nomem(err, "a list of exposures", (size_t)count * sizeof *r->brackets);
    while (!err->status && r->bracket_count < count) read_bracket(r, t, err);
    return err->status;
}

/* A line "colour NAME", which only photos have that are not in sRGB. *more: another line follows, whose first word is
 * still to be read. */
static enum status read_colour(struct photo_info *info, bool *more, struct textfile *t, struct err *err)
{
    if (strncmp(t->cursor, "colour ", 7) != 0) return ST_OK;
    if (textfile_expect(t, "colour", err) ||
        textfile_word_into(t, "a colour space", info->colour, sizeof info->colour, err) || textfile_end(t, err))
        return err->status;
    *more = textfile_next(t);
    return ST_OK;
}

static enum status read_fields(struct photo_record *r, struct textfile *t, struct err *err)
{
    struct photo_info *info = &r->info;
    char *word = NULL;
    if (textfile_expect_line(t, "file", err) || textfile_word(t, "file name", &word, err) ||
        keep_word(&r->file, word, err) || textfile_end(t, err))
        return err->status;
    if (textfile_expect_line(t, "hash", err) || read_hash(t, r->hash, err) || textfile_end(t, err)) return err->status;
    if (textfile_expect_line(t, "size", err) || read_int(t, "width", 1, 1 << 28, &info->width, err) ||
        read_int(t, "height", 1, 1 << 28, &info->height, err) || textfile_end(t, err))
        return err->status;
    if (textfile_expect_line(t, "bits", err) || read_int(t, "bits", 8, 32, &info->bits, err) || textfile_end(t, err))
        return err->status;
    if (textfile_expect_line(t, "orientation", err) || read_int(t, "orientation", 1, 8, &info->orientation, err) ||
        textfile_end(t, err))
        return err->status;
    if (textfile_expect_line(t, "exif", err) || read_exif(t, "focal length", &info->focal_mm, err) ||
        read_exif(t, "35 mm focal length", &info->focal35_mm, err) ||
        read_exif(t, "exposure time", &info->seconds, err) || read_exif(t, "f-number", &info->f_number, err) ||
        read_exif(t, "ISO", &info->iso, err) || textfile_end(t, err))
        return err->status;
    if (textfile_expect_line(t, "camera", err) || textfile_word_into(t, "make", info->make, sizeof info->make, err) ||
        textfile_word_into(t, "model", info->model, sizeof info->model, err) || textfile_end(t, err))
        return err->status;
    if (textfile_expect_line(t, "taken", err) || read_exif(t, "time taken", &info->taken, err) || textfile_end(t, err))
        return err->status;
    bool more = textfile_next(t);
    if (more && !read_colour(info, &more, t, err) && more) read_brackets(r, t, err);
    if (!err->status) textfile_end_of_file(t, err);
    return err->status;
}

enum status photo_record_read(struct photo_record *r, const char *folder, const char *id, struct provenance *prov,
                              struct err *err)
{
    struct textfile t = {0};
    char path[FILE_PATH];

    *r = (struct photo_record){0};
    if (!product_path_in(path, folder, PRODUCT_PHOTO, &(struct product_key){.photo = id}, err) &&
        !keep_word(&r->id, id, err) && !product_open(&t, NULL, PRODUCT_PHOTO, path, prov, err))
        read_fields(r, &t, err);
    textfile_release(&t);
    if (err->status) photo_record_release(r);
    return err->status;
}

/* Closes a text and writes it if it differs from the file. */
static enum status finish_text(struct memory_text *m, const char *path, struct err *err)
{
    if (!err->status && !memory_text_close(m, "a text", err)) outfile_write_if_changed(path, m->text, m->size, err);
    memory_text_release(m);
    return err->status;
}

enum status photo_record_write(const struct photo_record *r, const char *folder, struct err *err)
{
    const struct photo_info *info = &r->info;
    char file[QUOTED_SIZE], make[QUOTED_SIZE], model[QUOTED_SIZE], colour[QUOTED_SIZE];
    char path[FILE_PATH];
    struct memory_text m = {0};

    if (product_path_in(path, folder, PRODUCT_PHOTO, &(struct product_key){.photo = r->id}, err) ||
        textfile_quote(r->file, file, sizeof file, err) || textfile_quote(info->make, make, sizeof make, err) ||
        textfile_quote(info->model, model, sizeof model, err) ||
        textfile_quote(info->colour, colour, sizeof colour, err))
        return err->status;
    if (memory_text_open(&m, "a record", err)) return err->status;
    FILE *to = m.to;
    fprintf(to, "%s\nfile %s\nhash %s\nsize %d %d\nbits %d\norientation %d\n", products[PRODUCT_PHOTO].head, file,
            r->hash, info->width, info->height, info->bits, info->orientation);
    fprintf(to, "exif %.17g %.17g %.17g %.17g %.17g\n", info->focal_mm, info->focal35_mm, info->seconds, info->f_number,
            info->iso);
    fprintf(to, "camera %s %s\ntaken %.17g\n", make, model, info->taken);
    if (*info->colour) fprintf(to, "colour %s\n", colour);
    if (r->bracket_count) fprintf(to, "brackets %d %d %.17g\n", r->bracket_count, r->middle, r->white);
    for (int i = 0; !err->status && i < r->bracket_count; i++) {
        const struct bracket *b = &r->brackets[i];
        if (!textfile_quote(b->file, file, sizeof file, err))
            fprintf(to, "bracket %s %s %.17g\n", file, b->hash, b->exposure);
    }
    return finish_text(&m, path, err);
}

static enum status print_list(const struct photo_list *list, FILE *to, struct err *err)
{
    char file[QUOTED_SIZE];
    for (int i = 0; !err->status && i < list->count; i++)
        if (!textfile_quote(list->photos[i].file, file, sizeof file, err))
            fprintf(to, "%s %s\n", list->photos[i].id, file);
    return err->status;
}

static enum status print_make(const struct photo_list *list, FILE *to, struct err *err)
{
    (void)err;
    fputs("PHOTO_IDS :=", to);
    for (int i = 0; i < list->count; i++) fprintf(to, " %s", list->photos[i].id);
    fputs(list->count && list->photos[0].bracket_count ? "\nBRACKETED := yes\n" : "\n", to);
    return ST_OK;
}

static enum status print_brackets(const struct photo_list *list, FILE *to, struct err *err)
{
    char file[QUOTED_SIZE];
    fputs("# VIEW FILE FILE ... from the shortest exposure on\n", to);
    for (int i = 0; !err->status && i < list->count; i++) {
        fputs(list->photos[i].id, to);
        for (int k = 0; !err->status && k < list->photos[i].bracket_count; k++)
            if (!textfile_quote(list->photos[i].brackets[k].file, file, sizeof file, err)) fprintf(to, " %s", file);
        fputc('\n', to);
    }
    return err->status;
}

enum status photo_list_write(const struct photo_list *list, const char *folder, struct err *err)
{
    static const struct {
        enum product_id id;
        enum status (*print)(const struct photo_list *list, FILE *to, struct err *err);
    } texts[] = {
        {PRODUCT_PHOTO_BRACKETS, print_brackets}, {PRODUCT_PHOTO_LIST, print_list}, {PRODUCT_PHOTOS_MK, print_make}};
    bool bracketed = list->count && list->photos[0].bracket_count;
    for (int i = bracketed ? 0 : 1; !err->status && i < 3; i++) {
        char path[FILE_PATH];
        struct memory_text m = {0};
        if (product_path_in(path, folder, texts[i].id, NULL, err)) return err->status;
        if (memory_text_open(&m, "a list of photos", err)) return err->status;
        texts[i].print(list, m.to, err);
        finish_text(&m, path, err);
    }
    return err->status;
}

static enum status read_list_line(struct photo_list *list, struct textfile *t, const char *folder, struct err *err)
{
    char *id = NULL, *file = NULL;
    if (!textfile_word(t, "photo id", &id, err) &&
        (strspn(id, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-") != strlen(id) || *id == '-' ||
         !*id))
        textfile_error(t, err, id, "a photo id of letters, digits, _ and -");
    if (!err->status && list->count && strcmp(list->photos[list->count - 1].id, id) >= 0)
        textfile_error(t, err, id, "ids in order, each once");
    if (!err->status && !textfile_word(t, "file name", &file, err)) textfile_end(t, err);
    if (err->status) return err->status;

    if (array_append(&list->photos, (size_t)list->count, sizeof *list->photos, "photos", err)) return err->status;
    if (photo_record_read(&list->photos[list->count], folder, id, NULL, err)) return err->status;
    if (strcmp(list->photos[list->count++].file, file))
        textfile_error(t, err, file, "the file named in the record %s.txt; import the photos again", id);
    return err->status;
}

enum status photo_list_read(struct photo_list *list, const char *folder, struct err *err)
{
    struct textfile t = {0};
    char path[FILE_PATH];
    *list = (struct photo_list){0};
    if (!product_path_in(path, folder, PRODUCT_PHOTO_LIST, NULL, err))
        product_open(&t, NULL, PRODUCT_PHOTO_LIST, path, NULL, err);
    while (!err->status && textfile_next(&t)) read_list_line(list, &t, folder, err);
    if (!err->status && !list->count) err_set(err, ST_DATA, "%s contains no photo; import the photos again.", path);
    textfile_release(&t);
    if (err->status) photo_list_release(list);
    return err->status;
}

int photo_list_find_id(const struct photo_list *list, const char *id)
{
    int begin = 0, end = list->count;
    while (begin < end) {
        int middle = begin + (end - begin) / 2, order = strcmp(list->photos[middle].id, id);
        if (!order) return middle;
        if (order < 0)
            begin = middle + 1;
        else
            end = middle;
    }
    return -1;
}

int photo_list_find_file(const struct photo_list *list, const char *file)
{
    for (int i = 0; i < list->count; i++)
        if (!strcmp(list->photos[i].file, file)) return i;
    return -1;
}

void photo_record_release(struct photo_record *r)
{
    if (!r) return;
    for (int i = 0; i < r->bracket_count; i++) free(r->brackets[i].file);
    free(r->brackets);
    free(r->id);
    free(r->file);
    *r = (struct photo_record){0};
}

void photo_list_release(struct photo_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) photo_record_release(&list->photos[i]);
    free(list->photos);
    *list = (struct photo_list){0};
}
