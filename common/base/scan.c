/* scan.c - parses numbers; finds the nearest known word; quotes text for errors. */
#include "common/base/scan.h"

#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static locale_t c_locale;
static pthread_once_t c_locale_once = PTHREAD_ONCE_INIT;

static void make_c_locale(void) { c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0); }

locale_t scan_c_locale(void)
{
    pthread_once(&c_locale_once, make_c_locale);
    return c_locale;
}

static bool digit(char c) { return c >= '0' && c <= '9'; }

bool scan_int(const char *text, int64_t *value)
{
    const char *p = text + (*text == '-' || *text == '+');
    const bool negative = *text == '-';
    int64_t v = 0;

    if (!*p) return false;
    for (; *p; p++) {
        if (!digit(*p)) return false;
        /* negative sums, because INT64_MIN has no positive counterpart */
        if (__builtin_mul_overflow(v, 10, &v) || __builtin_sub_overflow(v, *p - '0', &v)) return false;
    }
    if (!negative && __builtin_sub_overflow(0, v, &v)) return false;
    *value = v;
    return true;
}

bool scan_double(const char *text, double *value)
{
    char *end = NULL;
    const char *p = text + (*text == '-' || *text == '+');

    /* strtod() would also accept leading blanks, 0x1p3, "nan" and "infinity" */
    if (!digit(*p) && !(*p == '.' && digit(p[1]))) return false;
    if (*p == '0' && (p[1] == 'x' || p[1] == 'X')) return false;
    const double v = strtod_l(text, &end, scan_c_locale());
    if (*end || !isfinite(v)) return false;
    *value = v;
    return true;
}

#define NAME_LETTERS "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-"

bool scan_is_name(const char *word)
{
    const size_t length = strlen(word);
    double number;
    return length && length <= SCAN_NAME && word[0] != '-' && strspn(word, NAME_LETTERS) == length &&
           !scan_double(word, &number);
}

bool scan_is_file_name(const char *word, const char *ending)
{
    const size_t length = strlen(word), tail = strlen(ending);
    return length > tail && word[0] != '.' && strspn(word, NAME_LETTERS ".@+") == length &&
           !strcmp(word + length - tail, ending);
}

bool scan_is_photo_name(const char *word) { return *word && !word[strspn(word, NAME_LETTERS "@")]; }

/* Damerau-Levenshtein distance (optimal string alignment): insertions, deletions, replacements, swaps of neighbours.
 * Words longer than MAX_WORD count as far from everything. */
enum { MAX_WORD = 63 };

static int distance(const char *a, const char *b)
{
    int rows[3][MAX_WORD + 1];
    const size_t na = strlen(a), nb = strlen(b);

    if (na > MAX_WORD || nb > MAX_WORD) return MAX_WORD;
    for (size_t j = 0; j <= nb; j++) rows[0][j] = (int)j;
    for (size_t i = 1; i <= na; i++) {
        int *row = rows[i % 3];
        const int *above = rows[(i + 2) % 3], *above2 = rows[(i + 1) % 3];
        row[0] = (int)i;
        for (size_t j = 1; j <= nb; j++) {
            int min = above[j - 1] + (a[i - 1] != b[j - 1]);
            if (above[j] + 1 < min) min = above[j] + 1;
            if (row[j - 1] + 1 < min) min = row[j - 1] + 1;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && above2[j - 2] + 1 < min)
                min = above2[j - 2] + 1;
            row[j] = min;
        }
    }
    return rows[na % 3][nb];
}

const char *scan_nearest(const char *word, const char *(*next)(const void *ctx, int i), const void *ctx)
{
    const char *nearest = NULL, *known;
    int min = 1 + (int)strlen(word) / 3; /* a larger distance gives no suggestion */

    for (int i = 0; (known = next(ctx, i)); i++) {
        const int d = distance(word, known);
        if (d <= min && (!nearest || d < min)) {
            min = d;
            nearest = known;
        }
    }
    return nearest;
}

/* Bytes of the character at p if nobody can see it, or tell it from a blank: a no-break space, a byte order mark, marks
 * of zero width; its code goes to *code. 0: another character. */
static int unseen(const char *p, unsigned *code)
{
    static const unsigned ranges[][2] = {{0x80, 0xA0},     {0xAD, 0xAD},     {0x2000, 0x200F}, {0x2028, 0x202F},
                                         {0x205F, 0x206F}, {0x3000, 0x3000}, {0xFEFF, 0xFEFF}};
    const unsigned char *c = (const unsigned char *)p;
    int length = 0;
    if ((c[0] & 0xE0) == 0xC0 && (c[1] & 0xC0) == 0x80) {
        *code = (c[0] & 0x1Fu) << 6 | (c[1] & 0x3Fu);
        length = 2;
    } else if ((c[0] & 0xF0) == 0xE0 && (c[1] & 0xC0) == 0x80 && (c[2] & 0xC0) == 0x80) {
        *code = (c[0] & 0x0Fu) << 12 | (c[1] & 0x3Fu) << 6 | (c[2] & 0x3Fu);
        length = 3;
    }
    for (size_t i = 0; length && i < sizeof ranges / sizeof *ranges; i++)
        if (*code >= ranges[i][0] && *code <= ranges[i][1]) return length;
    return 0;
}

const char *scan_quote(char shown[SCAN_QUOTED], const char *found)
{
    size_t n = 0;
    int characters = 0;
    const char *p = found;

    shown[n++] = '"';
    for (; *p; p++) {
        const unsigned char c = (unsigned char)*p;
        const bool continued = (c & 0xC0) == 0x80; /* inside a UTF-8 character */
        unsigned code = 0;
        int length;
        if ((!continued && characters == 40) || n > SCAN_QUOTED - 12) break;
        characters += !continued;
        if (c == '\t' || c == '\r' || c == '\n')
            n += (size_t)sprintf(shown + n, "\\%c", c == '\t' ? 't' : c == '\r' ? 'r' : 'n');
        else if (c < 0x20 || c == 0x7F)
            n += (size_t)sprintf(shown + n, "\\x%02x", c);
        else if ((length = unseen(p, &code)))
            n += (size_t)sprintf(shown + n, "\\u%04x", code), p += length - 1;
        else
            shown[n++] = (char)c;
    }
    shown[n++] = '"';
    strcpy(shown + n, *p ? "..." : "");
    return shown;
}
