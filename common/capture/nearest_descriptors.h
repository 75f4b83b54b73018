/* nearest_descriptors.h - exact nearest neighbours among descriptors of two photos. */
#ifndef REMODEL_NEAREST_DESCRIPTORS_H
#define REMODEL_NEAREST_DESCRIPTORS_H

#include "common/base/err.h"
#include "common/capture/feature_list.h"

/* The two features of another photo whose descriptors have the largest scalar products with one's own. */
struct nearest {
    int32_t at;           /* of the other photo's features, the lowest of equal ones; -1: there are none */
    int32_t best, second; /* scalar products; -1: there is no such feature */
};

/* Descriptors as the search wants them, eight features a block. */
struct nearest_descriptors {
    int16_t *rows;  /* count x DESCRIPTOR_SIZE; owned */
    int16_t *lanes; /* of each block, of each two neighbouring values: those of its eight features; owned */
    int count, blocks;
};

enum status nearest_descriptors_init(struct nearest_descriptors *b, const struct feature_list *list, struct err *err);
void nearest_descriptors_release(struct nearest_descriptors *b);

/* For each feature of a its nearest ones of b, and the other way round. ab: a->count; ba: b->count. ST_NOMEM. */
enum status nearest_descriptors_find(struct nearest *ab, struct nearest *ba, const struct nearest_descriptors *a,
                                     const struct nearest_descriptors *b, struct err *err);

#endif
