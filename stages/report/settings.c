#include "stages/report/settings.h"

#include <dirent.h>
#include <errno.h>
#include <ini.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct setting *find(const struct settings *s, const char *section, const char *key)
{
    for (int i = 0; i < s->count; i++)
        if (!strcmp(s->items[i].section, section) && !strcmp(s->items[i].key, key)) return &s->items[i];
    return NULL;
}

static int take(void *user, const char *section, const char *key, const char *value)
{
    struct settings *s = user;
    struct setting *item = find(s, section, key);
    if (!item) {
        int at = s->count; /* behind the last of its section */
        for (int i = 0; i < s->count; i++)
            if (!strcmp(s->items[i].section, section)) at = i + 1;
        struct setting *grown = realloc(s->items, ((size_t)s->count + 1) * sizeof *grown);
        if (!grown) return 0;
        s->items = grown;
        memmove(grown + at + 1, grown + at, (size_t)(s->count++ - at) * sizeof *grown);
        item = &grown[at];
        *item = (struct setting){0};
        snprintf(item->section, sizeof item->section, "%s", section);
        snprintf(item->key, sizeof item->key, "%s", key);
    }
    snprintf(item->value, sizeof item->value, "%s", value);
    return 1;
}

enum status settings_add_file(struct settings *s, const char *path, struct err *err)
{
    int rc = ini_parse(path, take, s);
    if (rc == -1) return err_errno(err, "open", path);
    if (rc) return err_set(err, ST_DATA, "%s:%d: this line is no \"key = value\" nor [section].", path, rc);
    return ST_OK;
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
    enum status st = count < 0 && errno != ENOENT ? err_errno(err, "list", folder) : ST_OK;

    for (int i = 0; i < count; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", folder, names[i]->d_name);
        if (!st) st = settings_add_file(s, path, err);
        free(names[i]);
    }
    free(names);
    return st;
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
        const struct setting *usual = find(defaults, item->section, item->key);
        if (usual) memcpy(item->usual, usual->value, sizeof item->usual);
        item->known = usual != NULL;
        item->changed = usual && !same_value(item->value, usual->value);
    }
}

void settings_release(struct settings *s)
{
    free(s->items);
    *s = (struct settings){0};
}
