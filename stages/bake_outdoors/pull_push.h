/* pull_push.h - fills what is unknown in a panorama from what is known around it. */
#ifndef REMODEL_PULL_PUSH_H
#define REMODEL_PULL_PUSH_H

#include "common/base/err.h"

/* Values and their weights. */
struct level {
    int width, height;
    int values; /* a pixel; each times the pixel's weight, which follows them */
    float *v;   /* owned; 0 in the beginning */
};

enum status pull_push_init(struct level *l, int width, int height, int values, struct err *err);
void pull_push_release(struct level *l);
/* The values of a pixel and, behind them, its weight, 0 to 1. */
float *pull_push_pixel(const struct level *l, int x, int y);

/* Values shrink by `factor` from the level of 2^(first - 1) pixels to the next coarser one, and so on. */
struct fading {
    int first;
    float factor;
};

/* Gives every pixel the weight 1; columns wrap around. What is unknown takes what is known near it; far from that it
 * fades to 0. Without any known pixel all become 0. */
enum status pull_push(struct level *base, const struct fading *fading, struct err *err);

#endif
