/* lens_list.h - the photograph and the lens of each view: out/SCENE/views/lenses.txt.
 *
 *   remodel-lenses 1
 *   VIEW PHOTO MODEL WIDTH HEIGHT PARAMS... turn W X Y Z
 * One line per view, in order of view: the photo's id, its camera as COLMAP writes it (size and parameters in pixels of
 * the stored photo), and the rotation view_from_photo as a quaternion (1 0 0 0 unless the photo became several views,
 * PHOTO@k). */
#ifndef REMODEL_LENS_LIST_H
#define REMODEL_LENS_LIST_H

#include "common/base/provenance.h"
#include "common/base/textfile.h"
#include "common/capture/camera.h"

struct lens {
    char *view, *photo; /* owned */
    struct camera camera;
    struct quat view_from_photo;
};

struct lens_list {
    struct lens *lenses;
    int count;
};

/* Reads WIDTH HEIGHT PARAMS... of a camera of this model from a line. ST_DATA with file and line. */
enum status lens_read_camera(struct camera *c, const char *model, struct textfile *t, struct err *err);

enum status lens_list_read(struct lens_list *list, const char *path, struct provenance *prov, struct err *err);
enum status lens_list_write(const struct lens_list *list, const char *path, const struct provenance *prov,
                            struct err *err);
int lens_list_find(const struct lens_list *list, const char *view); /* -1: not found */
void lens_list_release(struct lens_list *list);

#endif
