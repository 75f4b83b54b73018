/* product_inputs.h - what a product says that it was made of (common/base/provenance.h): pictures in an attribute of
 * their header, texts in the comments of their first lines. */
#ifndef REMODEL_PRODUCT_INPUTS_H
#define REMODEL_PRODUCT_INPUTS_H

#include <stddef.h>

#include "common/base/err.h"
#include "common/base/hash.h"

struct product_input {
    char hash[HASH_TEXT];
    char *name; /* owned */
};

struct product_inputs {
    struct product_input *items; /* owned */
    int count;
};

/* Reads them from the bytes of a product; one that names none has none. ST_NOMEM. */
enum status product_inputs_read(struct product_inputs *inputs, const char *bytes, size_t size, struct err *err);
void product_inputs_release(struct product_inputs *inputs);

#endif
