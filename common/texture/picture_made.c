/* picture_made.c - see picture_made.h. */
#include "common/texture/picture_made.h"

#include <string.h>

static const struct picture_made_kind kinds[MADE_COUNT] = {
    [MADE_NOTHING] = {"nothing", "nothing is known", {0, 0, 0}},
    [MADE_PHOTO] = {"photo", "this photograph", {205, 205, 205}},
    [MADE_ORIGINAL] = {"original", "this photograph, on the model", {140, 190, 150}},
    [MADE_WARPED] = {"warped", "another photograph", {70, 130, 200}},
    [MADE_SYNTHESISED] = {"guessed", "guessed from what is beside it", {235, 140, 50}},
    [MADE_COLOUR] = {"colour", "a plain colour for new surfaces", {200, 70, 160}},
    [MADE_OUTDOORS] = {"outdoors", "the view outdoors", {95, 200, 210}},
    [MADE_CLUTTER] = {"clutter", "furniture", {140, 100, 190}},
    [MADE_UNSURE] = {"unsure", "perhaps hidden by furniture", {230, 215, 90}},
};

const struct picture_made_kind *picture_made_kind(enum picture_made made)
{
    return &kinds[made < MADE_COUNT ? made : MADE_NOTHING];
}

int picture_made_find(const char *word)
{
    for (int k = 0; k < MADE_COUNT; k++)
        if (!strcmp(kinds[k].word, word)) return k;
    return -1;
}
