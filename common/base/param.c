/* param.c - reads, checks and prints parameters.
 *
 * Config files are INI files in the dialect of inih: "[section]", "key = value", comments that begin with # or ; at the
 * start of a line, or with " ;" after a value. */
#include "common/base/param.h"

#include <ini.h>
#include <inttypes.h>
#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/scan.h"
#include "common/base/textfile.h"

/* Names for suggestions. */
static const char *table_name(const void *ctx, int i) { return ((const struct param *)ctx)[i].name; }

static const struct param *find(const struct param *table, const char *name)
{
    for (; table->name; table++)
        if (!strcmp(table->name, name)) return table;
    return NULL;
}

static bool is_choice(const char *choices, const char *word)
{
    const size_t n = strlen(word);

    for (const char *p = choices; n; p++) {
        const size_t m = strcspn(p, "|");
        if (m == n && !memcmp(p, word, n)) return true;
        p += m;
        if (!*p) break;
    }
    return false;
}

/* Text must read back unchanged from params_print(): no line breaks, no blanks at the ends, nothing that begins a
 * comment. */
static bool reads_back(const char *text)
{
    const size_t n = strlen(text);

    if (n && (strchr(" \t", text[0]) || strchr(" \t", text[n - 1]) || text[0] == ';')) return false;
    for (const char *p = text; *p; p++)
        if ((unsigned char)*p < 0x20 || *p == 0x7F || (strchr(" \t", *p) && p[1] == ';')) return false;
    return true;
}

/* `where` is the start of the error: "a.cfg:3: " or "--set ". */
static enum status assign(const struct param *p, void *values, const char *value, const char *where, struct err *err)
{
    void *to = (char *)values + p->offset;
    char shown[SCAN_QUOTED];
    int64_t i;
    double d;

    switch (p->kind) {
    case PARAM_int:
        if (!scan_int(value, &i) || (double)i < p->min || (double)i > p->max || i < INT_MIN || i > INT_MAX)
            return err_set(err, ST_USAGE, "%s%s = %s, wanted an integer from %.0f to %.0f%s%s.", where, p->name,
                           scan_quote(shown, value), p->min, p->max, *p->unit ? " " : "", p->unit);
        *(int *)to = (int)i;
        return ST_OK;
    case PARAM_double:
        if (!scan_double(value, &d) || d < p->min || d > p->max)
            return err_set(err, ST_USAGE, "%s%s = %s, wanted a number from %.10g to %.10g%s%s.", where, p->name,
                           scan_quote(shown, value), p->min, p->max, *p->unit ? " " : "", p->unit);
        *(double *)to = d + 0.0; /* -0 becomes 0, so that equal parameters print the same bytes */
        return ST_OK;
    case PARAM_choice:
        if (!is_choice(p->unit, value))
            return err_set(err, ST_USAGE, "%s%s = %s, wanted one of %s.", where, p->name, scan_quote(shown, value),
                           p->unit);
        break;
    case PARAM_text:
        if (!reads_back(value))
            return err_set(
                err, ST_USAGE,
                "%s%s = %s, wanted text without control characters, blanks at the ends, or a blank before ';'.", where,
                p->name, scan_quote(shown, value));
        break;
    }
    if (strlen(value) >= PARAM_TEXT_SIZE)
        return err_set(err, ST_USAGE, "%s%s = %s has %zu bytes, wanted at most %d.", where, p->name,
                       scan_quote(shown, value), strlen(value), PARAM_TEXT_SIZE - 1);
    memset(to, 0, PARAM_TEXT_SIZE);
    strcpy(to, value);
    return ST_OK;
}

static enum status unknown(const struct param *table, const char *name, const char *where, struct err *err)
{
    const char *near = scan_nearest(name, table_name, table);
    char shown[SCAN_QUOTED];

    return err_set(err, ST_USAGE, "%sunknown parameter %s%s%s%s", where, scan_quote(shown, name),
                   near           ? "; did you mean "
                   : !table->name ? "; this stage has no parameters"
                                  : "; --help lists them",
                   near ? near : "", near ? "?" : ".");
}

