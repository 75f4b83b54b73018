/* scan.h - numbers and words as people type them: strict, in the C locale, with a guess at what was meant. */
#ifndef REMODEL_SCAN_H
#define REMODEL_SCAN_H

#include <locale.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A decimal number that fills all of `text`: no blanks, no hexadecimal, no NaN or infinity. */
bool scan_int(const char *text, int64_t *value);
bool scan_double(const char *text, double *value);

locale_t scan_c_locale(void); /* for uselocale() around printing numbers */

/* The known word nearest to `word`, or NULL if none is near enough to be what was meant. next(ctx, i) is the i-th known
 * word, NULL after the last. */
const char *scan_nearest(const char *word, const char *(*next)(const void *ctx, int i), const void *ctx);

/* `found` as an error message may show it: in quotes, at most 40 characters of it, control characters escaped. */
#define SCAN_SHOWN 200
const char *scan_show(char shown[SCAN_SHOWN], const char *found);

#endif
