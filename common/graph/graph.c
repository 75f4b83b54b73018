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
#include "common/graph/graph_print.h"
#include "common/graph/text_pool.h"

enum { WORD_LIST = 16 };

struct text {
    char *bytes;
    size_t size, capacity;
};

struct named_text { /* a goal or a set */
    char name[64];
    struct text text; /* its paths, with a blank before each */
    bool is_new;      /* set: a member is missing */
    struct timespec newest;
};

struct named_texts {
    struct named_text *items;
    size_t count;
};

struct step {
    char name[64], stage[64], before[256];
    enum step_kind kind;
    bool visited;
};

struct asked {
    const char *word, *step;
};

struct rule {
    bool open, piece, shared, ignores_code, has_own, stale;
    enum stale_kind stale_kind;
    int targets;
    char stage[64], item[FILE_PATH];
    struct text makes, needs, after, words, own, then;
};

struct graph {
    const struct scene_facts *facts;
    bool writes;
    const char *stage;
    struct rule rule;
    struct text file, pieces, includes;
    struct named_texts goals, sets;
    struct text lists[GRAPH_LISTS];
    struct step *steps;
    size_t step_count;
    struct asked asked[WORD_LIST];
    int asked_count;
    struct text_pool texts;
    struct err err;
};

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

static void add(struct graph *g, struct text *t, const char *bytes)
{
    const size_t n = strlen(bytes);
    if (g->err.status || array_reserve(&t->bytes, &t->capacity, t->size + n + 1, 1, "a rule", &g->err)) return;
    memcpy(t->bytes + t->size, bytes, n + 1);
    t->size += n;
}

static void add_text(struct graph *g, struct text *t, const struct text *more)
{
    if (more->size) add(g, t, more->bytes);
}

/* Adds the words with a blank before each. */
static void add_word(struct graph *g, struct text *t, const char *word)
{
    add(g, t, " ");
    add(g, t, word);
}

static bool has_word(const struct text *t, const char *word)
{
    const size_t n = strlen(word);
    for (const char *at = t->bytes; at && (at = strstr(at, word)); at += n)
        if (at[-1] == ' ' && (at[n] == ' ' || !at[n])) return true;
    return false;
}

static void empty(struct text *t)
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

static struct named_text *find_named(struct graph *g, struct named_texts *list, const char *name)
{
    for (size_t i = list->count; i-- > 0;)
        if (!strcmp(list->items[i].name, name)) return &list->items[i];
    if (g->err.status || array_append(&list->items, list->count, sizeof *list->items, "goals", &g->err)) return NULL;
    struct named_text *t = &list->items[list->count++];
    *t = (struct named_text){0};
    snprintf(t->name, sizeof t->name, "%s", name);
    return t;
}

void graph_goal(struct graph *g, const char *goal, const char *path)
{
    struct named_text *t = find_named(g, &g->goals, goal);
    if (t && path) add_word(g, &t->text, path);
}

/* --- what several stages read --- */

const char *graph_set_path(struct graph *g, const char *set)
{
    return graph_text(g, "%s/stamp/set/%s", g->facts->own, set);
}

static bool is_newer(struct timespec a, struct timespec b)
{
    return a.tv_sec != b.tv_sec ? a.tv_sec > b.tv_sec : a.tv_nsec > b.tv_nsec;
}

void graph_set(struct graph *g, const char *set, const char *path)
{
    struct named_text *t = find_named(g, &g->sets, set);
    struct stat info;
    if (!t) return;
    add_word(g, &t->text, path);
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

void graph_list(struct graph *g, enum graph_list list, const char *path)
{
    if (path) add_word(g, &g->lists[list], path);
}

void rule_needs_list(struct graph *g, enum graph_list list) { add_text(g, &g->rule.needs, &g->lists[list]); }

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
    for (int i = 0; i < names->count; i++) add(g, &text, graph_text(g, "%s\n", names->names[i]));
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
    return keep_text(g, value);
}

/* --- rules --- */

/* stale=$(common/run/stale.sh KIND FOLDER NAME... -- PREREQUISITES): the targets, FOLDER/NAME.exr, are in one folder.
 */
