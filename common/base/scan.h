/* scan.h - parses numbers strictly in the C locale; suggests known words; quotes text for errors. */
#ifndef REMODEL_SCAN_H
#define REMODEL_SCAN_H

#include <locale.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Parses a decimal number that is all of `text`: no blanks, hexadecimal digits, NaN or infinity. False: *value is
 * unchanged. */
bool scan_int(const char *text, int64_t *value);
bool scan_double(const char *text, double *value);

/* Whether a word can name a part of a scene: at most SCAN_NAME letters, digits, _ and -, not - first, not a number. */
enum { SCAN_NAME = 64 };
bool scan_is_name(const char *word);

/* Whether a word is the name of a file with that ending that rules of Make can name: letters, digits and _ - . @ +, not
 * . first. */
bool scan_is_file_name(const char *word, const char *ending);
/* Whether it can be the name of a photo, without the ending of its file: letters, digits, _, - and @. */
bool scan_is_photo_name(const char *word);

locale_t scan_c_locale(void); /* for uselocale() around code that prints numbers */

/* The known word nearest to `word` in edit distance, for "did you mean"; NULL if none is near. next(ctx, i) returns the
 * i-th known word, NULL after the last. */
const char *scan_nearest(const char *word, const char *(*next)(const void *ctx, int i), const void *ctx);

/* Quotes `found` for an error message: at most 40 characters, those that nobody can see escaped. Returns `shown`. */
#define SCAN_QUOTED 200
const char *scan_quote(char shown[SCAN_QUOTED], const char *found);

#endif
