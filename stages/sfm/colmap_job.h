/* colmap_job.h - COLMAP's commands on a work folder.
 *
 * COLMAP sees symbolic links with safe names (ID.EXT) in the work folder, not the photos' folder. Features and matches
 * are products of earlier stages; COLMAP verifies the matches and finds poses and points, on the processor only. Its
 * exit status alone is not trusted: callers count what it made. */
#ifndef REMODEL_COLMAP_JOB_H
#define REMODEL_COLMAP_JOB_H

#include "stages/sfm/colmap_progress.h"
#include "stages/sfm/sfm_folder.h"
#include "stages/sfm/start_lens.h"

struct sfm_input {
    const char *photos, *features, *matches; /* folders; features and matches: of ID.txt, or NULL */
    const struct photo_list *list;
    const struct sfm_params *params;
    struct provenance *prov; /* features, matches and COLMAP's version are added as inputs */
};

enum { COLMAP_STEPS = 4 };

struct colmap_job {
    const struct sfm_folder *folder;
    double started; /* clock_seconds() */
    const struct photo_list *photos;
    const struct sfm_params *params;
    const struct sfm_input *in;
    char *images, *database, *sparse; /* in the work folder; owned */
    char *logs[COLMAP_STEPS];         /* of step 1, 2, and so on; owned */
    int *features;                    /* of each photo; -1: COLMAP could not read it; owned */
    char lens[SFM_LENS_TEXT];
    bool single; /* one lens for all photos */
    bool known;  /* all photos are views of panoramas: their lenses are known */
};

/* Fills the work folder: links, names of logs; its own files for each model that is added to f. params may differ from
 * in->params. The job borrows its arguments. */
enum status colmap_prepare(struct colmap_job *job, const struct sfm_folder *f, const struct sfm_input *in,
                           const struct sfm_params *params, struct err *err);

/* Runs one command; its output is appended to the log. args ends with NULL. */
enum status colmap_exit_status(int *status, const char *log, const char *const args[], struct err *err);
/* The same; an exit status above max_status is ST_IO with the last line of the log. */
enum status colmap_run(const char *log, const char *const args[], int max_status, struct err *err);
/* The same, with progress from the log; NULL: none. */
enum status colmap_run_long(const char *log, const char *const args[], int max_status, struct colmap_progress *progress,
                            struct err *err);
/* Sets ST_IO: the command, its exit status, the last line of its log. */
enum status colmap_failed(const char *log, const char *command, int status, struct err *err);

struct colmap_start {
    const char *folder; /* of the models, N from 0; it exists */
    int image;          /* id of the first image; 0: COLMAP chooses, and makes several models if one is not enough */
    bool relaxed;       /* the first pair may have a smaller angle and fewer inliers than by default */
};

/* Step 3: poses and points. The models are written to start->folder as 0, 1, and so on. If COLMAP finds no model, this
 * still succeeds: the caller counts the models. ST_IO: COLMAP failed. */
enum status colmap_map(const struct colmap_job *job, const struct colmap_start *start, struct err *err);

/* Moves the logs into the product's folder. */
enum status colmap_keep_logs(const struct colmap_job *job, struct err *err);

/* Gives the model's images, named ID.EXT, the names of the photos' files; a name that a text model cannot hold stays
 * ID.EXT. */
enum status colmap_name_images(struct sfm_model *m, const struct photo_list *photos, struct err *err);

/* The extension of a file's name, with its dot, if it is safe in a link's name, otherwise ".img"; COLMAP reads the
 * content. */
const char *colmap_extension(const char *file);

void colmap_job_release(struct colmap_job *job);

#endif
