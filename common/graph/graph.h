/* graph.h - the rules of a scene's products, and their text for GNU Make.
 *
 * Each stage says its rules in stages/NAME/rules.c, with the functions below; common/graph/print_graph.c calls them in
 * the order of the stages and writes what they said to O/graph/NAME.mk: a line of targets and prerequisites, and a line
 * that makes them. Nothing in these files is expanded later but $(T), the threads of a process, $(hide), and Make's own
 * names for targets and prerequisites ($@, $^), so that a person can read them, and `make -n` and `make why` say what
 * is there.
 *
 *   RULES(fuse_points)                                            // stages/fuse_points/rules.c
 *   {
 *       (void)f;
 *       graph_step(g, "points", STEP_ONE, "depth");               // make points: after the step depth
 *       graph_goal(g, "points", PATH(g, POINTS));
 *       graph_rule(g, "all");                                     // its log: O/log/fuse_points.all.log
 *       rule_makes(g, PATH(g, POINTS));
 *       rule_takes_cameras(g);                                    // they are needed, and --views names their folder
 *       rule_takes_depth(g);                                      // every depth map, and --depth
 *       rule_option(g, "--out", PATH(g, POINTS));
 *   }
 *
 * S is the folder that all qualities of a scene share, O that of this quality. Every rule also needs its stage's
 * effective parameters and code. The first error holds: later calls do nothing, and print_graph reports it. */
#ifndef REMODEL_GRAPH_H
#define REMODEL_GRAPH_H

#include <stdbool.h>

#include "common/base/err.h"
#include "common/graph/name_list.h"
#include "common/product/product.h"

struct graph;
struct scene_facts;

/* The rules of a stage. */
#define RULES(stage)                                                                  \
    void stage##_rules(struct graph *g, const struct scene_facts *f); /* prototype */ \
    void stage##_rules(struct graph *g, const struct scene_facts *f)

/* --- paths: texts that hold until the stage has said its rules --- */

/* A product: PATH(g, DEPTH, .view = "IMG_1"). A misspelt one does not compile. */
#define PATH(g, ...)        PATH_OF(g, __VA_ARGS__, .page = 0)
#define PATH_OF(g, id, ...) graph_path(g, PRODUCT_##id, &(struct product_key){__VA_ARGS__})
/* The folder of a product's path, as stages name folders: FOLDER(g, DEPTH) is O/depth. */
#define FOLDER(g, ...)        FOLDER_OF(g, __VA_ARGS__, .page = 0)
#define FOLDER_OF(g, id, ...) graph_folder(g, PRODUCT_##id, &(struct product_key){__VA_ARGS__})

const char *graph_path(struct graph *g, enum product_id id, const struct product_key *key);
const char *graph_folder(struct graph *g, enum product_id id, const struct product_key *key);
const char *graph_text(struct graph *g, const char *fmt, ...) PRINTF_LIKE(2, 3);
const char *graph_own(struct graph *g, const char *file);    /* O/FILE, for a file that is not a product */
const char *graph_shared(struct graph *g, const char *file); /* S/FILE */
/* FOLDER/FILE of the scene, or NULL if it does not exist. */
const char *graph_scene_file(struct graph *g, const char *file);

/* --- the steps of a run, and goals of Make --- */

enum step_kind {
    STEP_ONE,  /* one call of Make with all cores */
    STEP_FARM, /* a process for each piece of work, side by side or on a cluster */
    STEP_WIDE, /* few processes, each with all cores, because each holds all views */
};

/* A step of a run, of the stage at hand, and the steps before it (words). A function run_STEP in the stage's run.sh
 * takes the place of what the kind says. */
void graph_step(struct graph *g, const char *step, enum step_kind kind, const char *before);

/* PRODUCTS=WORD makes this step. */
void graph_asked(struct graph *g, const char *word, const char *step);
/* The step that makes a word of PRODUCTS; NULL: no stage before this one has it. */
const char *graph_step_of(const struct graph *g, const char *product);

/* Adds a path, or NULL, to a goal of Make, which need not be a step. */
void graph_goal(struct graph *g, const char *goal, const char *path);

