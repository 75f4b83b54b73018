/* textfile.c - reads line-based text records.
 *
 * The whole file is read into one buffer, and words are cut out of it in place by writing NULs over the blanks: no
 * copies, and a word lasts as long as the file. Words in quotes may hold blanks; \" and \\ are unescaped in place,
 * which never makes them longer. Lines that are blank or begin with # are skipped; \r before the end of a line is
 * dropped. A byte order mark before the first line is skipped.
 *
 * Errors. Every function says what it wants (`what`), so a message has file, line, what was found and what was
 * wanted. A NUL byte means that the file is damaged or no text, and is an error of its line.
 *
 * The buffer has one byte more than the file: the end is met by one read, and a file that grows meanwhile is read to
 * its end. Memory is that of the file. */
#include "common/base/textfile.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/scan.h"

static bool blank(char c) { return c == ' ' || c == '\t'; }

static char *skip_blanks(char *p)
{
    while (blank(*p)) p++;
    return p;
}

enum status textfile_open(struct textfile *t, const char *path, struct err *err)
{
    struct file_bytes file = {0};
    *t = (struct textfile){0};
    return file_bytes_read(&file, path, err) || textfile_take(t, &file, path, err) ? err->status : ST_OK;
}

/* What some editors write before the text. */
static bool begins_with_mark(const struct textfile *t, const char *mark)
{
    const size_t n = strlen(mark);
    return t->size >= n && !memcmp(t->bytes, mark, n);
}

/* A program's text, which says so at its top, ends with a line break: another end means that it was cut off. People's
 * texts and scripts, which people go on with, need not end so. */
static bool is_cut(const struct textfile *t)
{
    static const char made[] = "# remodel ", script[] = "remodel-script ";
    bool ours = false;

    if (!t->size || t->bytes[t->size - 1] == '\n') return false;
    for (size_t at = 0, heads = 0; at < t->size && heads < 2;) {
        const char *line = t->bytes + at, *end = memchr(line, '\n', t->size - at);
        const size_t n = end ? (size_t)(end - line) : t->size - at;
        if (n >= strlen(script) && !memcmp(line, script, strlen(script))) return false;
        ours = ours || (n >= strlen(made) && !memcmp(line, made, strlen(made)));
        heads += *line != '#';
        at += n + 1;
    }
    return ours;
}

enum status textfile_take(struct textfile *t, struct file_bytes *file, const char *path, struct err *err)
{
    const char *nul;

    *t = (struct textfile){.path = strdup(path), .bytes = file->bytes, .size = file->size};
    *file = (struct file_bytes){0};
    if (!t->path) {
        err_nomem(err, "a file name", strlen(path) + 1);
    } else if (begins_with_mark(t, "\xFF\xFE") || begins_with_mark(t, "\xFE\xFF")) {
        t->line = 1;
        textfile_error(t, err, "a byte order mark of UTF-16", "UTF-8; save the file as UTF-8 or plain text");
    } else if ((nul = memchr(t->bytes, '\0', t->size))) {
        for (const char *p = t->bytes; p < nul; p++) t->line += *p == '\n';
        t->line++;
        textfile_error(t, err, "\\0", "text without NUL bytes; the file is damaged or not a text file");
    } else if (is_cut(t)) {
        for (size_t i = 0; i < t->size; i++) t->line += t->bytes[i] == '\n';
        t->line++;
        textfile_error(t, err, NULL, "a line break at the end of the file; it was cut off, so make or copy it again");
    }
    if (!err->status && begins_with_mark(t, "\xEF\xBB\xBF")) t->at = 3;
    if (err->status) textfile_release(t);
    return err->status;
}