static void print_stale(struct graph *g)
{
    const struct rule *r = &g->rule;
    const char *word = r->makes.bytes + 1, *slash = word;
    for (const char *c = word; *c && *c != ' '; c++)
        if (*c == '/') slash = c;
    const int folder = (int)(slash - word);
    add(g, &g->file,
        graph_text(g, "stale=$$(common/run/stale.sh %s %.*s", r->stale_kind == STALE_FRAMES ? "frames" : "views",
                   folder, word));
    for (; word[-1] == ' '; word += strcspn(word, " ") + 1) {
        const char *name = word + folder + 1;
        add(g, &g->file, graph_text(g, " %.*s", (int)(strcspn(name, " ") - strlen(".exr")), name));
        if (!word[strcspn(word, " ")]) break;
    }
    add(g, &g->file, " -- $^) && ");
}

static void close_rule(struct graph *g)
{
    struct rule *r = &g->rule;
    const bool open = r->open;
    r->open = false;
    if (!open || g->err.status) return;
    const char *folder = r->shared ? g->facts->shared : g->facts->own;
    const char *config = graph_text(g, "%s/slice/%s.cfg", folder, r->stage);
    add(g, &g->file, r->makes.bytes ? r->makes.bytes + 1 : "");
    add(g, &g->file, r->targets > 1 ? " &:" : ":");
    add_text(g, &g->file, &r->needs);
    add_word(g, &g->file, config);
    if (!r->ignores_code) add_word(g, &g->file, graph_text(g, "%s/%s", g->facts->code, r->stage));
    if (r->after.size) add(g, &g->file, " |");
    add_text(g, &g->file, &r->after);
    add(g, &g->file, "\n\t$(hide)");
    if (r->stale) print_stale(g);
    add(g, &g->file, graph_text(g, "common/run/run_stage.sh %s %s ", r->piece ? "quiet" : "live", r->stage));
    add(g, &g->file, r->item);
    add(g, &g->file, graph_text(g, " %s %s/%s --threads $(T) --config %s", folder, g->facts->bin, r->stage, config));
    add_text(g, &g->file, &r->words);
    if (r->stale) add(g, &g->file, r->stale_kind == STALE_FRAMES ? " --frames $$stale" : " $$stale");
    add_text(g, &g->file, &r->own);
    add_text(g, &g->file, &r->then);
    add(g, &g->file, "\n");
    if (!r->piece) return;
    const char *last = strrchr(r->own.size ? r->own.bytes : r->words.bytes, ' ');
    add(g, &g->pieces, graph_text(g, "%s %s%s", r->stage, r->item, r->stale ? " $stale" : last));
    add(g, &g->pieces, "\t");
    add(g, &g->pieces, r->makes.bytes ? r->makes.bytes + 1 : "");
    if (r->own.size) {
        add(g, &g->pieces, "\t");
        add(g, &g->pieces, r->own.bytes + 1);
    }
    add(g, &g->pieces, "\n");
}

static void open_rule(struct graph *g, bool piece, const char *fmt, va_list args)
{
    struct rule *r = &g->rule;
    struct text *texts[] = {&r->makes, &r->needs, &r->after, &r->words, &r->own, &r->then};
    close_rule(g);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) empty(texts[i]);
    r->open = true;
    r->piece = piece;
    r->shared = r->ignores_code = r->has_own = r->stale = false;
    r->targets = 0;
    snprintf(r->stage, sizeof r->stage, "%s", g->stage);
    vsnprintf(r->item, sizeof r->item, fmt, args);
}

void graph_rule(struct graph *g, const char *item_fmt, ...)
{
    va_list args;
    va_start(args, item_fmt);
    open_rule(g, false, item_fmt, args);
    va_end(args);
}

void graph_piece(struct graph *g, const char *item_fmt, ...)
{
    va_list args;
    va_start(args, item_fmt);
    open_rule(g, true, item_fmt, args);
    va_end(args);
}

void graph_source(struct graph *g, const char *path)
{
    close_rule(g);
    add(g, &g->file, path);
    add(g, &g->file, ": ;\n");
}

void graph_beside(struct graph *g, const char *path, const char *with)
{
    close_rule(g);
    add(g, &g->file, graph_text(g, "%s: | %s\n", path, with));
}

void rule_by(struct graph *g, const char *stage) { snprintf(g->rule.stage, sizeof g->rule.stage, "%s", stage); }
void rule_shared(struct graph *g) { g->rule.shared = true; }
void rule_ignores_code(struct graph *g) { g->rule.ignores_code = true; }

void rule_makes(struct graph *g, const char *path)
{
    add_word(g, &g->rule.makes, path);
    g->rule.targets++;
}

