/* picture_made.h - words and colours for what pixels of a picture come from (enum picture_made). */
#ifndef REMODEL_PICTURE_MADE_H
#define REMODEL_PICTURE_MADE_H

#include <stdint.h>

#include "common/texture/model_picture.h"

struct picture_made_kind {
    const char *word;  /* in files */
    const char *label; /* for people who own a home, not a program */
    uint8_t rgb[3];    /* sRGB, in pictures of sources */
};

const struct picture_made_kind *picture_made_kind(enum picture_made made);
/* The kind of a word; -1: there is none. */
int picture_made_find(const char *word);

#endif
