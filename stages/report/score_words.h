/* score_words.h - ordinary names for the scores of a camera move. */
#ifndef REMODEL_SCORE_WORDS_H
#define REMODEL_SCORE_WORDS_H

struct score_words {
    const char *score, *name, *meaning;
};

/* NULL: a score that has only its own name. */
const struct score_words *score_words_find(const char *score);

#endif
