/* graph_parts.c - texts and paths of a graph. A path is kept once, in a pool that lives as long as a stage says its
 * rules. */
#include "common/graph/graph_parts.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

struct err *graph_err(struct graph *g) { return &g->err; }

void graph_refuse(struct graph *g, const char *fmt, ...)
{
    char text[sizeof g->err.text];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    err_set(&g->err, ST_USAGE, "%s", text);
}

/* --- texts --- */

void graph_add(struct graph *g, struct text *t, const char *bytes)
{
    const size_t n = strlen(bytes);
    if (g->err.status || array_reserve(&t->bytes, &t->capacity, t->size + n + 1, 1, "a rule", &g->err)) return;
    memcpy(t->bytes + t->size, bytes, n + 1);
    t->size += n;
}

void graph_add_text(struct graph *g, struct text *t, const struct text *more)
{
    if (more->size) graph_add(g, t, more->bytes);
}

/* Adds the words with a blank before each. */
void graph_add_word(struct graph *g, struct text *t, const char *word)
{
    graph_add(g, t, " ");
    graph_add(g, t, word);
}

void graph_empty(struct text *t)
{
    t->size = 0;
    if (t->bytes) *t->bytes = 0;
}

/* --- paths --- */

/* "" after an error. */
static const char *keep_text(struct graph *g, const char *text)
{
    const char *kept = g->err.status ? NULL : text_pool_keep(&g->texts, text, &g->err);
    return kept ? kept : "";
}

static const char *root_of(const struct graph *g, enum product_id id)
{
    return products[id].root == PRODUCT_SHARED ? g->facts->shared : g->facts->own;
}

static enum status find_path(char path[FILE_PATH], struct graph *g, enum product_id id, const struct product_key *key)
{
    char file[FILE_PATH];
    *path = 0;
    if (g->err.status || product_path(file, id, key, &g->err)) return g->err.status;
    return file_path(path, root_of(g, id), file, "", &g->err);
}

const char *graph_path(struct graph *g, enum product_id id, const struct product_key *key)
{
    char path[FILE_PATH];
    return find_path(path, g, id, key) ? "" : keep_text(g, path);
}

const char *graph_folder(struct graph *g, enum product_id id, const struct product_key *key)
{
    char path[FILE_PATH];
    if (find_path(path, g, id, key)) return "";
    /* the file's own name, which may have folders of its own, goes */
    int slashes = 1;
    for (const char *c = products[id].file; *c; c++) slashes += *c == '/';
    for (char *end; slashes && (end = strrchr(path, '/')); slashes--) *end = 0;
    return keep_text(g, path);
}

const char *graph_text(struct graph *g, const char *fmt, ...)
{
    char text[FILE_PATH];
    va_list args;
    va_start(args, fmt);
    const int n = vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    if (n < 0 || n >= FILE_PATH) err_set(&g->err, ST_IO, "a path of %d bytes is too long.", n);
    return keep_text(g, text);
}

const char *graph_own(struct graph *g, const char *file) { return graph_text(g, "%s/%s", g->facts->own, file); }
const char *graph_shared(struct graph *g, const char *file) { return graph_text(g, "%s/%s", g->facts->shared, file); }

const char *graph_scene_file(struct graph *g, const char *file)
{
    const char *path = graph_text(g, "%s/%s", g->facts->folder, file);
    return path_is_file(path) ? path : NULL;
}

struct named_text *graph_find_named(struct graph *g, struct named_texts *list, const char *name)
{
    for (size_t i = list->count; i-- > 0;)
        if (!strcmp(list->items[i].name, name)) return &list->items[i];
    if (g->err.status || array_append(&list->items, list->count, sizeof *list->items, "goals", &g->err)) return NULL;
    struct named_text *t = &list->items[list->count++];
    *t = (struct named_text){0};
    snprintf(t->name, sizeof t->name, "%s", name);
    return t;
}

const char *graph_set_path(struct graph *g, const char *set)
{
    graph_find_named(g, &g->sets, set); /* a set has a rule as soon as somebody needs it */
    return graph_text(g, "%s/stamp/set/%s", g->facts->own, set);
}
