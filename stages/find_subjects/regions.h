/* regions.h - subjects that a user drew: rectangles on photographs, as scenes/NAME/subjects.txt has them.
 *
 *   subject VIEW X0 Y0 X1 Y1
 * a line a subject, the most important one first; VIEW is a photo's id or a view's name. Pixels are those of the
 * photograph as it is stored, x to the right and y down, (0, 0) its upper left corner. */
#ifndef REMODEL_REGIONS_H
#define REMODEL_REGIONS_H

#include "common/capture/lens_list.h"
#include "common/film/subject_list.h"

struct region {
    char *view; /* as written; owned */
    int line;
    double x0, y0, x1, y1; /* x0 < x1, y0 < y1 */
};

struct region_list {
    struct region *regions;
    int count;
};

/* An empty file is a list without regions. ST_DATA with file and line: not such a line, no area. */
enum status region_list_read(struct region_list *list, const char *path, struct err *err);
void region_list_release(struct region_list *list);

/* s: empty on entry; becomes the region's rectangle in the pixels of the view it is in (of a photo's several views, the
 * one that holds most of it), clipped to it, without depth and corners: the smallest upright rectangle that holds what
 * the lens makes of the region. *view_idx: of that view; *part: of the region, that it holds. ST_DATA: no such photo or
 * view, or no part of the region lies in it; path: to name. */
enum status region_in_view(struct subject *s, int *view_idx, double *part, const struct region *region,
                           const char *path, const struct camera_set *set, const struct lens_list *lenses,
                           struct err *err);

#endif
