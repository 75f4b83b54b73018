/* score_words.c - see score_words.h. */
#include "stages/report/score_words.h"

#include <stddef.h>
#include <string.h>

static const struct score_words words[] = {
    {"length", "length of the move", "how far the camera goes"},
    {"length_of_thesis", "length by the coarse search", "the same for the best pair of the coarse grid of viewpoints"},
    {"angle", "turn", "how far the camera turns"},
    {"parallax", "shift of the foreground", "how far near things move against far ones, in widths of the picture"},
    {"parallax_of_thesis", "shift by the coarse search", "the same for the best pair of the coarse grid"},
    {"worst_h", "largest holes",
     "how large the gaps between known pixels are in the worst frame, before they are "
     "filled; 0 is none"},
    {"worst_h_at", "where they are", "the place of the worst frame in the film: 0 the start, 1 the end"},
    {"worst_h_of_thesis", "largest holes by the coarse search", "the same for the best pair of the coarse grid"},
    {"h_limit", "limit of holes", "the largest holes that a move may have"},
    {"worst_outside", "most beyond the photographs", "the part of the worst frame that no photograph reaches"},
    {"outside_limit", "limit of that", "the largest part that a move may have"},
    {"zoom", "zoom", "the pictures are enlarged by so much, so that their edges are covered"},
    {"aperture", "aperture", "the diameter of the lens that blurs what is out of focus"},
    {"blur", "largest blur", "the diameter of the blur, at most"},
    {"subject_size_error", "error of the subject's size", "how far its size on screen is from what was asked for"},
    {"subject_place_error", "error of the subject's place", "how far its place is from what was asked for"},
};

const struct score_words *score_words_find(const char *score)
{
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (!strcmp(words[i].score, score)) return &words[i];
    return NULL;
}