void rule_needs(struct graph *g, const char *path)
{
    if (path) add_word(g, &g->rule.needs, path);
}

void rule_needs_set(struct graph *g, const char *set) { rule_needs(g, graph_set_path(g, set)); }
void rule_needs_force(struct graph *g) { rule_needs(g, "FORCE"); }

void rule_needs_cameras(struct graph *g)
{
    rule_needs(g, PATH(g, CAMERAS));
    rule_needs(g, PATH(g, IMAGES));
    rule_needs(g, PATH(g, POINTS3D));
}

void rule_needs_listed(struct graph *g, const char *deps)
{
    struct textfile t = {0};
    struct err missing = ERR_INIT;
    char *word;
    if (!path_is_file(deps) || textfile_open(&t, deps, &missing)) return;
    /* "TARGET: FILE FILE ...", and "FILE:" for each of them */
    if (textfile_next(&t) && !textfile_word(&t, "a target", &word, &missing))
        while (textfile_more(&t) && !textfile_word(&t, "a file", &word, &missing)) {
            if (!path_is_file(word))
                rule_needs_force(g);
            else if (!has_word(&g->rule.needs, word))
                rule_needs(g, word);
        }
    textfile_release(&t);
}

void rule_after(struct graph *g, const char *path)
{
    if (path) add_word(g, &g->rule.after, path);
}

void rule_after_set(struct graph *g, const char *set) { rule_after(g, graph_set_path(g, set)); }

void rule_option(struct graph *g, const char *option, const char *value)
{
    struct text *t = g->rule.has_own ? &g->rule.own : &g->rule.words;
    if (!value) return;
    add_word(g, t, option);
    if (*value) add_word(g, t, value);
}

void rule_variable(struct graph *g, const char *option, const char *variable)
{
    if (*setting(variable)) rule_option(g, option, graph_text(g, "\"$$REMODEL_%s\"", variable));
}

void rule_own(struct graph *g) { g->rule.has_own = true; }

void rule_stale(struct graph *g, enum stale_kind kind)
{
    g->rule.stale = true;
    g->rule.stale_kind = kind;
}

void rule_then(struct graph *g, const char *line)
{
    add(g, &g->rule.then, "\n\t$(hide)");
    add(g, &g->rule.then, line);
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
    empty(&g->file);
    empty(&g->pieces);
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
    add(g, &g->file, name);
    add(g, &g->file, ":");
    add_text(g, &g->file, &t->text);
    add(g, &g->file, "\n");
}

void graph_end_stage(struct graph *g)
{
    close_rule(g);
    if (g->goals.count) add(g, &g->file, ".PHONY:");
    for (size_t i = 0; i < g->goals.count; i++) add_word(g, &g->file, g->goals.items[i].name);
    if (g->goals.count) add(g, &g->file, "\n");
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
    add(g, &g->includes, graph_text(g, "include %s/graph/%s.mk\n", g->facts->own, g->stage));
    text_pool_release(&g->texts);
}

static void check_products(struct graph *g)
{
    struct text known = {0};
    for (int i = 0; i < g->asked_count; i++) add_word(g, &known, g->asked[i].word);
    for (int i = 0; i < g->facts->products.count; i++)
        if (!graph_step_of(g, g->facts->products.names[i]))
            graph_refuse(g, "PRODUCTS=%s: wanted one or more of:%s", setting("PRODUCTS"),
                         known.bytes ? known.bytes : "");
    free(known.bytes);
}

enum status graph_write(struct graph *g, struct err *err)
{
    check_products(g);
    empty(&g->file);
    for (size_t i = 0; i < g->sets.count; i++) {
        if (g->writes) touch_set(g, &g->sets.items[i]);
        print_list(g, graph_set_path(g, g->sets.items[i].name), &g->sets.items[i]);
        add(g, &g->file, "\t@mkdir -p $(@D) && touch $@\n");
    }
    write_text(g, "sets", ".mk", &g->file);
    add(g, &g->includes, graph_text(g, "include %s/graph/sets.mk\n.PHONY: FORCE\n", g->facts->own));
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
    enum status st = name_list_add_words(&before, s->before, err);
    for (int i = 0; !st && i < before.count; i++) st = print_step(g, before.names[i], to, err);
    name_list_release(&before);
    if (!st) fprintf(to, "%s %s %s\n", s->stage, kinds[s->kind], s->name);
    return st;
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