bool textfile_next_raw(struct textfile *t)
{
    if (t->at >= t->size) {
        t->cursor = NULL;
        return false;
    }
    char *begin = t->bytes + t->at, *end = memchr(begin, '\n', t->size - t->at);
    if (!end) end = t->bytes + t->size;
    t->at = (size_t)(end - t->bytes) + 1;
    if (end > begin && end[-1] == '\r') end--;
    *end = '\0';
    t->cursor = begin;
    t->line++;
    return true;
}

const char *textfile_peek(const struct textfile *t, size_t *length)
{
    if (t->at >= t->size) return NULL;
    const char *begin = t->bytes + t->at, *end = memchr(begin, '\n', t->size - t->at);
    *length = end ? (size_t)(end - begin) : t->size - t->at;
    return begin;
}

bool textfile_next(struct textfile *t)
{
    while (textfile_next_raw(t)) {
        t->cursor = skip_blanks(t->cursor);
        if (*t->cursor && *t->cursor != '#') return true;
    }
    return false;
}

/* Unescapes a quoted word in place; p points after the opening quote. */
static enum status quoted_word(struct textfile *t, const char *what, char *p, struct err *err)
{
    char *to = p;

    for (; *p && *p != '"'; p++) {
        if (*p == '\\' && *++p != '"' && *p != '\\')
            return textfile_error(t, err, p - 1, "\\\" or \\\\ inside the quotes of %s", what);
        *to++ = *p;
    }
    if (!*p) return textfile_error(t, err, NULL, "the closing quote of %s", what);
    p++;
    if (*p && !blank(*p)) return textfile_error(t, err, p, "a blank after the closing quote of %s", what);
    t->cursor = p;
    *to = '\0';
    return ST_OK;
}

enum status textfile_word(struct textfile *t, const char *what, char **word, struct err *err)
{
    char *p = t->cursor ? skip_blanks(t->cursor) : NULL;

    if (!p || !*p) return textfile_error(t, err, NULL, "%s", what);
    if (*p == '"') {
        if (!quoted_word(t, what, p + 1, err)) *word = p + 1;
        return err->status;
    }
    *word = p;
    while (*p && !blank(*p)) p++;
    t->cursor = *p ? p + 1 : p;
    *p = '\0';
    return ST_OK;
}

static enum status expect(struct textfile *t, const char *word, const char *wanted, struct err *err)
{
    char *found = NULL;

    if (!textfile_word(t, wanted, &found, err) && strcmp(found, word)) textfile_error(t, err, found, "%s", wanted);
    return err->status;
}

enum status textfile_expect(struct textfile *t, const char *word, struct err *err)
{
    char wanted[64];

    snprintf(wanted, sizeof wanted, "\"%s\"", word);
    return expect(t, word, wanted, err);
}

enum status textfile_word_into(struct textfile *t, const char *what, char *to, size_t size, struct err *err)
{
    char *word = NULL;

    if (textfile_word(t, what, &word, err)) return err->status;
    if (strlen(word) >= size) return textfile_error(t, err, word, "%s of at most %zu bytes", what, size - 1);
    memcpy(to, word, strlen(word) + 1);
    return ST_OK;
}

enum status textfile_expect_line(struct textfile *t, const char *word, struct err *err)
{
    char wanted[64];

    snprintf(wanted, sizeof wanted, "a line \"%s ...\"", word);
    return textfile_next(t) ? expect(t, word, wanted, err) : textfile_error(t, err, NULL, "%s", wanted);
}

enum status textfile_int(struct textfile *t, const char *what, int64_t min, int64_t max, int64_t *value,
                         struct err *err)
{
    char *word;
    int64_t v;
    if (textfile_word(t, what, &word, err)) return err->status;
    if (!scan_int(word, &v) || v < min || v > max)
        return textfile_error(t, err, word, "%s, an integer from %" PRId64 " to %" PRId64, what, min, max);
    *value = v;
    return ST_OK;
}

enum status textfile_double(struct textfile *t, const char *what, double *value, struct err *err)
{
    char *word;
    if (textfile_word(t, what, &word, err)) return err->status;
    if (!scan_double(word, value)) return textfile_error(t, err, word, "%s, a finite number", what);
    return ST_OK;
}

