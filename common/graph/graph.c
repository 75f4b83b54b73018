/* graph.c - collects the rules of a scene's products and prints them.
 *
 * A rule is printed when the next one begins or its stage ends, so that memory does not grow with the number of rules:
 * the text of a stage's file, its goals and the members of sets are all that is kept. Printing is linear in the number
 * of products. A set stands for many products where many rules need all of them: listing 10 000 views in 10 000 rules
 * would take Make gigabytes. */
#include "common/graph/graph.h"

#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/array.h"
#include "common/base/outfile.h"
#include "common/base/textfile.h"
#include "common/graph/graph_parts.h"
#include "common/graph/graph_print.h"

/* --- steps and goals --- */

void graph_step(struct graph *g, const char *step, enum step_kind kind, const char *before)
{
    if (g->err.status || array_append(&g->steps, g->step_count, sizeof *g->steps, "steps", &g->err)) return;
    struct step *s = &g->steps[g->step_count++];
    *s = (struct step){.kind = kind};
    snprintf(s->name, sizeof s->name, "%s", step);
    snprintf(s->stage, sizeof s->stage, "%s", g->stage);
    if ((size_t)snprintf(s->before, sizeof s->before, "%s", before) >= sizeof s->before)
        err_set(&g->err, ST_INTERNAL, "the steps before %s are too long a list.", step);
}

void graph_asked(struct graph *g, const char *word, const char *step)
{
    if (g->asked_count < WORD_LIST)
        g->asked[g->asked_count++] = (struct asked){word, step};
    else
        err_set(&g->err, ST_INTERNAL, "there are more than %d words of PRODUCTS.", WORD_LIST);
}

const char *graph_step_of(const struct graph *g, const char *product)
{
    for (int i = 0; i < g->asked_count; i++)
        if (!strcmp(g->asked[i].word, product)) return g->asked[i].step;
    return NULL;
}

void graph_goal(struct graph *g, const char *goal, const char *path)
{
    struct named_text *t = graph_find_named(g, &g->goals, goal);
    if (t && path) graph_add_word(g, &t->text, path);
}

/* --- what several stages read --- */

static bool is_newer(struct timespec a, struct timespec b)
{
    return a.tv_sec != b.tv_sec ? a.tv_sec > b.tv_sec : a.tv_nsec > b.tv_nsec;
}

void graph_set(struct graph *g, const char *set, const char *path)
{
    struct named_text *t = graph_find_named(g, &g->sets, set);
    struct stat info;
    if (!t) return;
    graph_add_word(g, &t->text, path);
    if (stat(path, &info))
        t->is_new = true;
    else if (is_newer(info.st_mtim, t->newest))
        t->newest = info.st_mtim;
}

/* A set that is whole gets the time of its newest member; Make does this only for one that it makes on the way. */
static void touch_set(struct graph *g, const struct named_text *set)
{
    const char *path = graph_set_path(g, set->name);
    struct stat info;
    if (set->is_new || !set->text.size || (!stat(path, &info) && !is_newer(set->newest, info.st_mtim))) return;
    if (outfile_write_if_changed(path, "", 0, &g->err)) return;
    const struct timespec times[2] = {set->newest, set->newest};
    if (utimensat(AT_FDCWD, path, times, 0)) err_errno(&g->err, "set the time of", path);
}

void graph_list(struct graph *g, enum graph_list_kind list, const char *path)
{
    if (path) graph_add_word(g, &g->lists[list], path);
}

const char *graph_stamp(struct graph *g, const char *file, const char *text)
{
    const char *path = graph_text(g, "%s/stamp/%s", g->facts->own, file);
    if (!g->writes || g->err.status) return path;
    if (!text)
        remove(path);
    else
        outfile_write_if_changed(path, text, strlen(text), &g->err);
    return path;
}

const char *graph_stamp_list(struct graph *g, const char *file, const struct name_list *names)
{
    struct text text = {0};
    for (int i = 0; i < names->count; i++) graph_add(g, &text, graph_text(g, "%s\n", names->names[i]));
    const char *path = graph_stamp(g, file, text.bytes ? text.bytes : "");
    free(text.bytes);
    return path;
}

const char *graph_parameter(struct graph *g, const char *name)
{
    const char *path = graph_text(g, "%s/slice/%s.cfg", g->facts->own, g->stage);
    const size_t n = strlen(name);
    char value[FILE_PATH] = "", line[FILE_PATH];
    FILE *f = fopen(path, "r");
    while (f && fgets(line, sizeof line, f))
        if (!strncmp(line, name, n) && !strncmp(line + n, " = ", 3)) {
            line[strcspn(line, "\n")] = 0;
            snprintf(value, sizeof value, "%s", line + n + 3);
        }
    if (f) fclose(f);
    return graph_text(g, "%s", value);
}

/* --- printing --- */

enum status graph_open(struct graph **graph, const struct scene_facts *facts, bool writes, struct err *err)
{
    struct graph *g = *graph = calloc(1, sizeof *g);
    if (!g) return err_nomem(err, "the graph", sizeof *g);
    g->facts = facts;
    g->writes = writes;
    return ST_OK;
}

