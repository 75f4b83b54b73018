/* bracket_views.h - brackets: which photographs are exposures of one view.
 *
 * If SCENE/brackets.txt exists it lists them. Otherwise the exposures decide. In order of file name, numbers by value,
 * a bracketing camera leaves a cycle of exposures: 1/500 1/125 1/30 1/500 1/125 1/30 ... A cycle has 2 to 16 exposures
 * that differ by factors of at least 1.2; it must occur at least twice and cover at least 6 photos.
 *   All photos covered:            they are brackets.
 *   Three quarters or more of them: some are missing or extra, which is an error.
 *   Fewer:                         they are single photos.
 * TIFF, EXR and raw files that are not brackets, and all photos if [import_photos] brackets = single, become views of
 * one exposure each and are brought to one scale. If no exposure is known, all are assumed to be equal. Pictures cut
 * out of photos (split_photos.h) are ordered lens by lens, so that one bracket of a multi-lens camera is a cycle, too.
 *
 * Lighting reference images without brackets.txt and cycle are one view if no two exposures are equal, otherwise views
 * of one exposure each.
 *
 * An exposure is seconds x ISO / (f-number^2 x filter). SCENE/exposures.txt overrides exposures.txt in the photos'
 * folder, which overrides EXIF. */
#ifndef REMODEL_BRACKET_VIEWS_H
#define REMODEL_BRACKET_VIEWS_H

#include "stages/import_photos/exposure_list.h"
#include "stages/import_photos/import_params.h"
#include "stages/import_photos/photo_scan.h"

struct bracket_view {
    char *id;    /* the common beginning of its photos' names if unique, otherwise its first photo's id; owned */
    int *photos; /* into the scan, ascending in exposure; owned */
    int count;
    int middle; /* the median exposure; of an even number the shorter one */
};

struct bracket_views {
    bool bracketed;             /* false: single photos */
    struct bracket_view *views; /* in order of id (strcmp) */
    int count;
    double white;               /* median of the views' middle exposures */
    bool untimed;               /* no exposure is known; all are assumed to be equal */
    struct exposure *exposures; /* of each photo of the scan; owned */
};

/* Photos that are not excluded must be valid (photo_scan_check). scene may be NULL. Views named in `exclude` are left
 * out; used[i] is set if exclude[i] named one. ST_DATA, naming the photos: photos that cannot be grouped, photos of a
 * view with different sizes, unknown exposures or equal exposures. {0} is the empty state. */
enum status bracket_views_find(struct bracket_views *v, const struct photo_scan *scan, const char *scene,
                               const struct photo_params *params, const char *const *exclude, int exclude_count,
                               bool *used, struct err *err);

/* Writes the views' records, removes all other records in the folder, and writes the list. */
enum status bracket_views_write(const struct bracket_views *v, const struct photo_scan *scan, const char *records,
                                struct err *err);

void bracket_views_release(struct bracket_views *v);

#endif
