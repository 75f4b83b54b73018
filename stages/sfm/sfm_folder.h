/* sfm_folder.h - the stage's output folder: written beside the old one, then exchanged with it in one step. */
#ifndef REMODEL_SFM_FOLDER_H
#define REMODEL_SFM_FOLDER_H

#include "common/capture/photo_list.h"
#include "common/capture/sfm_model.h"

/* printf into memory that the caller frees; NULL: out of memory, err is set. */
char *sfm_text_format(struct err *err, const char *fmt, ...) PRINTF_LIKE(2, 3);

/* Removes a folder and its contents, but not the targets of links. It may be missing. */
enum status sfm_remove_tree(const char *path, struct err *err);

struct sfm_folder {
    char *out;         /* the product */
    char *work;        /* out.work: COLMAP's own files */
    char *made;        /* out.work/sfm: the product being written */
    const char *given; /* what the user gave of all models: "nothing", "lens" or "model"; a literal */
    int models;
};

/* Makes an empty work folder; one left by an interrupted run is removed. ST_USAGE: `out` exists and is not a product of
 * this stage. */
enum status sfm_folder_open(struct sfm_folder *f, const char *out, struct err *err);

/* Adds a model as made/N. */
enum status sfm_folder_add(struct sfm_folder *f, const struct sfm_model *m, const struct provenance *prov,
                           struct err *err);

/* Writes photos.txt and, last, models.txt; exchanges the folder with `out` in one step, so that `out` never is missing
 * or incomplete; removes the old folder and the work folder. */
enum status sfm_folder_commit(struct sfm_folder *f, const struct photo_list *photos, const struct provenance *prov,
                              struct err *err);

void sfm_folder_release(struct sfm_folder *f); /* keeps the work folder of a failed run for inspection */

#endif
