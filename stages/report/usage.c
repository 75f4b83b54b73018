/* usage.c - see usage.h. */
#include "stages/report/usage.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

enum { MAX_WARNINGS = 200, MAX_WARNING_LENGTH = 1000 };

/* Copies the leading letters, digits, _ and - of the line; false if there are none or more than 63. */
static bool stage_name(char name[64], const char *line, size_t size)
{
    size_t n = 0;
    while (n < size && (isalnum((unsigned char)line[n]) || line[n] == '_' || line[n] == '-')) n++;
    if (n == 0 || n > 63) return false;
    memcpy(name, line, n);
    name[n] = 0;
    return true;
}

/* Reads a number and the text after it at *at, and moves *at past both. */
static bool take_number(const char **at, const char *text, double *value)
{
    char *end;
    if (!isdigit((unsigned char)**at)) return false; /* strtod would accept spaces, signs, "inf" and "nan" */
    *value = strtod(*at, &end);
    if (!(*value <= 1e12) || strncmp(end, text, strlen(text))) return false;
    *at = end + strlen(text);
    return true;
}

bool usage_parse(struct usage *u, const char *line, size_t size)
{
    static const char USED[] = ": used ";
    char text[256];
    const char *at = text;
    struct usage found;

    if (size >= sizeof text || memchr(line, 0, size) || !stage_name(found.stage, line, size)) return false;
    memcpy(text, line, size);
    text[size] = 0;
    at += strlen(found.stage);
    if (strncmp(at, USED, strlen(USED))) return false;
    at += strlen(USED);
    if (!take_number(&at, " s wall, ", &found.wall) || !take_number(&at, " s cpu, ", &found.cpu) ||
        !take_number(&at, " MiB peak", &found.mib) || *at)
        return false;
    *u = found;
    return true;
}

static enum status find_stage(struct usage_table *table, const char *name, struct stage_usage **stage, struct err *err)
{
    for (int i = 0; i < table->stage_count; i++)
        if (!strcmp(table->stages[i].sum.stage, name)) {
            *stage = &table->stages[i];
            return ST_OK;
        }
    if (array_append(&table->stages, (size_t)table->stage_count, sizeof *table->stages, "times of stages", err))
        return err->status;
    *stage = &table->stages[table->stage_count++];
    **stage = (struct stage_usage){0};
    snprintf((*stage)->sum.stage, sizeof(*stage)->sum.stage, "%s", name);
    return ST_OK;
}

static enum status add_warning(struct usage_table *table, const char *stage, const char *log, const char *text,
                               size_t size, struct err *err)
{
    if (size > MAX_WARNING_LENGTH) size = MAX_WARNING_LENGTH;
    for (int i = 0; i < table->warning_count; i++) {
        struct log_warning *w = &table->warnings[i];
        if (!strcmp(w->stage, stage) && strlen(w->text) == size && !memcmp(w->text, text, size)) {
            w->count++;
            return ST_OK;
        }
    }
    if (table->warning_count == MAX_WARNINGS) {
        table->warnings_dropped++;
        return ST_OK;
    }
    if (array_append(&table->warnings, (size_t)table->warning_count, sizeof *table->warnings, "warnings", err))
        return err->status;
    struct log_warning *w = &table->warnings[table->warning_count];
    *w = (struct log_warning){.text = strndup(text, size), .count = 1};
    if (!w->text) return err_nomem(err, "a warning", size);
    table->warning_count++;
    snprintf(w->stage, sizeof w->stage, "%s", stage);
    const char *dot = strchr(log, '.');
    snprintf(w->item, sizeof w->item, "%s", dot ? dot + 1 : "");
    char *end = strrchr(w->item, '.');
    if (end && !strcmp(end, ".log")) *end = 0;
    return ST_OK;
}

enum status usage_add_log(struct usage_table *table, const char *name, const char *bytes, size_t size, struct err *err)
{
    static const char WARNING[] = ": warning: ";
    struct usage last = {0};
    struct stage_usage *stage = NULL;
    char log_stage[64], line_stage[64];
    bool ended = false;

    if (!stage_name(log_stage, name, strcspn(name, "."))) return ST_OK; /* not the log of a stage */
    for (size_t at = 0; at < size && !err->status;) {
        const char *line = bytes + at, *end = memchr(line, '\n', size - at);
        size_t length = end ? (size_t)(end - line) : size - at;
        at += length + 1;
        if (length && line[length - 1] == '\r') length--;
        if (usage_parse(&last, line, length)) {
            ended = true;
            continue;
        }
        if (!stage_name(line_stage, line, length)) continue;
        size_t head = strlen(line_stage) + strlen(WARNING);
        if (length >= head && !memcmp(line + strlen(line_stage), WARNING, strlen(WARNING)) && !memchr(line, 0, length))
            add_warning(table, line_stage, name, line + head, length - head, err);
    }
    if (err->status || find_stage(table, log_stage, &stage, err)) return err->status;
    stage->runs += ended;
    stage->unfinished += !ended;
    stage->sum.wall += last.wall;
    stage->sum.cpu += last.cpu;
    stage->sum.mib = fmax(stage->sum.mib, last.mib);
    return ST_OK;
}

static enum status read_all(const char *path, char **bytes, size_t *size, struct err *err)
{
    FILE *fp = fopen(path, "rb");
    size_t capacity = 0, got;

    *bytes = NULL;
    *size = 0;
    if (!fp) return err_errno(err, "open", path);
    do {
        char *grown = realloc(*bytes, capacity += 65536);
        if (!grown) {
            fclose(fp);
            free(*bytes);
            return err_nomem(err, path, capacity);
        }
        *bytes = grown;
        *size += got = fread(*bytes + *size, 1, capacity - *size, fp);
    } while (got && *size == capacity);
    if (ferror(fp)) err_errno(err, "read", path);
    fclose(fp);
    if (err->status) free(*bytes);
    return err->status;
}

static int is_log(const struct dirent *e)
{
    size_t n = strlen(e->d_name);
    return e->d_name[0] != '.' && n > 4 && !strcmp(e->d_name + n - 4, ".log");
}

enum status usage_add_folder(struct usage_table *table, const char *folder, const char *except, struct err *err)
{
    struct dirent **names = NULL;
    int count = scandir(folder, &names, is_log, alphasort);
    if (count < 0 && errno != ENOENT) err_errno(err, "list", folder);
    for (int i = 0; i < count; i++) {
        char path[4096], *bytes, *name = names[i]->d_name;
        size_t size, dot = strcspn(name, ".");
        bool skip = except && strlen(except) == dot && !memcmp(name, except, dot);
        snprintf(path, sizeof path, "%s/%s", folder, name);
        if (!skip && !err->status && !read_all(path, &bytes, &size, err)) {
            usage_add_log(table, name, bytes, size, err);
            free(bytes);
        }
        free(names[i]);
    }
    free(names);
    return err->status;
}

void usage_table_release(struct usage_table *table)
{
    for (int i = 0; i < table->warning_count; i++) free(table->warnings[i].text);
    free(table->warnings);
    free(table->stages);
    *table = (struct usage_table){0};
}
