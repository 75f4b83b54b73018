/* provenance.h - what a product was made from: stage, version, effective parameters, hashes of its inputs.
 *
 * It holds only what affects the product: no thread counts, job lists, absolute paths or times. Inputs are named by
 * their path in the scene ("views/IMG_1.exr") and listed in the order in which they were added. */
#ifndef REMODEL_PROVENANCE_H
#define REMODEL_PROVENANCE_H

#include <stdbool.h>
#include <stdio.h>

#include "common/base/err.h"
#include "common/base/file_bytes.h"
#include "common/base/file_path.h"
#include "common/base/hash.h"

struct provenance_input {
    char *name;
    char hash[HASH_TEXT];
};

struct provenance {
    const char *stage, *version;
    char *params; /* text of params_print(); owned */
    struct provenance_input *inputs;
    int count;
};

struct textfile;

/* Reads the file at `path` and records its hash as `name`; the second parses it as text. A name that is already
 * recorded is not recorded again. prov may be NULL. */
enum status provenance_read(struct provenance *prov, const char *name, struct file_bytes *file, const char *path,
                            struct err *err);
enum status provenance_open(struct provenance *prov, const char *name, struct textfile *t, const char *path,
                            struct err *err);

/* Records files that others read: of a hash, or hashed here. */
enum status provenance_add_hash(struct provenance *prov, const char *name, const char *hash, struct err *err);
enum status provenance_add_file(struct provenance *prov, const char *name, const char *path, struct err *err);
/* Records all inputs of another list: of what was read for an earlier product and kept in memory. */
enum status provenance_add_all(struct provenance *prov, const struct provenance *inputs, struct err *err);
bool provenance_has(const struct provenance *prov, const char *name);

/* Records FOLDER/FILESUFFIX as AS/FILESUFFIX. path, if not NULL, gets FOLDER/FILESUFFIX. */
enum status provenance_add_in(struct provenance *prov, const char *as, const char *folder, const char *file,
                              const char *suffix, char path[FILE_PATH], struct err *err);

/* Forgets all inputs but the first `count`: the next product of the process has others. */
void provenance_keep(struct provenance *prov, int count);

/* Prints the header of text products: "# remodel STAGE VERSION", a line "# key = value" per parameter, a line
 * "# input NAME HASH" per input. */
void provenance_print(const struct provenance *prov, FILE *to);

/* The inputs as text for an EXR attribute: a line "NAME HASH" per input. The caller frees it. NULL: out of memory. */
char *provenance_inputs_text(const struct provenance *prov);

void provenance_release(struct provenance *prov);

#endif
