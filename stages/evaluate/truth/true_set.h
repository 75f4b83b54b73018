/* true_set.h - a folder of true pictures with their cameras: TRUTH itself (its photographs), TRUTH/novel (views that
 * nobody photographed), TRUTH/edited-E (the edited scene), TRUTH/shell (the scene without its furniture).
 *
 * Cameras are FOLDER/cameras.txt and images.txt, or FOLDER-cameras.txt and FOLDER-images.txt beside it. A folder
 * without cameras has those of TRUTH and of TRUTH/novel. Pictures are FOLDER/KIND/NAME.exr, KIND being hdr, depth or
 * ids; or FOLDER/NAME.exr (radiance) and FOLDER/NAME-depth.exr. NAME is the image's name without its extension. */
#ifndef REMODEL_TRUE_SET_H
#define REMODEL_TRUE_SET_H

#include "common/base/provenance.h"
#include "common/capture/camera.h"

struct true_picture {
    char *name; /* owned */
    struct camera lens;
    struct pose pose; /* camera_from_world of the truth */
};

struct true_set {
    char where[64];  /* "novel", "edited-E", "shell"; "" for TRUTH itself */
    char prefix[64]; /* of its metrics: "novel", "edited.E", "shell" */
    char folder[FILE_PATH];
    struct true_picture *pictures; /* in order of name, each name once */
    int count;
    bool own_cameras; /* not those of TRUTH and TRUTH/novel */
};

/* Adds the files of cameras to prov. Without the folder, count is 0 and the result ST_OK. ST_DATA: damaged cameras. */
enum status true_set_read(struct true_set *set, const char *truth, const char *where, struct provenance *prov,
                          struct err *err);
void true_set_release(struct true_set *set);

const struct true_picture *true_set_find(const struct true_set *set, const char *name); /* NULL: not found */

/* The path of a picture's file of a kind ("hdr", "depth", "ids"); false if there is none. */
bool true_set_file(char path[FILE_PATH], const struct true_set *set, const char *kind, const char *name);

/* The names of the edits E with a folder TRUTH/edited-E, in order; at most 40 letters, digits, "_" and "-" each.
 * `others` counts folders with other names. The caller releases the list. */
struct true_edits {
    char (*names)[41];
    int count, others;
};
enum status true_edits_find(struct true_edits *list, const char *truth, struct err *err);
void true_edits_release(struct true_edits *list);

#endif
