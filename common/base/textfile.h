/* textfile.h - line-based text records, with errors that name file, line, what was found and what was wanted.
 *
 *   struct textfile t = {0};
 *   if (textfile_open(&t, path, err)) return err->status;
 *   while (!st && textfile_next(&t)) {            // skips blank lines and lines that begin with #
 *       st = textfile_int(&t, "camera id", 0, INT_MAX, &id, err) || textfile_word(&t, "model", &word, err)
 *         || textfile_end(&t, err);
 *   }
 *   textfile_release(&t);
 *
 * The whole file is read at once; words point into its buffer and live until textfile_release(). Numbers are read in
 * the C locale; NaN and infinity are refused. A NUL byte in the file is an error. */
#ifndef REMODEL_TEXTFILE_H
#define REMODEL_TEXTFILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "common/base/err.h"

struct textfile {
    char *path, *bytes; /* owned */
    size_t size, at;    /* where the next line begins */
    char *cursor;       /* the rest of the current line */
    int line;           /* of the current line, from 1 */
};

enum status textfile_open(struct textfile *t, const char *path, struct err *err);

bool textfile_next(struct textfile *t); /* next record; false at the end */
bool textfile_next_raw(
    struct textfile *t); /* next line even if blank or a comment (COLMAP's images.txt has blank ones) */

/* Next word of the line. A word may be quoted: "two words", with \" and \\ inside (see textfile_quote). */
enum status textfile_word(struct textfile *t, const char *what, char **word, struct err *err);
/* The next word must be this one; the next line must begin with this word. */
enum status textfile_expect(struct textfile *t, const char *word, struct err *err);
enum status textfile_expect_line(struct textfile *t, const char *word, struct err *err);
enum status textfile_int(struct textfile *t, const char *what, int64_t least, int64_t most, int64_t *value,
                         struct err *err);
enum status textfile_double(struct textfile *t, const char *what, double *value, struct err *err);
/* All that is left of the line, blanks at both ends removed (COLMAP's image names hold blanks); may not be empty. */
enum status textfile_rest(struct textfile *t, const char *what, char **rest, struct err *err);
bool textfile_more(struct textfile *t); /* another word stands on this line */
enum status textfile_end(struct textfile *t, struct err *err);
enum status textfile_end_of_file(struct textfile *t, struct err *err); /* no record may follow */

/* "PATH:LINE: found FOUND, wanted WANTED." as ST_DATA; found NULL means the end of the line. */
enum status textfile_error(const struct textfile *t, struct err *err, const char *found, const char *wanted, ...)
    PRINTF_LIKE(4, 5);
/* The same, of a number that was read. */
enum status textfile_wrong_number(const struct textfile *t, double found, const char *wanted, struct err *err);

void textfile_release(struct textfile *t);

/* Writes a word so that textfile_word() reads it back: quoted if it is empty or holds blanks, quotes, \ or #. A line
 * break cannot be written: returns ST_DATA. */
enum status textfile_quote(const char *word, char *out, size_t size, struct err *err);

#endif
