/* provenance.h - what a product was made from: stage, version, effective parameters, hashes of its inputs.
 *
 * Nothing that does not change the product: no threads, job lists, absolute paths, times. Inputs are named by what
 * they are to the scene ("views/IMG_1.exr"), in the order they were added. */
#ifndef REMODEL_PROVENANCE_H
#define REMODEL_PROVENANCE_H

#include <stdio.h>

#include "common/base/err.h"
#include "common/base/file_path.h"
#include "common/base/hash.h"

struct provenance_input {
    char *name;
    char hash[HASH_TEXT];
};

struct provenance {
    const char *stage, *version;
    char *params; /* params_print() text; owned */
    struct provenance_input *inputs;
    int count;
};

/* Hashes the file at `path` and records it as `name`; the same name twice is recorded once. */
enum status provenance_add_file(struct provenance *prov, const char *name, const char *path, struct err *err);

/* The same of FOLDER/FILESUFFIX as AS/FILESUFFIX; path gets the file's path, if it is not NULL. */
enum status provenance_add_in(struct provenance *prov, const char *as, const char *folder, const char *file,
                              const char *suffix, char path[FILE_PATH], struct err *err);

/* "# remodel STAGE VERSION", "# key = value" a parameter, "# input NAME HASH" an input: the head of text products. */
void provenance_print(const struct provenance *prov, FILE *to);

/* The inputs as text, "NAME HASH\n" each: an EXR attribute. Caller frees. NULL if there is no memory. */
char *provenance_inputs_text(const struct provenance *prov);

void provenance_release(struct provenance *prov);

#endif
