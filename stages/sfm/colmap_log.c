/* colmap_log.c - reading COLMAP's logs. */
#include "stages/sfm/colmap_log.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/textfile.h"

/* The text after `key` if the line begins with it, otherwise NULL. */
static const char *value_of(const char *line, const char *key)
{
    line += strspn(line, " \t");
    if (strncmp(line, key, strlen(key))) return NULL;
    line += strlen(key);
    return line + strspn(line, " \t");
}

enum status colmap_counts_read(struct feature_counts *c, const char *log, struct err *err)
{
    struct textfile t = {0};
    *c = (struct feature_counts){0};
    textfile_open(&t, log, err);
    while (!err->status && textfile_next_raw(&t)) {
        const char *name = value_of(t.cursor, "Name:"), *features = value_of(t.cursor, "Features:");
        if (features && c->count) c->list[c->count - 1].features = (int)strtol(features, NULL, 10);
        if (!name) continue;
        if (array_append(&c->list, (size_t)c->count, sizeof *c->list, "feature counts", err)) break;
        c->list[c->count] = (struct feature_count){strdup(name), -1};
        if (!c->list[c->count++].name) err_nomem(err, "a name", strlen(name) + 1);
    }
    textfile_release(&t);
    if (err->status) colmap_counts_release(c);
    return err->status;
}

void colmap_counts_release(struct feature_counts *c)
{
    if (!c) return;
    for (int i = 0; i < c->count; i++) free(c->list[i].name);
    free(c->list);
    *c = (struct feature_counts){0};
}

/* The line is "Loading images... 11 in 0.000s (connected 9)". */
int colmap_log_connected(const char *log)
{
    struct textfile t = {0};
    struct err ignored = ERR_INIT;
    int found = -1;
    if (textfile_open(&t, log, &ignored)) return -1;
    while (textfile_next_raw(&t)) {
        const char *at = strstr(t.cursor, "Loading images"), *connected = at ? strstr(at, "(connected ") : NULL;
        if (connected) found = (int)strtol(connected + strlen("(connected "), NULL, 10);
    }
    textfile_release(&t);
    return found;
}

void colmap_log_last_line(char *text, size_t size, const char *log)
{
    struct textfile t = {0};
    struct err ignored = ERR_INIT;
    *text = '\0';
    if (textfile_open(&t, log, &ignored)) return;
    while (textfile_next_raw(&t)) {
        const char *p = t.cursor + strspn(t.cursor, " \t");
        if (isalpha((unsigned char)*p)) snprintf(text, size, "%s", p);
    }
    textfile_release(&t);
}

void colmap_counts_list_poor(char *text, size_t size, const struct feature_counts *c, const struct photo_list *photos,
                             int min_features)
{
    size_t used = 0;
    int named = 0, omitted = 0;
    *text = '\0';
    for (int i = 0; i < photos->count; i++) {
        const struct photo_record *p = &photos->photos[i];
        size_t stem = strlen(p->id);
        int features = -1;
        for (int k = 0; k < c->count; k++)
            if (!strncmp(c->list[k].name, p->id, stem) && c->list[k].name[stem] == '.') features = c->list[k].features;
        if (features >= min_features) continue;
        if (used + strlen(p->file) + 40 > size) {
            omitted++;
            continue;
        }
        used += (size_t)snprintf(text + used, size - used, features < 0 ? "%s%s (unreadable)" : "%s%s (%d)",
                                 named++ ? ", " : "", p->file, features);
    }
    if (omitted) snprintf(text + used, size - used, " and %d more", omitted);
}
