/* rule.c - a rule while its stage says it, and its text: a line of targets and prerequisites, and the line that makes
 * them.
 *
 * What a rule makes, needs and runs may be said in any order, so each is a text of its own until the rule is closed:
 * when the next one begins, or the stage ends. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "common/base/textfile.h"
#include "common/graph/graph_parts.h"

static bool has_word(const struct text *t, const char *word)
{
    const size_t n = strlen(word);
    for (const char *at = t->bytes; at && (at = strstr(at, word)); at += n)
        if (at[-1] == ' ' && (at[n] == ' ' || !at[n])) return true;
    return false;
}

/* stale=$(common/run/stale.sh KIND FOLDER NAME... -- PREREQUISITES): the targets, FOLDER/NAME.exr, are in one folder.
 */
static void print_stale(struct graph *g)
{
    const struct rule *r = &g->rule;
    const char *word = r->makes.bytes + 1, *slash = word;
    for (const char *c = word; *c && *c != ' '; c++)
        if (*c == '/') slash = c;
    const int folder = (int)(slash - word);
    graph_add(g, &g->file,
              graph_text(g, "stale=$$(common/run/stale.sh %s %.*s", r->stale_kind == STALE_FRAMES ? "frames" : "views",
                         folder, word));
    for (; word[-1] == ' '; word += strcspn(word, " ") + 1) {
        const char *name = word + folder + 1;
        graph_add(g, &g->file, graph_text(g, " %.*s", (int)(strcspn(name, " ") - strlen(".exr")), name));
        if (!word[strcspn(word, " ")]) break;
    }
    graph_add(g, &g->file, " -- $^) && ");
}

void rule_close(struct graph *g)
{
    struct rule *r = &g->rule;
    const bool open = r->open;
    r->open = false;
    if (!open || g->err.status) return;
    const char *folder = r->shared ? g->facts->shared : g->facts->own;
    const char *config = graph_text(g, "%s/slice/%s.cfg", folder, r->stage);
    graph_add(g, &g->file, r->makes.bytes ? r->makes.bytes + 1 : "");
    graph_add(g, &g->file, r->targets > 1 ? " &:" : ":");
    graph_add_text(g, &g->file, &r->needs);
    graph_add_word(g, &g->file, config);
    graph_add_word(g, &g->file, graph_text(g, "%s/%s", g->facts->code, r->stage));
    if (r->after.size) graph_add(g, &g->file, " |");
    graph_add_text(g, &g->file, &r->after);
    graph_add(g, &g->file, "\n\t$(hide)");
    if (r->stale) print_stale(g);
    graph_add(g, &g->file, graph_text(g, "common/run/run_stage.sh %s %s ", r->piece ? "quiet" : "live", r->stage));
    graph_add(g, &g->file, r->item);
    graph_add(g, &g->file,
              graph_text(g, " %s %s/%s --threads $(T) --config %s", folder, g->facts->bin, r->stage, config));
    graph_add_text(g, &g->file, &r->words);
    if (r->stale) graph_add(g, &g->file, r->stale_kind == STALE_FRAMES ? " --frames $$stale" : " $$stale");
    graph_add_text(g, &g->file, &r->own);
    graph_add_text(g, &g->file, &r->then);
    graph_add(g, &g->file, "\n");
    if (!r->piece) return;
    const char *last = strrchr(r->own.size ? r->own.bytes : r->words.bytes, ' ');
    graph_add(g, &g->pieces, graph_text(g, "%s %s%s", r->stage, r->item, r->stale ? " $stale" : last));
    graph_add(g, &g->pieces, "\t");
    graph_add(g, &g->pieces, r->makes.bytes ? r->makes.bytes + 1 : "");
    if (r->own.size) {
        graph_add(g, &g->pieces, "\t");
        graph_add(g, &g->pieces, r->own.bytes + 1);
    }
    graph_add(g, &g->pieces, "\n");
}

static void open_rule(struct graph *g, bool piece, const char *fmt, va_list args)
{
    struct rule *r = &g->rule;
    struct text *texts[] = {&r->makes, &r->needs, &r->after, &r->words, &r->own, &r->then};
    rule_close(g);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) graph_empty(texts[i]);
    r->open = true;
    r->piece = piece;
    r->shared = r->has_own = r->stale = false;
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
    rule_close(g);
    graph_add(g, &g->file, path);
    graph_add(g, &g->file, ": ;\n");
}

void graph_beside(struct graph *g, const char *path, const char *with)
{
    rule_close(g);
    graph_add(g, &g->file, graph_text(g, "%s: | %s\n", path, with));
}

void rule_by(struct graph *g, const char *stage) { snprintf(g->rule.stage, sizeof g->rule.stage, "%s", stage); }
void rule_shared(struct graph *g) { g->rule.shared = true; }

void rule_makes(struct graph *g, const char *path)
{
    graph_add_word(g, &g->rule.makes, path);
    g->rule.targets++;
}

void rule_needs(struct graph *g, const char *path)
{
    if (path) graph_add_word(g, &g->rule.needs, path);
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
            if (access(word, F_OK))
                rule_needs_force(g);
            else if (!has_word(&g->rule.needs, word))
                rule_needs(g, word);
        }
    textfile_release(&t);
}

void rule_after(struct graph *g, const char *path)
{
    if (path) graph_add_word(g, &g->rule.after, path);
}

void rule_after_set(struct graph *g, const char *set) { rule_after(g, graph_set_path(g, set)); }

void rule_option(struct graph *g, const char *option, const char *value)
{
    struct text *t = g->rule.has_own ? &g->rule.own : &g->rule.words;
    if (!value) return;
    graph_add_word(g, t, option);
    if (*value) graph_add_word(g, t, value);
}

void rule_variable(struct graph *g, const char *option, const char *variable)
{
    if (*scene_setting(variable)) rule_option(g, option, graph_text(g, "\"$$REMODEL_%s\"", variable));
}

void rule_own(struct graph *g) { g->rule.has_own = true; }

void rule_stale(struct graph *g, enum stale_kind kind)
{
    g->rule.stale = true;
    g->rule.stale_kind = kind;
}

void rule_then(struct graph *g, const char *line)
{
    graph_add(g, &g->rule.then, "\n\t$(hide)");
    graph_add(g, &g->rule.then, line);
}

void rule_needs_list(struct graph *g, enum graph_list_kind list) { graph_add_text(g, &g->rule.needs, &g->lists[list]); }

void rule_takes(struct graph *g, const char *option, const char *path)
{
    rule_needs(g, path);
    rule_option(g, option, path);
}