struct config_reader {
    const struct param *table;
    void *values;
    const char *section, *path;
    const char *at; /* the next line */
    int line;       /* number of the line that inih is parsing */
    int *given;     /* line of each parameter; 0: not set */
    struct err *err;
    enum status status;
};

static void where_text(const struct config_reader *r, char *where, size_t size)
{
    snprintf(where, size, "%s:%d: ", r->path, r->line);
}

/* Replaces fgets() for inih. Drops leading blanks, since inih takes an indented line for a continuation, and skips
 * comments of any length. */
static char *read_line(char *to, int room, void *ctx)
{
    struct config_reader *r = ctx;

    if (r->status || !*r->at) return NULL;
    r->line++;
    const char *begin = r->at, *end = begin + strcspn(begin, "\n");
    r->at = *end ? end + 1 : end;
    while (*begin == ' ' || *begin == '\t') begin++;
    while (end > begin && strchr(" \t\r", end[-1])) end--;
    if (*begin == '#' || *begin == ';') end = begin;
    if (end - begin > room - 2) {
        r->status = err_set(r->err, ST_USAGE, "%s:%d: the line has %td bytes, wanted at most %d; shorten it.", r->path,
                            r->line, end - begin, room - 2);
        return NULL;
    }
    memcpy(to, begin, (size_t)(end - begin));
    strcpy(to + (end - begin), "\n");
    return to;
}

static int take_pair(void *ctx, const char *section, const char *name, const char *value)
{
    struct config_reader *r = ctx;
    char where[512], shown[SCAN_QUOTED];

    if (r->status) return 1;
    where_text(r, where, sizeof where);
    if (!*section) {
        r->status = err_set(r->err, ST_USAGE,
                            "%s%s comes before the first [section]; move it below its stage's section, such as [%s].",
                            where, scan_quote(shown, name), r->section);
    } else if (!strcmp(section, r->section)) {
        const struct param *p = find(r->table, name);
        if (!p)
            r->status = unknown(r->table, name, where, r->err);
        else if (r->given[p - r->table])
            r->status = err_set(r->err, ST_USAGE, "%s%s is set twice, first in line %d; keep one.", where, name,
                                r->given[p - r->table]);
        else
            r->status = assign(p, r->values, value, where, r->err);
        if (p) r->given[p - r->table] = r->line;
    }
    return 1;
}

enum status params_read_file(const struct param *table, void *values, const char *section, const char *path,
                             struct err *err)
{
    struct textfile file = {0};
    struct config_reader r = {.table = table, .values = values, .section = section, .path = path, .err = err};
    char shown[SCAN_QUOTED];
    size_t count = 0;

    while (table[count].name) count++;
    if ((r.status = textfile_open(&file, path, err))) goto done;
    if (!(r.given = calloc(count + 1, sizeof *r.given))) {
        r.status = err_nomem(err, "a config file", (count + 1) * sizeof *r.given);
        goto done;
    }
    /* inih's limit of 200 bytes a line is too small for the twelve parameters of a lens */
    enum { INI_LINE = 1024 };
    ini_use_stack = false;
    ini_initial_alloc = INI_LINE;
    r.at = file.bytes;
    const int bad = ini_parse_stream(read_line, &r, take_pair, &r);
    if (!r.status && bad > 0) {
        file.at = 0;
        while (file.line < bad && textfile_next_raw(&file)) continue;
        r.status = err_set(err, ST_USAGE, "%s:%d: found %s, wanted [section], key = value, or a # comment.", path, bad,
                           scan_quote(shown, file.cursor));
    }
    if (!r.status && bad < 0) r.status = err_nomem(err, "a line of a config file", INI_LINE);
done:
    if (r.status == ST_IO || r.status == ST_DATA) { /* an unreadable config file is a usage error */
        r.status = ST_USAGE;
        err->status = ST_USAGE;
    }
    free(r.given);
    textfile_release(&file);
    return r.status;
}

