/* bracket_cycle.h - cycles in a sequence of exposures, as a bracketing camera leaves them. */
#ifndef REMODEL_BRACKET_CYCLE_H
#define REMODEL_BRACKET_CYCLE_H

#include <stdbool.h>

struct bracket_shot {
    double exposure; /* seconds x ISO / (f-number^2 x filter); 0: unknown */
    double seconds;  /* how long the shutter was open; 0: unknown */
    double taken;    /* when it opened, in seconds; 0: unknown */
};

enum bracket_verdict {
    BRACKETS_NONE,  /* single photos */
    BRACKETS_SOME,  /* a cycle, but photos are missing or extra */
    BRACKETS_JUMPS, /* no cycle, but most exposures differ from the one before by a factor of 1.8 or more */
    BRACKETS_ALL,   /* all photos belong to a cycle */
};

enum bracket_wish {
    BRACKETS_MAY_BE, /* photos may be single ones */
    BRACKETS_LIKELY, /* as few as two occurrences of two exposures are enough if they cover all photos */
    BRACKETS_MUST_BE /* the same, and where they do not, photos are missing or extra */
};

struct bracket_cycle {
    int begin, length; /* in the shots: the first occurrence; length 0: no cycle */
    int count;         /* number of occurrences */
    bool steps;        /* occurrences have the same steps, but not the same exposures */
};

/* Looks for a cycle by the rules of bracket_views.h. */
enum bracket_verdict bracket_cycle_find(struct bracket_cycle *c, const struct bracket_shot *shots, int count,
                                        enum bracket_wish wish);
/* Whether the cycle occurs at shots[at]. */
bool bracket_cycle_at(const struct bracket_cycle *c, const struct bracket_shot *shots, int count, int at);

bool bracket_equal(double a, double b); /* equal exposures: known, and within 1 % */

#endif
