/* script_words.h - words, numbers, places and options of a statement, for what reads one; everything else includes
 * script.h. */
#ifndef REMODEL_BUILD_MODEL_SCRIPT_WORDS_H
#define REMODEL_BUILD_MODEL_SCRIPT_WORDS_H

#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "stages/build_model/script/verbs.h"

#define MAX_NUMBER 1e6

struct script_reader {
    struct textfile t;
    char *words; /* a buffer for all words of the file */
    size_t used;
    int count;               /* statements so far, with the one that is being read */
    const struct verb *verb; /* of that one */
    const char *base;        /* the edit that the script stands on; NULL: none */
    int base_line;
    struct err *err;
};

const char *script_option_name(enum option option);
const char *script_filling_name(enum filling filling); /* "nothing", "leaf", "glass", "wall" */

/* ST_DATA: `found` (NULL: the end of the line) where the verb's usage wants something else. */
enum status script_usage_error(struct script_reader *r, const char *found);
const char *script_keep_word(struct script_reader *r, const char *word); /* a copy that lasts as long as the script */
/* The next word comes next, before a blank or the end of the line. */
bool script_next_is(const struct script_reader *r, const char *word);
const char *script_next_word(const struct script_reader *r); /* the rest of the line */
enum status script_read_name(struct script_reader *r, const char *what, const char **name);
enum status script_read_number(struct script_reader *r, const char *what, double *value);
/* Reads the word that must come next. */
enum status script_expect(struct script_reader *r, const char *wanted);
/* Reads a place by coordinates or in a view, or of a kind in `more` (bits of the kinds from PLACE_FROM_END on). */
enum status script_read_place(struct script_reader *r, struct script_place *p, unsigned more);
/* Reads the direction of a wall in a view, `along x|y|WALL`, if it comes next. */
enum status script_read_along(struct script_reader *r, struct script_place *p);
/* Reads corners of the floor, `corner in VIEW X Y`, as long as they come next: two or more. */
enum status script_read_corners(struct script_reader *r, struct statement *s);
/* Reads names until an option or the end of the line. */
enum status script_read_list(struct script_reader *r, struct statement *s, int min_count);
/* Reads the name of a face, such as wall/south/in, or the first part of several: box/chest. */
enum status script_read_face(struct script_reader *r, const char **name);
/* Reads an albedo into the statement's values. */
enum status script_read_colour(struct script_reader *r, struct statement *s);
/* Reads options to the end of the line. */
enum status script_read_options(struct script_reader *r, struct statement *s);

#endif
