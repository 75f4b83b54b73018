/* scene_reader.h - the parts of the reader of scene.txt (scene_file.c), one function for each kind of line.
 *
 * Each function reads the words of a line after the first, to its end, and adds what they describe to r->scene. Errors
 * are ST_DATA with file, line, the word found and the word expected. */
#ifndef REMODEL_SIMULATE_SCENE_READER_H
#define REMODEL_SIMULATE_SCENE_READER_H

#include "common/base/textfile.h"
#include "stages/simulate/description.h"
#include "stages/simulate/scene_file.h"

#define MIN_METRES   1e-6
#define MAX_RADIANCE 1e9
#define MAX_LINES    100000

struct reader {
    struct scene *scene;
    struct textfile file;
    const char *folder;
    struct provenance *prov;
    int version, statements;     /* of the file; lines read of it, without the header */
    bool in_base, furniture;     /* reading the base of an edit; below `furniture on` */
    int base_items;              /* items of the base that are left; they are the first of the scene */
    int sun_line, panorama_line; /* in the base, or 0 */
};

/* Words. The second number of a range must be larger than the first. */
enum status scene_read_range(struct reader *r, const char *what, double *from, double *to, struct err *err);
enum status scene_read_colour(struct reader *r, const char *what, double max, struct rgb *c, struct err *err);
enum status scene_read_seed(struct reader *r, uint32_t *value, struct err *err);
/* One of `words`; *index is its position among them. */
enum status scene_read_choice(struct reader *r, const char *const *words, int count, const char *what, int *index,
                              struct err *err);

/* Names of what was read so far, for scan_nearest(); ctx is the scene. */
const char *scene_next_texture(const void *ctx, int i);
const char *scene_next_material(const void *ctx, int i);
const char *scene_next_item(const void *ctx, int i);
int scene_find_name(const struct scene *s, const char *name,
                    const char *(*next)(const void *ctx, int i)); /* -1: none */
enum status scene_read_known_name(struct reader *r, const char *what, const char *(*next)(const void *ctx, int i),
                                  int *index, struct err *err);
enum status scene_name_taken(struct reader *r, const char *name, const char *what, struct err *err);

/* Lines. */
enum status scene_read_texture(struct reader *r, struct err *err);
enum status scene_read_material(struct reader *r, struct err *err);
enum status scene_read_glow(struct reader *r, struct err *err);
enum status scene_read_item(struct reader *r, enum item_kind kind, struct err *err);
enum status scene_read_drop(struct reader *r, struct err *err);

/* Frees what an item owns. */
void scene_item_release(struct scene_item *it);

#endif
