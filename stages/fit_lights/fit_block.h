/* fit_block.h - how likely a material's points are for lamps of given radiance (fit_chain.c has the mathematics). */
#ifndef REMODEL_FIT_LIGHTS_FIT_BLOCK_H
#define REMODEL_FIT_LIGHTS_FIT_BLOCK_H

#include "stages/fit_lights/fit_texture.h"

/* {0} is the empty state; everything is owned. */
struct fit_block {
    const struct problem *p;
    int material;
    struct texture_sample s;
    int *marks, *walls;         /* of the columns: first those of marks, then those of walls, then the mean */
    int mark_count, wall_count; /* of such columns */
    int columns;                /* of all kinds */
    int *column, *wall_column;  /* of each point */
    double *factors;            /* [kind][point][point] */
    double *designs;            /* [kind][point][column]: W */
    double *products;           /* [kind][column][column]: W^T W */
    double determinants[TEXTURE_KINDS];
    double *precision; /* P, factored */
    double *y, *z, *b; /* [colour][point], [colour][point], [colour][column] */
    double *offsets;   /* [colour][column] */
    double likely[3];  /* log p of each colour */
    double *next;      /* room: y, z, b, and a row */
    int kind;
    double variance; /* v */
    bool counts;     /* whether a kind's factor could be made */
    bool touched;    /* by the step that is tried */
    double tried;    /* log p after it */
    bool usable[TEXTURE_KINDS];
};

/* Of the points of a material, with the variation that was found of it. The block refers to p. ST_NOMEM. */
enum status fit_block_make(struct fit_block *b, const struct problem *p, int material, struct err *err);
void fit_block_release(struct fit_block *b);

/* Computes everything anew, after a change of variances, kinds or lamps. weights: of marks, by their numbers; tau2: the
 * variance of a mark's offset with weight 1. */
void fit_block_renew(struct fit_block *b, const double *weights, double tau2);
/* How much more likely a colour is at the present radiances than when it was kept or renewed, in logarithms. */
double fit_block_try(struct fit_block *b, int colour);
/* Keeps what was tried last. */
void fit_block_keep(struct fit_block *b, int colour);

/* The sum of squares of a colour that the offsets and the mean leave, whitened by a kind of texture. */
double fit_block_squares(struct fit_block *b, int colour, int kind);
/* The square of an offset, the mean of the colours. */
double fit_block_offset_square(const struct fit_block *b, int column);

#endif
