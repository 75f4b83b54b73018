/* feature_list.h - local features of a photograph: out/SCENE/features/PHOTO.txt.
 *
 *   remodel-features 1
 *   features COUNT HASH
 *   feature X Y SCALE ANGLE DESCRIPTOR      COUNT lines, the largest SCALE first
 *
 * X, Y: pixels of the stored photo, whose first pixel has its centre at (0.5, 0.5). SCALE: the standard deviation of
 * the blur at which it was found, in those pixels. ANGLE: radians. DESCRIPTOR: 256 hexadecimal digits. */
#ifndef REMODEL_FEATURE_LIST_H
#define REMODEL_FEATURE_LIST_H

#include <stdint.h>

#include "common/base/hash.h"
#include "common/base/provenance.h"

enum {
    DESCRIPTOR_SIZE = 128,
    DESCRIPTOR_LENGTH = 512, /* what its values are multiplied by: their squares add up to about its square */
    MAX_FEATURES = 100000    /* of a photo */
};

/* A gradient histogram whose square roots were taken, so that a scalar product compares histograms as the Bhattacharyya
 * coefficient does [Arandjelovic 2012]. */
struct feature {
    float x, y, scale, angle;
    uint8_t descriptor[DESCRIPTOR_SIZE];
};

struct feature_list {
    struct feature *features; /* owned */
    int count;
    char hash[HASH_TEXT]; /* of the features; set by reading and writing */
};

/* On failure the list is empty. ST_DATA: another number of features than stated, or more than MAX_FEATURES. */
enum status feature_list_read(struct feature_list *list, const char *path, struct provenance *prov, struct err *err);
/* Reads count and hash only. */
enum status feature_list_read_head(struct feature_list *list, const char *path, struct err *err);
enum status feature_list_write(struct feature_list *list, const char *path, const struct provenance *prov,
                               struct err *err);
void feature_list_release(struct feature_list *list);

#endif
