/* free_space.h - where lines of sight pass, in plan: a grid of the heights at which each place is free. */
#ifndef REMODEL_FREE_SPACE_H
#define REMODEL_FREE_SPACE_H

#include "stages/suggest_model/wall_faces.h"

enum { FREE_LEVELS = 8 };
struct free_space {
    double low[2], edge;
    int size[2];
    unsigned char *counts; /* owned; size[1] x size[0] x FREE_LEVELS: lines of sight, at most 255 */
};

/* bounds and height: those of the list. The caller releases the result, which a failure leaves empty. */
enum status free_space_find(struct free_space *f, const struct face_list *list, const struct sights *sights,
                            struct err *err);
void free_space_release(struct free_space *f);

/* The fraction of the heights from floor to ceiling at which a place is free; 0 outside of the bounds. */
double free_space_at(const struct free_space *f, double x, double y);

#endif
