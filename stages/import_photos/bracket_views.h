/* bracket_views.h - which photographs are exposures of one view: brackets.
 *
 * SCENE/brackets.txt says so; without it, the exposure times do. In order of file name, numbers by their value, a
 * bracketing camera leaves a cycle of exposures: 1/500 1/125 1/30 1/500 1/125 1/30 ... A cycle has 2 to 16 exposures,
 * any two of them at least 1.2 apart; it counts if it is seen at least twice and in at least 6 photos. If it holds all
 * photos they are brackets. If it holds three quarters of them a few are missing or too many, which is an error. Else
 * they are single photos. TIFF, EXR and raw files that are no brackets are single exposures, each of a view of its own,
 * and so are all photos where [import_photos] brackets = single: then they are brought to one scale, too. Where no
 * photo tells its exposure these are taken to be alike. Pictures cut out of photos (split_photos.h) are taken lens by
 * lens, so that one bracket of a multi-lens camera is a cycle, too.
 *
 * Lighting reference images without brackets.txt or cycle are one view if no two of them are exposed alike, else
 * single exposures.
 *
 * An exposure is seconds x ISO / (f-number^2 x filter): by EXIF, by exposures.txt in the photos' folder, by
 * SCENE/exposures.txt; the later one wins. */
#ifndef REMODEL_BRACKET_VIEWS_H
#define REMODEL_BRACKET_VIEWS_H

#include "stages/import_photos/exposure_list.h"
#include "stages/import_photos/import_params.h"
#include "stages/import_photos/photo_scan.h"

struct bracket_view {
    char *
        id; /* owned: the common beginning of its photos' names if that tells the views apart, else its first photo's */
    int *photos; /* into the scan, ascending in exposure; owned */
    int count;
    int middle; /* the median exposure; of an even number the shorter one */
};

struct bracket_views {
    bool bracketed;             /* else they are single photos */
    struct bracket_view *views; /* in order of id (strcmp) */
    int count;
    double white;               /* median of the views' middle exposures */
    bool untimed;               /* no photo states its exposure: they were taken to be alike */
    struct exposure *exposures; /* of each photo of the scan; owned */
};

/* Every photo that is not left out is good (photo_scan_check). scene: NULL if the photos belong to none. A view that
 * `exclude` names is left out; used[i] is set where exclude[i] did so. ST_DATA, naming the photos: what cannot be
 * grouped, photos of a view with different sizes, without or with the same exposure. {0} is the empty state. */
enum status bracket_views_find(struct bracket_views *v, const struct photo_scan *scan, const char *scene,
                               const struct import_params *params, const char *const *exclude, int exclude_count,
                               bool *used, struct err *err);

/* Writes the views' records, removes all others in the folder, and writes the list. */
enum status bracket_views_write(const struct bracket_views *v, const struct photo_scan *scan, const char *records,
                                struct err *err);

void bracket_views_release(struct bracket_views *v);

#endif
