/* truth.h - a folder of truth: cameras.txt and images.txt (COLMAP text, an image named as its photo, with any ending), and
 * depth/NAME.exr for some of the images (Z, as large as the image; attribute remodel:depth "z" or "ray", without it
 * the length of the ray for fisheye lenses and z for others). Unit: metres, or whatever the cameras are in. */
#ifndef REMODEL_TRUTH_H
#define REMODEL_TRUTH_H

#include "common/capture/photo_list.h"
#include "stages/evaluate/true_depth.h"

struct truth {
    struct true_photo *photos; /* of photo i of the list; lens.width 0: the truth does not know it */
    int count;
    int images, strangers; /* in images.txt; those that are none of the photos */
    int depths;            /* photos with a depth map */
};

/* Depths beyond `far` are taken for unknown. Adds what it reads to prov. */
enum status truth_read(struct truth *t, const char *folder, const struct photo_list *photos, double far,
                       struct provenance *prov, struct err *err);
void truth_release(struct truth *t);

#endif
