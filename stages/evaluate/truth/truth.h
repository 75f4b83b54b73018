/* truth.h - a folder with a truth: cameras.txt and images.txt (COLMAP text; an image has the name of its photo, with
 * any extension), and depth/NAME.exr for some of the images: channel Z, the size of the image, with the attribute
 * remodel:depth "z" or "ray"; without it, the length of the ray for fisheye lenses and z for others. The unit is
 * that of the cameras, normally metres. */
#ifndef REMODEL_TRUTH_H
#define REMODEL_TRUTH_H

#include "common/capture/photo_list.h"
#include "stages/evaluate/truth/true_depth.h"

struct truth {
    struct true_photo *photos; /* one per photo of the list; lens.width 0: the truth lacks it */
    int count;
    int images;         /* in images.txt */
    int unknown_images; /* of them, those that are not in the list of photos */
    int depths;         /* photos with a depth map */
};

/* Depths beyond `far` count as unknown. Adds the files it reads to prov. ST_DATA names the file. */
enum status truth_read(struct truth *t, const char *folder, const struct photo_list *photos, double far,
                       struct provenance *prov, struct err *err);
void truth_release(struct truth *t);

/* Reads a depth map into p->depth and p->along_ray; p->lens is known. The caller frees p->depth. ST_DATA: another size,
 * integers. */
enum status truth_photo_read_depth(struct true_photo *p, const char *path, double far, struct err *err);

#endif
