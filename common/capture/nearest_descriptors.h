/* nearest_descriptors.h - exact nearest neighbours among descriptors of two photos. */
#ifndef REMODEL_NEAREST_DESCRIPTORS_H
#define REMODEL_NEAREST_DESCRIPTORS_H

#include "common/base/err.h"
#include "common/capture/feature_list.h"

/* The nearest features of another photo: those whose descriptors have the largest scalar products with a given one. */
struct nearest {
    int32_t at;           /* index of the nearest, the lowest of equally near ones; -1: the photo has no features */
    int32_t best, second; /* scalar products of the nearest and the second nearest; -1: too few features */
};

/* Descriptors laid out for the search, in blocks of eight features. */
struct nearest_descriptors {
    int16_t *rows;  /* count x DESCRIPTOR_SIZE; owned */
    int16_t *lanes; /* for each block and each two neighbouring values, those of all eight features; owned */
    int count, blocks;
};

enum status nearest_descriptors_init(struct nearest_descriptors *b, const struct feature_list *list, struct err *err);
void nearest_descriptors_release(struct nearest_descriptors *b);

/* For each feature of a its nearest ones of b, and the other way round. ab: a->count; ba: b->count. ST_NOMEM. */
enum status nearest_descriptors_find(struct nearest *ab, struct nearest *ba, const struct nearest_descriptors *a,
                                     const struct nearest_descriptors *b, struct err *err);

#endif
