/* renders.h - rendered pictures, RENDERED/WHERE/NAME, that belong to the true pictures TRUTH/WHERE.
 *
 * If RENDERED/WHERE has cameras.txt and images.txt (COLMAP text, in the frame of O/views), a picture has the camera of
 * its name there, and belongs to the true picture of the same name; the similarity of the cameras brings its camera
 * into the truth's world. Without them, a picture is named like a view of the scene and has its size; it belongs to the
 * true picture of the view's photograph. In both cases a picture is compared in its own pixels. */
#ifndef REMODEL_RENDERS_H
#define REMODEL_RENDERS_H

#include "stages/evaluate/scene/evaluation_parts.h"
#include "stages/evaluate/truth/linear_picture.h"

struct render {
    char name[256];
    char path[FILE_PATH], truth[FILE_PATH];
    const struct true_picture *of;
    struct picture_map map;
    double offset;                 /* m, from the true camera's centre; 0 for a view */
    struct linear_picture picture; /* after render_read(): released by the caller */
    double scale;                  /* of its values, to the radiance of the truth */
};

struct renders {
    const struct true_set *set;
    char where[80]; /* the folder's name among the inputs, below "rendered/" */
    struct render *list;
    int count;
    bool own_cameras;
};

/* The pictures that can be measured; notes in e->table say why others cannot. */
enum status renders_find(struct renders *list, struct evaluation *e, const struct true_set *set, struct err *err);
/* The same in FOLDER, which exists, and which the inputs call rendered/WHERE. */
enum status renders_find_in(struct renders *list, struct evaluation *e, const struct true_set *set, const char *folder,
                            const char *where, struct err *err);
void renders_release(struct renders *list);

/* The picture of the list with the same name and camera; NULL: there is none. */
struct render *renders_partner(const struct renders *list, const struct render *r);

/* Sets e->radiance_scale, if it is unknown, from these pictures, and e->white. */
enum status renders_scale(struct evaluation *e, struct renders *list, struct err *err);

/* Reads a picture and the true radiance at its pixels (4 channels); the caller releases both. */
enum status render_read(struct evaluation *e, const struct renders *list, struct render *r, struct image *truth,
                        struct err *err);

/* Writes the true cameras of the set, in the frame of O/views, to FOLDER/evaluate/cameras/WHERE, if the set has its own
 * and the cameras are aligned: render_views --cameras renders them. */
enum status renders_write_cameras(struct evaluation *e, const struct true_set *set, struct err *err);

#endif
