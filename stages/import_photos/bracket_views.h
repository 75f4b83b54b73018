/* bracket_views.h - brackets: which photographs are exposures of one view.
 *
 * If SCENE/brackets.txt exists it lists them. Otherwise the exposures decide, in the order in which the camera took
 * the photos (photo_order.h): a bracketing camera leaves a cycle of 2 to 16 exposures. There are two kinds:
 *   Equal exposures: 1/500 1/125 1/30 1/500 1/125 1/30 ... The exposures of a cycle differ by factors of at least 1.2.
 *   It occurs at least twice and covers at least 6 photos.
 *   Equal steps: 1/60 1/240 1/15, 1/30 1/120 1/8 ... as in aperture priority, where the light of each view sets the
 *   first time. Steps agree within 15 %, since cameras round times. The range is a factor of 2 or more; exposures may
 *   be equal if three are different. (views - 1) x (exposures - 1) is at least 6, or at least 4 if the times show
 *   bursts: each pause between two exposures of a view is shorter than each between two views. If the pauses within
 *   views are longer than those between, they are single photos.
 *   All photos covered:            they are brackets. Equal exposures are preferred.
 *   Three quarters or more of them: some are missing or extra, which is an error; for equal exposures only if their
 *                                  range is a factor of 2, for equal steps only if that product is at least 12.
 *   Fewer:                         they are single photos. If two thirds of the exposures or more differ from the one
 *                                  before by a factor of 1.8, a warning names brackets.txt.
 * Photos with automatic exposure stay single: by chance, fewer than one set in 100 000 has equal steps. Where the order
 * of time gives no complete cycle, that of names is tried.
 *
 * Photos other than JPEG and PNG that are not brackets, and all photos if [import_photos] brackets = single, become
 * views of one exposure each and are brought to one scale. If no exposure is known, or, of
 * photos without EXR and raw files, not all of them, all are assumed to be equal.
 * Pictures cut out of photos (split_photos.h) are ordered lens by lens, so that one bracket of a multi-lens camera is
 * a cycle, too.
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

/* Gives the records of photos that are not grouped the exposures of exposures.txt. Their filters count as a lower ISO
 * speed. ST_DATA with file and line. */
enum status bracket_views_take_exposures(struct photo_scan *scan, const char *scene, struct err *err);

/* Writes the views' records, removes all other records in the folder, and writes the list. */
enum status bracket_views_write(const struct bracket_views *v, const struct photo_scan *scan, const char *records,
                                struct err *err);

void bracket_views_release(struct bracket_views *v);

#endif