enum status textfile_number_of(const struct textfile *t, const char *word, const char *what, double min, double max,
                               double *value, struct err *err)
{
    if (scan_double(word, value) && *value >= min && *value <= max) return ST_OK;
    if (isinf(max)) return textfile_error(t, err, word, "%s, a number of at least %.9g", what, min);
    return textfile_error(t, err, word, "%s, a number from %.9g to %.9g", what, min, max);
}

enum status textfile_number(struct textfile *t, const char *what, double min, double max, double *value,
                            struct err *err)
{
    char *word;
    if (textfile_word(t, what, &word, err)) return err->status;
    return textfile_number_of(t, word, what, min, max, value, err);
}

enum status textfile_rest(struct textfile *t, const char *what, char **rest, struct err *err)
{
    char *p = t->cursor ? skip_blanks(t->cursor) : NULL;

    if (!p || !*p) return textfile_error(t, err, NULL, "%s", what);
    char *end = p + strlen(p);
    t->cursor = end;
    while (blank(end[-1])) end--;
    *end = '\0';
    *rest = p;
    return ST_OK;
}

bool textfile_more(struct textfile *t) { return t->cursor && *skip_blanks(t->cursor); }

enum status textfile_end(struct textfile *t, struct err *err)
{
    if (!textfile_more(t)) return ST_OK;
    return textfile_error(t, err, skip_blanks(t->cursor), "the end of the line");
}

enum status textfile_end_of_file(struct textfile *t, struct err *err)
{
    char *rest = NULL;

    if (!textfile_next(t)) return ST_OK;
    if (!textfile_rest(t, "a line", &rest, err)) textfile_error(t, err, rest, "the end of the file");
    return err->status;
}

enum status textfile_wrong_number(const struct textfile *t, double found, const char *wanted, struct err *err)
{
    char text[32];

    snprintf(text, sizeof text, "%.9g", found);
    return textfile_error(t, err, text, "%s", wanted);
}

enum status textfile_error(const struct textfile *t, struct err *err, const char *found, const char *wanted, ...)
{
    char text[1024], shown[SCAN_QUOTED];
    va_list args;

    va_start(args, wanted);
    vsnprintf(text, sizeof text, wanted, args);
    va_end(args);
    if (!t->line) return err_set(err, ST_DATA, "%s: found an empty file, wanted %s.", t->path, text);
    return err_set(err, ST_DATA, "%s:%d: found %s, wanted %s.", t->path, t->line,
                   found       ? scan_quote(shown, found)
                   : t->cursor ? "the end of the line"
                               : "the end of the file",
                   text);
}

void textfile_release(struct textfile *t)
{
    if (!t) return;
    free(t->path);
    free(t->bytes);
    *t = (struct textfile){0};
}

enum status textfile_quote(const char *word, char *out, size_t size, struct err *err)
{
    const bool plain = *word && !strpbrk(word, " \t\"\\#");
    char shown[SCAN_QUOTED];
    size_t need = plain ? 1 : 3; /* the final NUL, and two quotes */

    if (strpbrk(word, "\n\r"))
        return err_set(err, ST_DATA, "the name %s contains a line break, which a text file cannot hold; rename it.",
                       scan_quote(shown, word));
    for (const char *p = word; *p; p++) need += 1 + (*p == '"' || *p == '\\');
    if (need > size)
        return err_set(err, ST_DATA, "the name %s is longer than %zu bytes; shorten it.", scan_quote(shown, word),
                       size);
    if (!plain) *out++ = '"';
    for (const char *p = word; *p; p++) {
        if (*p == '"' || *p == '\\') *out++ = '\\';
        *out++ = *p;
    }
    if (!plain) *out++ = '"';
    *out = '\0';
    return ST_OK;
}
