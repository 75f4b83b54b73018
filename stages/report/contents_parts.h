/* contents_parts.h - the readers of contents_*.c, one per part of the page, and their helpers. */
#ifndef REMODEL_CONTENTS_PARTS_H
#define REMODEL_CONTENTS_PARTS_H

#include "common/base/file_path.h"
#include "common/product/product.h"
#include "stages/report/contents.h"

enum { PATH_SIZE = FILE_PATH + 512 }; /* bytes of a folder's path and of a file below it */

/* Adds a sentence to `notes`, cut at NOTE_SIZE. */
enum status contents_note(struct contents *c, struct err *err, const char *fmt, ...) PRINTF_LIKE(3, 4);

/* The product's path in the scene's folder. False: there is no such file. */
bool contents_product(char path[FILE_PATH], const char *folder, enum product_id id, const struct product_key *key);
/* The same path, owned by the caller; NULL: there is no such file, or no memory. */
char *contents_product_name(const char *folder, enum product_id id, const struct product_key *key);

/* The number from 0 to 1 that an attribute of a picture holds; -1: NULL, or another text. */
double share_from_text(const char *text);

/* Products that are missing or cannot be read become notes; only ST_NOMEM is an error. Views come after photographs
 * and metrics, the age of the metrics, held-out views, axes, textures and light after views. */
enum status contents_read_photos(struct contents *c, const char *shared, const char *folder, struct err *err);
enum status contents_read_metrics(struct contents *c, const char *folder, struct err *err);
enum status contents_read_views(struct contents *c, const char *folder, struct err *err);
enum status contents_read_lens(struct contents *c, const char *folder, struct err *err);
enum status contents_read_held(struct contents *c, const char *folder, struct err *err);
enum status contents_check_age(struct contents *c, const char *folder, struct err *err);
enum status contents_read_effects(struct contents *c, const char *folder, struct err *err);
enum status contents_read_tours(struct contents *c, const char *folder, struct err *err);
enum status contents_read_axes(struct contents *c, const char *folder, struct err *err);
enum status contents_read_models(struct contents *c, const char *folder, struct err *err);
void contents_find_things(struct contents *c, const char *folder);
enum status contents_read_textures(struct contents *c, const char *folder, struct err *err);
enum status contents_read_light(struct contents *c, const char *folder, struct err *err);
enum status contents_read_relit(struct contents *c, const char *folder, const char *shared, struct err *err);

void effect_card_release(struct effect_card *e);
void model_card_release(struct model_card *m);
void texture_card_release(struct texture_card *t);

#endif