/* --- what several stages read --- */

/* Sets: many products that other rules need as one. A rule that needs 10 000 views needs O/stamp/set/views, which is as
 * new as the newest of them. */
void graph_set(struct graph *g, const char *set, const char *path);
const char *graph_set_path(struct graph *g, const char *set);

/* Products that evaluate (measured) and report (shown) wait for. SHOWN: not on the page of two photos; REMODEL_SHOWN:
 * on the page of edits. */
enum graph_list_kind { GRAPH_MEASURED, GRAPH_SHOWN, GRAPH_ALWAYS_SHOWN, GRAPH_REMODEL_SHOWN, GRAPH_LISTS };
void graph_list(struct graph *g, enum graph_list_kind list, const char *path);

/* Keeps O/stamp/FILE, whose content is `text`; NULL removes it. The file is rewritten only when the text changes. Rules
 * need stamps for facts that no file's time shows, for example that a file was deleted. Returns the stamp's path. */
const char *graph_stamp(struct graph *g, const char *file, const char *text);
const char *graph_stamp_list(struct graph *g, const char *file, const struct name_list *names);
/* A file that is as new as another, which a rule makes with it, or older: Make looks at it again in its next call. */
void graph_beside(struct graph *g, const char *path, const char *with);

/* A file that a rule may need and no rule makes. */
void graph_source(struct graph *g, const char *path);

/* A parameter of the stage at hand, from its effective ones in O/slice; "" while there are none. */
const char *graph_parameter(struct graph *g, const char *name);

/* Reports the error, once: invalid settings are ST_USAGE. */
void graph_refuse(struct graph *g, const char *fmt, ...) PRINTF_LIKE(2, 3);

struct err *graph_err(struct graph *g);

/* --- rules --- */

/* Begins a rule of the stage at hand; item: the name of its log. Its program shows its words as they come. */
void graph_rule(struct graph *g, const char *item_fmt, ...) PRINTF_LIKE(2, 3);
/* The same for a piece of work, one of many: it may run beside others or on a cluster, and shows one line. */
void graph_piece(struct graph *g, const char *item_fmt, ...) PRINTF_LIKE(2, 3);
/* A rule of another stage's program. */
void rule_by(struct graph *g, const char *stage);
void rule_shared(struct graph *g); /* all qualities share the product: parameters and log are in S */

void rule_makes(struct graph *g, const char *path);
void rule_needs(struct graph *g, const char *path); /* NULL: nothing */
void rule_needs_list(struct graph *g, enum graph_list_kind list);
void rule_needs_set(struct graph *g, const char *set);
void rule_needs_cameras(struct graph *g); /* of the views: cameras, images, points3D.txt */
void rule_needs_force(struct graph *g);   /* it is stale whatever the times are */
/* Adds the prerequisites that a Make dependency file of an earlier run lists. If one of them was deleted since, the
 * rule is stale. */
void rule_needs_listed(struct graph *g, const char *deps);
/* Must exist before, but its time does not matter; also a goal. */
void rule_after(struct graph *g, const char *path);
void rule_after_set(struct graph *g, const char *set);

/* Words of the command. value NULL: neither is added. value "": the option alone. Values are not quoted: they are plain
 * names and paths. */
void rule_option(struct graph *g, const char *option, const char *value);
/* A file that the rule needs and the option names. */
void rule_takes(struct graph *g, const char *option, const char *path);
/* An option whose value is a variable that people set, which may have any characters. */
void rule_variable(struct graph *g, const char *option, const char *variable);
/* What follows are a piece's own options, which a process may be given several times, for pieces that differ in
 * nothing else (common/run/run_lines.sh). */
void rule_own(struct graph *g);
/* Of the targets only those that are missing or stale: as `--frames 3,4,12` or `--view A --view B`. */
enum stale_kind { STALE_FRAMES, STALE_VIEWS };
void rule_stale(struct graph *g, enum stale_kind kind);
/* A line of shell after the program. */
void rule_then(struct graph *g, const char *line);

#endif
