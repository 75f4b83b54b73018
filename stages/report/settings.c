/* settings.c - see settings.h. */
#include "stages/report/settings.h"

#include <dirent.h>
#include <errno.h>
#include <ini.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_bytes.h"

static struct setting *find(const struct settings *s, const char *section, const char *key)
{
    for (int i = 0; i < s->count; i++)
        if (!strcmp(s->items[i].section, section) && !strcmp(s->items[i].key, key)) return &s->items[i];
    return NULL;
}

struct reader {
    struct settings *settings;
    struct err *err;
};

/* Callback of ini_parse(); 0 stops it at the line. */
static int add_setting(void *user, const char *section, const char *key, const char *value)
{
    const struct reader *reader = user;
    struct settings *s = reader->settings;
    struct setting *item = find(s, section, key);
    if (!item) {
        int at = s->count; /* after the last item of its section */
        for (int i = 0; i < s->count; i++)
            if (!strcmp(s->items[i].section, section)) at = i + 1;
        if (array_append(&s->items, (size_t)s->count, sizeof *s->items, "parameters", reader->err)) return 0;
        item = &s->items[at];
        memmove(item + 1, item, (size_t)(s->count++ - at) * sizeof *item);
        *item = (struct setting){0};
        snprintf(item->section, sizeof item->section, "%s", section);
        snprintf(item->key, sizeof item->key, "%s", key);
    }
    snprintf(item->value, sizeof item->value, "%s", value);
    return 1;
}

enum status settings_add_file(struct settings *s, const char *path, struct err *err)
{
    struct reader reader = {s, err};
    struct file_bytes file = {0}; /* inih takes an error of the disk for the end of the file */
    if (file_bytes_read(&file, path, err)) return err->status;
    const int rc = ini_parse_string(file.bytes, add_setting, &reader);
    file_bytes_release(&file);
    if (rc) err_set(err, ST_DATA, "%s:%d: found another line, wanted \"key = value\" or \"[section]\".", path, rc);
    return err->status;
}

static int is_config(const struct dirent *e)
{
    size_t n = strlen(e->d_name);
    return e->d_name[0] != '.' && n > 4 && !strcmp(e->d_name + n - 4, ".cfg");
}

enum status settings_add_folder(struct settings *s, const char *folder, struct err *err)
{
    struct dirent **names = NULL;
    int count = scandir(folder, &names, is_config, alphasort);
    if (count < 0 && errno != ENOENT) err_errno(err, "list", folder);

    for (int i = 0; i < count; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", folder, names[i]->d_name);
        if (!err->status) settings_add_file(s, path, err);
        free(names[i]);
    }
    free(names);
    return err->status;
}

static bool same_value(const char *a, const char *b)
{
    char *end_a, *end_b;
    double x = strtod(a, &end_a), y = strtod(b, &end_b);
    if (end_a != a && end_b != b && !*end_a && !*end_b) return x == y;
    return !strcmp(a, b);
}

void settings_compare(struct settings *s, const struct settings *defaults)
{
    for (int i = 0; i < s->count; i++) {
        struct setting *item = &s->items[i];
        const struct setting *d = find(defaults, item->section, item->key);
        if (d) memcpy(item->default_value, d->value, sizeof item->default_value);
        item->known = d != NULL;
        item->changed = d && !same_value(item->value, d->value);
    }
}

void settings_release(struct settings *s)
{
    free(s->items);
    *s = (struct settings){0};
}
