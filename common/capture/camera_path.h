/* camera_path.h - a camera move: out/SCENE/parallax/EFFECT/path/{cameras,images,points3D}.txt and path.txt beside it.
 *
 * The poses are COLMAP text, a PINHOLE camera a frame, image names "0001.exr"; all frames have one size, even in both
 * directions. path.txt holds what COLMAP's format cannot say:
 *   remodel-path 1
 *   effect establishing_dolly
 *   fps 30                           frames a second
 *   score NAME VALUE UNIT            any number of them; UNIT "" where there is none
 *   frames N
 *   frame 0001 TIME APERTURE FOCUS   N of them: seconds from the start; diameter and depth in focus in scene units */
#ifndef REMODEL_CAMERA_PATH_H
#define REMODEL_CAMERA_PATH_H

#include "common/capture/camera_set.h"

struct path_frame {
    struct view camera; /* its name is the frame's number, "0001"; owned by the path */
    double time;        /* seconds from the start */
    double aperture;    /* diameter in scene units, 0 pinhole */
    double focus;       /* depth in focus, 0 if aperture is 0 */
};

struct path_score {
    char name[64];
    double value;
    char unit[32];
};

struct camera_path {
    char effect[64];
    double fps;
    struct path_score *scores;
    int score_count;
    struct path_frame *frames;
    int frame_count;
};

/* Frames are named and timed; their cameras are the caller's to fill. ST_DATA: no frame, fps not above 0. */
enum status camera_path_init(struct camera_path *p, const char *effect, double fps, int frames, struct err *err);
enum status camera_path_add_score(struct camera_path *p, const char *name, double value, const char *unit,
                                  struct err *err);
/* folder: parallax/EFFECT. path.txt is written last. */
enum status camera_path_write(const struct camera_path *p, const char *folder, const struct provenance *prov,
                              struct err *err);
/* ST_DATA with file and line: missing frames, focal length <= 0, NaN, sizes that differ or are odd. */
enum status camera_path_read(struct camera_path *p, const char *folder, struct err *err);
void camera_path_release(struct camera_path *p);

#endif
