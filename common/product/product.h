/* product.h - the files that stages make and read, as one table: products.def.
 *
 *   char path[FILE_PATH];
 *   product_path(path, PRODUCT_OVERLAY, &(struct product_key){.model = "remodel/attic", .photo = "IMG_1"}, err);
 *                                                              // "remodel/attic/overlay/IMG_1.jpg"
 *
 * A new product is a row of products.def, a new kind of thing that products are made for a row of product_keys.def. */
#ifndef REMODEL_PRODUCT_H
#define REMODEL_PRODUCT_H

#include <stdbool.h>

#include "common/base/err.h"
#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "common/base/provenance.h"
#include "common/base/textfile.h"
#include "common/product/exports.h"

enum product_id {
#define PRODUCT(id, ...) PRODUCT_##id,
#include "common/product/products.def"
#undef PRODUCT
    PRODUCT_COUNT
};

enum product_root {
    PRODUCT_SHARED, /* below the folder that all qualities and hold-outs of a scene share: S in the documents */
    PRODUCT_OWN     /* below that of this quality and hold-out: O */
};

enum product_format {
#define PRODUCT_FORMAT(id, ...) PRODUCT_IS_##id,
#include "common/product/product_formats.def"
#undef PRODUCT_FORMAT
    PRODUCT_FORMAT_COUNT
};

/* Which of the things that a product is made for: fields that its path does not have are ignored. A field that is NULL
 * means its first form in product_keys.def, such as "model"; a name has none. */
struct product_key {
#define PRODUCT_KEY(field, type, ...) type field;
#include "common/product/product_keys.def"
#undef PRODUCT_KEY
};

/* bits of product_keys() */
enum product_key_bit {
#define PRODUCT_KEY(field, ...) PRODUCT_HAS_##field,
#include "common/product/product_keys.def"
#undef PRODUCT_KEY
    PRODUCT_KEY_COUNT
};

struct product {
    const char *id; /* "VIEW" */
    enum product_root root;
    const char *folder, *file; /* with {placeholders}; the path is FOLDER/FILE, or FILE where the folder is "" */
    enum product_format format;
    const char *head; /* its first line, "remodel-axes 1", with the version that is written; NULL: it has none */
    const char *stages, *meaning; /* names with blanks between them */
};

extern const struct product products[PRODUCT_COUNT]; /* by enum product_id */

/* The depth of a scene with a model, from the round that knows it, as struct product_key's depth. */
#define MODEL_DEPTH "depth/model"
/* The view-independent atlas of the unedited model, from which those of viewpoints take what no photo shows. */
#define FILL_ATLAS "fill"

/* Which fields of struct product_key the path has: 1 << PRODUCT_HAS_view, ... 0: there is one in a scene. */
unsigned product_keys(enum product_id id);
bool product_made_by(enum product_id id, const char *stage);

/* The path below the scene's folder (products[id].root says which one). ST_IO: too long. The key must have all names
 * that the path has. */
enum status product_path(char path[FILE_PATH], enum product_id id, const struct product_key *key, struct err *err);
/* The path with the scene's folder in front. */
enum status product_path_below(char path[FILE_PATH], const char *scene, enum product_id id,
                               const struct product_key *key, struct err *err);
/* FOLDER/FILE, where `folder` is given and stands for products[id].folder. */
enum status product_path_in(char path[FILE_PATH], const char *folder, enum product_id id, const struct product_key *key,
                            struct err *err);

/* The product whose path ends `path`, which may begin with any folders; of several the one that has most of it in
 * letters of its own ("ids/index.txt" is no view's). PRODUCT_COUNT: none. */
enum product_id product_at(const char *path);

/* The part of a path that names the product in the provenance: "views/IMG_1.exr" where the path ends so, otherwise its
 * file alone, without the folders that somebody gave. PRODUCT_COUNT: no product, the file's name. */
const char *product_name(enum product_id id, const char *path);

/* Opens a text product, records it in prov, which may be NULL, and reads its first line: ST_DATA unless that has the
 * product's word and a version up to the one that is written. *version (may be NULL) gets it. On failure t is empty. */
enum status product_open(struct textfile *t, int *version, enum product_id id, const char *path,
                         struct provenance *prov, struct err *err);
enum status product_read_head(struct textfile *t, int *version, enum product_id id, struct err *err);
/* Opens a text product for writing, and writes its head: prov, which may be NULL, and the first line. */
enum status product_begin(struct outfile *f, enum product_id id, const char *path, const struct provenance *prov,
                          struct err *err);

/* "views/VIEW.exr": the path as documents write it, with the names of its placeholders. */
enum status product_pattern(char pattern[FILE_PATH], enum product_id id, struct err *err);

#endif
