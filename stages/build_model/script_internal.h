/* script_internal.h - what the files that read model scripts share; everything else includes script.h. */
#ifndef REMODEL_BUILD_MODEL_SCRIPT_INTERNAL_H
#define REMODEL_BUILD_MODEL_SCRIPT_INTERNAL_H

#include "common/base/textfile.h"
#include "stages/build_model/script.h"

enum { MAX_NAME = 64 };
#define MAX_NUMBER 1e6

/* script.c */

struct script_grammar_row {
    const char *verb, *usage;
    unsigned options;  /* the verb's options: bits of enum option */
    const char *flags; /* the verb's flags, each between blanks */
};
extern const struct script_grammar_row script_grammar[VERB_COUNT];
extern const char *const script_quantities[]; /* of set; NULL after the last */

struct script_reader {
    struct textfile t;
    char *words; /* buffer for all words of the file */
    size_t used;
    struct err *err;
};

/* script_words.c */

enum status script_usage_error(struct script_reader *r, const char *found, enum verb verb);
const char *script_keep_word(struct script_reader *r, const char *word); /* a copy that lasts as long as the script */
bool script_is_name(const char *word);
enum status script_read_name(struct script_reader *r, const char *what, const char **name);
enum status script_read_number(struct script_reader *r, const char *what, double *value);
/* Reads the word that must come next. */
enum status script_expect(struct script_reader *r, const char *wanted, enum verb verb);
enum status script_read_place(struct script_reader *r, struct script_place *p, enum verb verb);
/* Reads names until an option or the end of the line. */
enum status script_read_list(struct script_reader *r, struct statement *s, int min_count, unsigned options);
/* Reads options and flags to the end of the line. */
enum status script_read_options(struct script_reader *r, struct statement *s);

/* script_statements.c */

enum status script_read_statement(struct script_reader *r, struct statement *s);

#endif
