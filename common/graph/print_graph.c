/* print_graph.c - prints the graph of a scene's products as rules for GNU Make (graph.h).
 *
 *   print_graph write SCENE_FOLDER S O BIN         O/graph/STAGE.mk, and O/graph/all.mk, which includes them
 *   print_graph check SCENE_FOLDER S O BIN         nothing: whether the settings are valid
 *   print_graph steps SCENE_FOLDER S O BIN GOAL    the same as write, and "STAGE KIND STEP" for each step up to GOAL
 *
 * Settings are variables REMODEL_NAME of the environment (common/make/top.mk). <rules.def> is made by the build: the
 * stages that have rules, in order. */
#include <stdio.h>
#include <string.h>

#include "common/graph/graph_print.h"

#define STAGE(name) void name##_rules(struct graph *g, const struct scene_facts *f);
#include <rules.def>
#undef STAGE

static const struct {
    const char *name;
    void (*say_rules)(struct graph *g, const struct scene_facts *f);
} stages[] = {
#define STAGE(name) {#name, name##_rules},
#include <rules.def>
#undef STAGE
};

static enum status print(const char *what, char **argv, const char *goal, struct err *err)
{
    struct scene_facts facts = {0};
    struct graph *g = NULL;
    if (!scene_facts_read(&facts, argv[0], argv[1], argv[2], argv[3], err))
        graph_open(&g, &facts, strcmp(what, "check") != 0, err);
    for (size_t i = 0; !err->status && i < sizeof stages / sizeof *stages; i++) {
        graph_begin_stage(g, stages[i].name);
        stages[i].say_rules(g, &facts);
        graph_end_stage(g);
    }
    if (!err->status) graph_write(g, err);
    if (!err->status && goal) graph_print_steps(g, goal, stdout, err);
    graph_release(g);
    scene_facts_release(&facts);
    return err->status;
}

int main(int argc, char **argv)
{
    struct err err = ERR_INIT;
    const char *what = argc > 1 ? argv[1] : "";
    const int wanted = !strcmp(what, "write") || !strcmp(what, "check") ? 6 : !strcmp(what, "steps") ? 7 : 0;
    if (argc != wanted)
        err_set(&err, ST_USAGE,
                "print_graph: wanted write, check or steps, then SCENE_FOLDER S O BIN, and for steps a goal.");
    else
        print(what, argv + 2, wanted == 7 ? argv[6] : NULL, &err);
    if (err.status) fprintf(stderr, "%s\n", err.text);
    return err_exit_code(&err);
}
