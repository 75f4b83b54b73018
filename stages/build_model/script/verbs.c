/* verbs.c - the table of verbs.def. */
#include "stages/build_model/script/verbs.h"

#include <string.h>

#define OPT(o)                                         (1u << OPTION_##o)
#define VERB(word, usage, options, where, read, apply) {word, usage, options, where, read, apply},
const struct verb verbs[] = {
#include "stages/build_model/script/verbs.def"
};
const int verb_count = (int)(sizeof verbs / sizeof *verbs);

const struct verb *verb_find(const char *word)
{
    for (int i = 0; i < verb_count; i++)
        if (!strcmp(verbs[i].word, word)) return &verbs[i];
    return NULL;
}

const char *verb_word(const void *ctx, int i)
{
    (void)ctx;
    return i < verb_count ? verbs[i].word : NULL;
}
