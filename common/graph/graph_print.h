/* graph_print.h - what print_graph does with the rules that the stages said (graph.h). */
#ifndef REMODEL_GRAPH_PRINT_H
#define REMODEL_GRAPH_PRINT_H

#include <stdio.h>

#include "common/graph/graph.h"
#include "common/graph/scene_facts.h"

/* The facts must outlive the graph, which the caller releases in each case. writes: whether files are written. */
enum status graph_open(struct graph **g, const struct scene_facts *facts, bool writes, struct err *err);
void graph_begin_stage(struct graph *g, const char *stage);
/* Writes O/graph/STAGE.mk, and STAGE.pieces: a line "STAGE ITEM WORD<tab>PRODUCTS[<tab>OWN OPTIONS]" for
 * each piece of work, where WORD is the last one of its command. */
void graph_end_stage(struct graph *g);
/* Checks the words of PRODUCTS, brings the times of sets up to date, and writes O/graph/sets.mk and all.mk, which
 * includes the others. Returns the first error of all. */
enum status graph_write(struct graph *g, struct err *err);
/* Prints "STAGE KIND STEP" for each step of a run that ends with `goal`, in order. */
enum status graph_print_steps(struct graph *g, const char *goal, FILE *to, struct err *err);
void graph_release(struct graph *g);

#endif