enum status params_set(const struct param *table, void *values, const char *assignment, struct err *err)
{
    const char *equals = strchr(assignment, '=');
    char name[64], shown[SCAN_QUOTED];

    if (!equals || equals == assignment)
        return err_set(err, ST_USAGE, "--set %s: wanted key=value.", scan_quote(shown, assignment));
    snprintf(name, sizeof name, "%.*s", (int)(equals - assignment), assignment);
    const struct param *p = find(table, name);
    return p ? assign(p, values, equals + 1, "--set ", err) : unknown(table, name, "--set: ", err);
}

/* Prints the fewest digits, at least 6, that read back as the same double. */
static void print_double(double value, FILE *to)
{
    char text[32];
    for (int digits = 6; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value) break;
    }
    fputs(text, to);
}

static void print_value(const struct param *p, const void *values, FILE *to)
{
    const void *v = (const char *)values + p->offset;

    if (p->kind == PARAM_int)
        fprintf(to, "%d", *(const int *)v);
    else if (p->kind == PARAM_double)
        print_double(*(const double *)v, to);
    else
        fputs(v, to);
}

void params_print(const struct param *table, const void *values, const char *section, FILE *to)
{
    const locale_t old = uselocale(scan_c_locale());

    fprintf(to, "[%s]\n", section);
    for (const struct param *p = table; p->name; p++) {
        const bool empty = p->kind == PARAM_text && !*((const char *)values + p->offset);
        fprintf(to, empty ? "%s =" : "%s = ", p->name);
        print_value(p, values, to);
        fputc('\n', to);
    }
    uselocale(old);
}

/* Prints text as a comment, broken at blanks into lines of at most COLUMNS characters. */
static void print_comment(const char *text, FILE *to)
{
    enum { COLUMNS = 120 };
    int column = 0;

    while (*text) {
        const size_t word = strcspn(text, " ");
        if (!column || column + 1 + (int)word > COLUMNS) {
            column = fprintf(to, column ? "\n#" : "#") - (column > 0);
        }
        column += fprintf(to, " %.*s", (int)word, text);
        text += word;
        while (*text == ' ') text++;
    }
    fputc('\n', to);
}

void params_explain(const struct param *table, const void *values, const char *section, FILE *to)
{
    const locale_t old = uselocale(scan_c_locale());
    char text[2048];

    fprintf(to, "[%s]\n", section);
    for (const struct param *p = table; p->name; p++) {
        const bool empty = p->kind == PARAM_text && !*((const char *)values + p->offset);
        if (p->kind == PARAM_choice)
            snprintf(text, sizeof text, "%s (one of %s)", p->help, p->unit);
        else if (p->kind == PARAM_text)
            snprintf(text, sizeof text, "%s", p->help);
        else
            snprintf(text, sizeof text, "%s (%s%sfrom %.10g to %.10g)", p->help, p->unit, *p->unit ? ", " : "", p->min,
                     p->max);
        print_comment(text, to);
        fprintf(to, empty ? "%s =" : "%s = ", p->name);
        print_value(p, values, to);
        fputc('\n', to);
    }
    uselocale(old);
}

void params_help(const struct param *table, const void *values, FILE *to)
{
    const locale_t old = uselocale(scan_c_locale());

    for (const struct param *p = table; p->name; p++) {
        fprintf(to, "  %-20s %s\n%23s", p->name, p->help, "");
        fputs(p->kind == PARAM_text || p->kind == PARAM_choice ? "default \"" : "default ", to);
        print_value(p, values, to);
        if (p->kind == PARAM_choice)
            fprintf(to, "\", one of %s", p->unit);
        else if (p->kind == PARAM_text)
            fputc('"', to);
        else
            fprintf(to, "%s%s, from %.10g to %.10g", *p->unit ? " " : "", p->unit, p->min, p->max);
        fputc('\n', to);
    }
    uselocale(old);
}
