/* photo_pairs.h - which photos are compared with each other. */
#ifndef REMODEL_PHOTO_PAIRS_H
#define REMODEL_PHOTO_PAIRS_H

#include <stdbool.h>

/* Whether photos i < j of `count`, in order of their names, are compared. matcher: as [match_photos] matcher. */
bool photos_are_compared(int i, int j, int count, const char *matcher);

#endif
