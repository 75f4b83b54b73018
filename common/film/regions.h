/* regions.h - subjects that a user draws: rectangles on photographs, in scenes/NAME/subjects.txt.
 *
 *   subject VIEW X0 Y0 X1 Y1
 * One line per subject, the most important one first; VIEW is a photo's id or a view's name. Coordinates are pixels of
 * the stored photograph, x to the right and y down, with (0, 0) at its upper left corner. */
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

/* An empty file is an empty list. ST_DATA with file and line: a malformed line, or a rectangle without area. */
enum status region_list_read(struct region_list *list, const char *path, struct provenance *prov, struct err *err);
void region_list_release(struct region_list *list);

/* Maps a region to a view, that of the photo's views which shows most of it. s: empty on entry; receives the upright
 * bounding box, in the view's pixels and clipped to it, of the region seen through the lens, without depth and corners.
 * *view_idx: the view; *part: the part of the region that it shows. path: the file's name for errors. ST_DATA: no such
 * photo or view, or no view shows the region. */
enum status region_in_view(struct subject *s, int *view_idx, double *part, const struct region *region,
                           const char *path, const struct camera_set *set, const struct lens_list *lenses,
                           struct err *err);

/* Clips the subject's rectangle to the picture; false if nothing is left. */
bool region_clip(struct subject *s, int width, int height);

#endif