void graph_begin_stage(struct graph *g, const char *stage)
{
    g->stage = stage;
    graph_empty(&g->file);
    graph_empty(&g->pieces);
    g->goals.count = 0;
}

static void write_text(struct graph *g, const char *name, const char *ending, const struct text *text)
{
    if (!g->err.status && g->writes)
        outfile_write_if_changed(graph_text(g, "%s/graph/%s%s", g->facts->own, name, ending),
                                 text->bytes ? text->bytes : "", text->size, &g->err);
}

static void print_list(struct graph *g, const char *name, const struct named_text *t)
{
    graph_add(g, &g->file, name);
    graph_add(g, &g->file, ":");
    graph_add_text(g, &g->file, &t->text);
    graph_add(g, &g->file, "\n");
}

void graph_end_stage(struct graph *g)
{
    rule_close(g);
    if (g->goals.count) graph_add(g, &g->file, ".PHONY:");
    for (size_t i = 0; i < g->goals.count; i++) graph_add_word(g, &g->file, g->goals.items[i].name);
    if (g->goals.count) graph_add(g, &g->file, "\n");
    for (size_t i = 0; i < g->goals.count; i++) {
        print_list(g, g->goals.items[i].name, &g->goals.items[i]);
        free(g->goals.items[i].text.bytes);
    }
    g->goals.count = 0;
    if (!g->file.size) {
        text_pool_release(&g->texts);
        return;
    }
    write_text(g, g->stage, ".mk", &g->file);
    if (g->pieces.size) write_text(g, g->stage, ".pieces", &g->pieces);
    graph_add(g, &g->includes, graph_text(g, "include %s/graph/%s.mk\n", g->facts->own, g->stage));
    text_pool_release(&g->texts);
}

static void check_products(struct graph *g)
{
    struct text known = {0};
    for (int i = 0; i < g->asked_count; i++) graph_add_word(g, &known, g->asked[i].word);
    for (int i = 0; i < g->facts->products.count; i++)
        if (!graph_step_of(g, g->facts->products.names[i]))
            graph_refuse(g, "PRODUCTS=%s: wanted one or more of:%s", scene_setting("PRODUCTS"),
                         known.bytes ? known.bytes : "");
    free(known.bytes);
}

enum status graph_write(struct graph *g, struct err *err)
{
    check_products(g);
    graph_empty(&g->file);
    for (size_t i = 0; i < g->sets.count; i++) {
        if (g->writes) touch_set(g, &g->sets.items[i]);
        print_list(g, graph_set_path(g, g->sets.items[i].name), &g->sets.items[i]);
        graph_add(g, &g->file, "\t@mkdir -p $(@D) && touch $@\n");
    }
    write_text(g, "sets", ".mk", &g->file);
    graph_add(g, &g->includes, graph_text(g, "include %s/graph/sets.mk\n.PHONY: FORCE\n", g->facts->own));
    write_text(g, "all", ".mk", &g->includes);
    return g->err.status ? err_set(err, g->err.status, "%s", g->err.text) : ST_OK;
}

static struct step *find_step(struct graph *g, const char *name)
{
    for (size_t i = 0; i < g->step_count; i++)
        if (!strcmp(g->steps[i].name, name)) return &g->steps[i];
    return NULL;
}

static enum status print_step(struct graph *g, const char *name, FILE *to, struct err *err)
{
    static const char *const kinds[] = {"one", "farm", "wide"};
    struct step *s = find_step(g, name);
    struct name_list before = {0};
    if (!s) return err_set(err, ST_INTERNAL, "no stage has the step %s.", name);
    if (s->visited) return ST_OK;
    s->visited = true;
    name_list_add_words(&before, s->before, err);
    for (int i = 0; !err->status && i < before.count; i++) print_step(g, before.names[i], to, err);
    name_list_release(&before);
    if (!err->status) fprintf(to, "%s %s %s\n", s->stage, kinds[s->kind], s->name);
    return err->status;
}

enum status graph_print_steps(struct graph *g, const char *goal, FILE *to, struct err *err)
{
    return print_step(g, goal, to, err);
}

void graph_release(struct graph *g)
{
    if (!g) return;
    struct text *texts[] = {&g->rule.makes, &g->rule.needs, &g->rule.after, &g->rule.words, &g->rule.own,
                            &g->rule.then,  &g->file,       &g->pieces,     &g->includes,   &g->lists[0],
                            &g->lists[1],   &g->lists[2],   &g->lists[3]};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) free(texts[i]->bytes);
    for (size_t i = 0; i < g->goals.count; i++) free(g->goals.items[i].text.bytes);
    for (size_t i = 0; i < g->sets.count; i++) free(g->sets.items[i].text.bytes);
    free(g->goals.items);
    free(g->sets.items);
    free(g->steps);
    text_pool_release(&g->texts);
    free(g);
}
