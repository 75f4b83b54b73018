/* camera_path.h - a camera move: out/SCENE/parallax/EFFECT/path/{cameras,images,points3D}.txt and path.txt beside it.
 *
 * The poses are a COLMAP text model with one PINHOLE camera per frame and image names "0001.exr"; all frames have the
 * same size, even in both directions. path.txt has the values that COLMAP's format lacks:
 *   remodel-path 1
 *   effect establishing_dolly
 *   fps 30                           frames per second
 *   score NAME VALUE UNIT            any number of lines; UNIT "" if there is none
 *   frames N
 *   frame 0001 TIME APERTURE FOCUS   N lines: seconds from the start; diameter and depth of focus in scene units */
#ifndef REMODEL_CAMERA_PATH_H
#define REMODEL_CAMERA_PATH_H

#include "common/capture/camera_set.h"

struct path_frame {
    struct view camera; /* name: the frame's number, "0001"; owned by the path */
    double time;        /* seconds from the start */
    double aperture;    /* diameter in scene units; 0: pinhole */
    double focus;       /* depth of the focal plane; 0 if aperture is 0 */
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

/* Names the frames and sets their times; the caller fills in their cameras. ST_DATA: no frames, fps not above 0. */
enum status camera_path_init(struct camera_path *p, const char *effect, double fps, int frames, struct err *err);
enum status camera_path_add_score(struct camera_path *p, const char *name, double value, const char *unit,
                                  struct err *err);
/* folder: parallax/EFFECT. path.txt is written last. */
enum status camera_path_write(const struct camera_path *p, const char *folder, const struct provenance *prov,
                              struct err *err);
/* ST_DATA with file and line: missing frames, focal length <= 0, NaN, sizes that differ or are odd. */
enum status camera_path_read(struct camera_path *p, const char *folder, struct provenance *prov, struct err *err);
void camera_path_release(struct camera_path *p);

#endif
