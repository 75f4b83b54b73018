/* photo_pairs.c - which photos are compared with each other. */
#include "stages/match_photos/photo_pairs.h"

#include <string.h>

enum { MOST_EXHAUSTIVE = 200, NEIGHBOURS = 10, FARTHEST = 512 };

bool photos_are_compared(int i, int j, int count, const char *matcher)
{
    const int apart = j - i;
    if (!strcmp(matcher, "exhaustive") || (!strcmp(matcher, "auto") && count <= MOST_EXHAUSTIVE)) return true;
    /* near ones, and some that are farther: 16, 32, 64, ... apart */
    return apart <= NEIGHBOURS || (apart <= FARTHEST && !(apart & (apart - 1)));
}
