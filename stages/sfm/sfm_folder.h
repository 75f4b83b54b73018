/* sfm_folder.h - the folder of models that the stage makes: made whole beside the old one, then put in its place. */
#ifndef REMODEL_SFM_FOLDER_H
#define REMODEL_SFM_FOLDER_H

#include "common/capture/photo_list.h"
#include "common/capture/sfm_model.h"

/* printf into memory that the caller frees; NULL: no memory, err is set. */
char *text_format(struct err *err, const char *fmt, ...) PRINTF_LIKE(2, 3);

/* Removes a folder and all in it; what its links point to stays. Fine if it is not there. */
enum status remove_tree(const char *path, struct err *err);

struct sfm_folder {
    char *out;  /* the product */
    char *work; /* out.work: private, COLMAP's own files */
    char *made; /* out.work/sfm: the product in the making */
    int models;
};

/* An empty work folder; one that an interrupted run left is removed. */
enum status sfm_folder_open(struct sfm_folder *f, const char *out, struct err *err);

/* Adds a model as made/N. */
enum status sfm_folder_add(struct sfm_folder *f, const struct sfm_model *m, const struct provenance *prov,
                           struct err *err);

/* Writes photos.txt and, last, models.txt, puts the folder in the place of `out` (exchanged in one step, so that there
 * is always one), and removes the old one and the work folder. */
enum status sfm_folder_commit(struct sfm_folder *f, const struct photo_list *photos, const struct provenance *prov,
                              struct err *err);

void sfm_folder_release(struct sfm_folder *f); /* leaves the work folder of a failed run to look at */

#endif
