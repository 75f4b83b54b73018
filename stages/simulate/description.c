/* description.c - see description.h. */
#include "stages/simulate/description.h"

#include <ctype.h>
#include <string.h>

#include "common/base/array.h"

enum status description_header(struct textfile *t, const char *kind, int max_version, int *version, struct err *err)
{
    char *word = NULL;
    int64_t found = 0;
    if (!textfile_next(t)) return err_set(err, ST_DATA, "%s is empty; its first line must be: %s 1.", t->path, kind);
    textfile_word(t, kind, &word, err);
    if (!err->status && strcmp(word, kind)) textfile_error(t, err, word, "%s", kind);
    if (!err->status) textfile_int(t, "the format's version", 1, max_version, &found, err);
    *version = (int)found;
    if (!err->status) textfile_end(t, err);
    return err->status;
}

enum status description_point(struct textfile *t, const char *what, struct vec3 *p, struct err *err)
{
    if (!textfile_number(t, what, -MAX_METRES, MAX_METRES, &p->x, err) &&
        !textfile_number(t, what, -MAX_METRES, MAX_METRES, &p->y, err))
        textfile_number(t, what, -MAX_METRES, MAX_METRES, &p->z, err);
    return err->status;
}

enum status description_name(struct textfile *t, char **name, struct err *err)
{
    char *word = NULL;
    if (textfile_word(t, "a name", &word, err)) return err->status;
    bool valid = *word && strlen(word) <= 64;
    for (const char *p = word; *p; p++) valid = valid && (isalnum((unsigned char)*p) || *p == '_' || *p == '-');
    if (!valid) return textfile_error(t, err, word, "a name of at most 64 letters, digits, _ and -");
    *name = strdup(word);
    return *name ? ST_OK : err_nomem(err, "a name", strlen(word) + 1);
}

enum status description_append(const struct textfile *t, void *array, int count, int max, size_t item_size,
                               struct err *err)
{
    if (count == max) return textfile_error(t, err, "one more", "at most %d lines of this kind", max);
    return array_append(array, (size_t)count, item_size, "lines", err);
}
