/* graph_parts.h - a graph while its rules are collected: for graph.c and rule.c alone. */
#ifndef REMODEL_GRAPH_PARTS_H
#define REMODEL_GRAPH_PARTS_H

#include <stdbool.h>
#include <time.h>

#include "common/graph/graph.h"
#include "common/graph/scene_facts.h"
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
    bool open, piece, shared, has_own, stale;
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

/* Adds to a text. After an error they do nothing. */
void graph_add(struct graph *g, struct text *t, const char *bytes);
void graph_add_text(struct graph *g, struct text *t, const struct text *more);
void graph_add_word(struct graph *g, struct text *t, const char *word); /* with a blank before it */
void graph_empty(struct text *t);

/* The goal or set of that name, which is added if it is new. NULL after an error. */
struct named_text *graph_find_named(struct graph *g, struct named_texts *list, const char *name);

/* Prints the rule at hand, if there is one. */
void rule_close(struct graph *g);

#endif
