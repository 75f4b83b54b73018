/* bracketed_view.h - a view of several exposures: its record, photos, and merged radiance. */
#ifndef REMODEL_BRACKETED_VIEW_H
#define REMODEL_BRACKETED_VIEW_H

#include "common/base/provenance.h"
#include "common/capture/camera.h"
#include "common/capture/photo_list.h"
#include "stages/hdr_merge/align.h"
#include "stages/hdr_merge/marked_pose.h"
#include "stages/hdr_merge/merge.h"
#include "stages/hdr_merge/outdoors_turn.h"
#include "stages/hdr_merge/reference_pose.h"

struct bracketed_view {
    struct photo_record record;
    struct photo photos[MERGE_MAX_EXPOSURES];
    double exposures[MERGE_MAX_EXPOSURES]; /* relative to that of white */
    struct response response;
    struct brackets brackets; /* refers to the above; shifts: those to correct, or NULL */
    struct alignment alignment;
    struct noise noise[MERGE_MAX_EXPOSURES];
    bool noise_measured;
    struct exposure_agreement agreement;
    bool agree; /* the photos agree with the stated exposures and the response */
    struct merged merged;
    bool placed; /* its lens and pose are known */
    struct camera lens;
    struct pose cam_from_world;
    struct frame_agreement frame; /* how its frame was found */
    struct marked_pose marked;    /* how its pose was found from marks */
    struct outdoors_turn turn;    /* how it was turned by what photos show outdoors */
};

/* Reads RECORDS/ID.txt, the photos in PHOTOS that it names, and the response curve (NULL: sRGB). v is {0} on entry;
 * release it also after a failure. ST_DATA: the record of a single photo, or more than MERGE_MAX_EXPOSURES
 * exposures. */
enum status bracketed_view_read(struct bracketed_view *v, const char *id, const char *photos, const char *records,
                                const char *response, struct provenance *prov, struct err *err);
/* Finds the view's lens and pose, to be written with the radiance, in the scene's frame: from a COLMAP text model, by
 * its photos' names, or from frame->marks; then model may be NULL. *known: the model or the marks have the view.
 * ST_DATA: the camera has another size; the frame or the pose cannot be found. */
enum status bracketed_view_place(struct bracketed_view *v, bool *known, const char *model,
                                 const struct reference_frame *frame, const struct merge_params *params,
                                 struct provenance *prov, struct err *err);
/* Finds shifts, checks the exposures, measures noise, merges. ST_DATA: exposures that disagree with the photos. */
enum status bracketed_view_merge(struct bracketed_view *v, const struct merge_params *params, struct err *err);
/* Turns a merged view that was placed in an opening by what photos show through it. */
enum status bracketed_view_turn(struct bracketed_view *v, const struct reference_frame *frame,
                                const struct merge_params *params, struct provenance *prov, struct err *err);
/* Writes OUT/ID.jpg: the tone-mapped radiance or the middle exposure; a JPEG is copied, other formats are encoded. */
enum status bracketed_view_write_picture(const struct bracketed_view *v, const char *photos, const char *out,
                                         const struct merge_params *params, struct err *err);
/* Writes OUT/ID.exr. *clamped: number of samples above the range of half, clamped to it. */
enum status bracketed_view_write_radiance(const struct bracketed_view *v, const char *out,
                                          const struct provenance *prov, size_t *clamped, struct err *err);
void bracketed_view_release(struct bracketed_view *v);

#endif
