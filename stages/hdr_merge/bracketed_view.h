/* bracketed_view.h - one view's exposures, its record, and the radiance merged from them, on disk and in memory. */
#ifndef REMODEL_BRACKETED_VIEW_H
#define REMODEL_BRACKETED_VIEW_H

#include "common/base/provenance.h"
#include "common/capture/camera.h"
#include "common/capture/photo_list.h"
#include "stages/hdr_merge/align.h"
#include "stages/hdr_merge/merge.h"

struct bracketed_view {
    struct photo_record record;
    struct photo photos[MERGE_MOST];
    double exposures[MERGE_MOST]; /* relative to white's */
    struct response response;
    struct brackets brackets; /* these, and the shifts that are corrected */
    struct alignment alignment;
    struct noise noise[MERGE_MOST];
    bool noise_measured;
    struct exposure_agreement agreement;
    bool agree; /* exposures and response are what the photos show */
    struct merged merged;
    bool placed; /* its lens and pose are known */
    struct camera lens;
    struct pose cam_from_world;
};

/* RECORDS/ID.txt, the photos it names in PHOTOS, and how samples follow light (response: NULL for the sRGB curve). v is
 * {0} on entry; release it also after a failure. ST_DATA: a single photo's record, or more exposures than MERGE_MOST.
 * */
enum status bracketed_view_read(struct bracketed_view *v, const char *id, const char *photos, const char *records,
                                const char *response, struct provenance *prov, struct err *err);
/* Lens and pose of the view in a COLMAP text model, by the photos' names, for the radiance to be written with;
 * *known: it is
 * there. ST_DATA: of another size. */
enum status bracketed_view_place(struct bracketed_view *v, bool *known, const char *model, struct provenance *prov,
                                 struct err *err);
/* Shifts, agreement, noise, radiance. ST_DATA: exposures that cannot be what is stated. */
enum status bracketed_view_merge(struct bracketed_view *v, const struct merge_params *params, struct err *err);
/* OUT/ID.jpg: tone-mapped; or the middle exposure, a JPEG's own bytes, anything else encoded. */
enum status bracketed_view_write_picture(const struct bracketed_view *v, const char *photos, const char *out,
                                         const struct merge_params *params, struct err *err);
/* OUT/ID.exr. *beyond: samples brighter than a half number holds, cut there. */
enum status bracketed_view_write_radiance(const struct bracketed_view *v, const char *out,
                                          const struct provenance *prov, size_t *beyond, struct err *err);
void bracketed_view_release(struct bracketed_view *v);

#endif
