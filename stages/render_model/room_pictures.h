/* room_pictures.h - the pictures that render_model makes: of original views, of given cameras, of the frames of a film.
 * */
#ifndef REMODEL_ROOM_PICTURES_H
#define REMODEL_ROOM_PICTURES_H

#include "common/base/cli.h"
#include "common/capture/camera_path.h"
#include "common/texture/viewpoint_pairs.h"
#include "stages/render_model/room_camera.h"

/* Writes OUT/VIEW.txt of each view, and where the edit changes something OUT/VIEW.jpg, VIEW-sources.png (what each
 * pixel comes from) and, with [render_model] radiance = yes, VIEW.exr. ST_USAGE: no such view. */
enum status pictures_of_views(struct room *room, const struct cli_list *views, const char *out, struct provenance *prov,
                              struct err *err);

/* Writes OUT/NAME.exr, NAME.jpg, NAME-sources.png and NAME.txt of each camera, then OUT/pictures.txt, the list of them;
 * names: those wanted, empty: all. ST_USAGE: no such name. */
enum status pictures_of_cameras(struct room *room, const struct camera_source *source, const struct cli_list *names,
                                const char *out, struct provenance *prov, struct err *err);

/* Writes OUT/NNNN.exr of the wanted frames: R G B A (half), times the scene's exposure. The path is in the frame of
 * O/views. */
enum status pictures_of_frames(struct room *room, const struct camera_path *path, const struct viewpoint_pairs *pairs,
                               const bool *wanted, const char *out, struct provenance *prov, struct err *err);

#endif
