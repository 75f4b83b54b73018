/* clip_frames.h - makes photos of clips and panoramas: a folder with frames, which later steps use as the photos.
 *
 * Frames are CLIP_fN.png (frame_name.h) of 8 bits, or of 16 if the clip has more, with the clip's colour space. Photos
 * beside them, and their exposures.txt, are links. Panoramas become views (panorama.h). frames.txt (clip_list.h) lists
 * the frames and their times. Frames are taken again only if their clip, the rule or a frame has changed. */
#ifndef REMODEL_CLIP_FRAMES_H
#define REMODEL_CLIP_FRAMES_H

#include "stages/import_photos/import_params.h"
#include "stages/import_photos/photo_scan.h"

/* Clips that cannot be used have `err` set. ST_DATA: some cannot be used, or all clips and photos together give only
 * one photo; frames.txt then stays unchanged. */
enum status clip_frames_make(struct photo_scan *scan, const char *out, const struct photo_params *params,
                             struct err *err);
/* Removes what an earlier call made. ST_IO. */
enum status clip_frames_remove(const char *out, struct err *err);

#endif
