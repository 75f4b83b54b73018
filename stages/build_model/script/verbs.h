/* verbs.h - the table of the model script's statements: how each is read, and what it does to a plan.
 *
 * The rows are in verbs.def. The files plan_*.c have the functions, by subject: what reads a statement stands beside
 * what applies it. They call script_words.c and nothing above it; script.c and plan_apply.c call them by the table
 * alone. */
#ifndef REMODEL_BUILD_MODEL_VERBS_H
#define REMODEL_BUILD_MODEL_VERBS_H

#include "common/base/err.h"
#include "stages/build_model/script/statement.h"

struct script_reader; /* script_words.h */
struct plan_context;  /* plan_internal.h */

/* The scripts that may have a statement; of edits alone: what the unedited model, which shows the photographs, cannot
 * have. IN_OBJECTS: objects.txt. */
enum { IN_MODEL = 1, IN_EDITS = 2, IN_OBJECTS = 4 };

struct verb {
    const char *word, *usage;
    unsigned options; /* bits of enum option */
    unsigned where;   /* IN_... */
    /* Reads the fixed words and names that follow the verb, up to its options. */
    enum status (*read)(struct script_reader *r, struct statement *s);
    enum status (*apply)(struct plan_context *c);
};

extern const struct verb verbs[];
extern const int verb_count;

const struct verb *verb_find(const char *word); /* NULL: there is none */
/* Words of the table, in its order: for scan_nearest(). NULL after the last; ctx is not used. */
const char *verb_word(const void *ctx, int i);

/* The functions of all rows. */
#define VERB(word, usage, options, where, read, apply)              \
    enum status read(struct script_reader *r, struct statement *s); \
    enum status apply(struct plan_context *c);
#include "stages/build_model/script/verbs.def"
#undef VERB

#endif
