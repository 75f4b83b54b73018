/* textfile.h - reads line-based text records. Errors name the file, the line, what was found and what was wanted.
 *
 *   struct textfile t = {0};
 *   if (textfile_open(&t, path, err)) return err->status;
 *   while (!st && textfile_next(&t)) {            // skips blank lines and lines that begin with #
 *       st = textfile_int(&t, "camera id", 0, INT_MAX, &id, err) || textfile_word(&t, "model", &word, err)
 *         || textfile_end(&t, err);
 *   }
 *   textfile_release(&t);
 *
 * The whole file is read at once. Words point into its buffer and are valid until textfile_release(). Numbers are read
 * in the C locale; NaN and infinity are errors, and so is a NUL byte in the file. `what` names an item in errors. */
#ifndef REMODEL_TEXTFILE_H
#define REMODEL_TEXTFILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "common/base/err.h"
#include "common/base/file_bytes.h"

struct textfile {
    char *path, *bytes; /* owned */
    size_t size, at;    /* at: offset of the next line */
    char *cursor;       /* the rest of the current line */
    int line;           /* number of the current line, from 1 */
};

enum status textfile_open(struct textfile *t, const char *path, struct err *err);
/* The same of bytes that were read from the path. They are the textfile's from then on, also after a failure. */
enum status textfile_take(struct textfile *t, struct file_bytes *file, const char *path, struct err *err);

/* Moves to the next record; false at the end. */
bool textfile_next(struct textfile *t);
/* Moves to the next line, even if it is blank or a comment (COLMAP's images.txt has blank lines). */
bool textfile_next_raw(struct textfile *t);
/* The next line as it is in the file, without moving to it: *length bytes, not ended by NUL. NULL at the end. */
const char *textfile_peek(const struct textfile *t, size_t *length);

/* The next word of the line. It may be quoted: "two words", with \" and \\ inside (see textfile_quote). */
enum status textfile_word(struct textfile *t, const char *what, char **word, struct err *err);
/* Copies the next word into `to` of `size` bytes. ST_DATA: it is too long. */
enum status textfile_word_into(struct textfile *t, const char *what, char *to, size_t size, struct err *err);
/* ST_DATA unless the next word is `word`; unless there is a next line that begins with `word`. */
enum status textfile_expect(struct textfile *t, const char *word, struct err *err);
enum status textfile_expect_line(struct textfile *t, const char *word, struct err *err);
enum status textfile_int(struct textfile *t, const char *what, int64_t min, int64_t max, int64_t *value,
                         struct err *err);
enum status textfile_double(struct textfile *t, const char *what, double *value, struct err *err);
/* A number from min to max; of at least min if max is INFINITY. */
enum status textfile_number(struct textfile *t, const char *what, double min, double max, double *value,
                            struct err *err);
/* The same of a word of the line that was read before. */
enum status textfile_number_of(const struct textfile *t, const char *word, const char *what, double min, double max,
                               double *value, struct err *err);
/* The rest of the line, without blanks at its ends (COLMAP's image names may contain blanks). ST_DATA: empty. */
enum status textfile_rest(struct textfile *t, const char *what, char **rest, struct err *err);
bool textfile_more(struct textfile *t); /* the line has another word */
/* ST_DATA if the line has another word; if the file has another record. */
enum status textfile_end(struct textfile *t, struct err *err);
enum status textfile_end_of_file(struct textfile *t, struct err *err);

/* Sets ST_DATA: "PATH:LINE: found FOUND, wanted WANTED." found is NULL at the end of a line or file. */
enum status textfile_error(const struct textfile *t, struct err *err, const char *found, const char *wanted, ...)
    PRINTF_LIKE(4, 5);
/* The same for a number. */
enum status textfile_wrong_number(const struct textfile *t, double found, const char *wanted, struct err *err);

void textfile_release(struct textfile *t);

/* Writes a word so that textfile_word() reads it back: in quotes if it is empty or contains blanks, quotes, \ or #.
 * ST_DATA: it contains a line break, or does not fit in `size` bytes. */
enum status textfile_quote(const char *word, char *out, size_t size, struct err *err);

#endif
