/* contents.h - what a scene's folders hold for the page, thumbnails included.
 *
 * folder is out/SCENE of one quality, shared the folder of its photographs and SfM (they may be the same). What is missing
 * or cannot be read is a sentence in `notes`, not an error: a page tells about half-made scenes too. */
#ifndef REMODEL_CONTENTS_H
#define REMODEL_CONTENTS_H

#include "common/capture/camera_path.h"
#include "common/capture/lens_list.h"
#include "common/capture/photo_list.h"
#include "stages/report/metric_rows.h"
#include "stages/report/pictures.h"
#include "stages/report/settings.h"
#include "stages/report/usage.h"

enum { NOTE_SIZE = 1024, PICTURE_HEIGHT = 240, HELD_HEIGHT = 360, AXES_HEIGHT = 480 };

struct photo_card {
    const struct photo_record *record;
    int views; /* made from it; 0: SfM could not place it, or it is held out */
    bool held_out;
    struct picture picture;
    char trouble[NOTE_SIZE]; /* why there is no picture, or "" */
};

struct view_card {
    const struct view *view;
    const struct photo_record *photo;                     /* NULL if it cannot be told */
    struct picture picture, depth_picture, truth_picture; /* both depths in the same colours */
    struct depth_thumb depth, truth;                      /* truth: as `evaluate` left it; empty if it did not */
    uint32_t segments;
    double inherited; /* share of the pixels that have only their neighbours' depth; -1: the depth map does not say */
    double near,
        far; /* the true depths, else its own, without 2 % at either end: the colours' ends; 0 if none is known */
    char trouble[NOTE_SIZE];
};

struct held_card { /* a view that was held out */
    const struct view *view;
    struct picture picture, frame; /* the photograph, and what was rendered in its place */
    char trouble[NOTE_SIZE];
};

struct pan_card { /* the same move in 2D, if it was made */
    char *video;  /* file name, owned; NULL if there is none */
    long long video_bytes;
    char view[256];        /* whose photograph it shows; "" unknown */
    double misfit[2];      /* of the first and the last frame: px by which it misses the scene's points; -1 unknown */
    struct picture poster; /* the first frame */
};

struct effect_card {
    char name[256];
    struct camera_path path; /* frame_count 0: not planned, or it cannot be read */
    char *video;             /* file name, owned; NULL if there is none */
    long long video_bytes;
    double *holes, *unfilled; /* a frame: share of its pixels, before and after filling; -1 unknown */
    int frames_found;
    struct picture poster; /* the first frame */
    char *validity;        /* file name of the picture of its move's valid viewpoints, owned; NULL if there is none */
    struct pan_card pan;
};

struct axes_card { /* a view on which the room's axes are drawn */
    char view[256];
    struct picture picture;
};

struct model_card {           /* a solid model: that of the scene's script, or of an edit */
    char name[256];           /* "" for the unedited one */
    char *plan, *view;        /* files of its pictures, owned; NULL if there is none */
    char **overlays, **named; /* files with its edges on photographs, owned, and the photographs' ids */
    int overlay_count;
};

struct contents {
    struct photo_list photos;
    struct camera_set views;
    struct lens_list lenses;
    bool has_photos, has_views;

    struct photo_card *photo_cards; /* photos.count */
    struct view_card *view_cards;   /* views.view_count */
    struct camera_set held;
    struct lens_list held_lenses;
    struct held_card *held_cards; /* held.view_count */
    struct effect_card *effects;
    int effect_count;
    struct axes_card *axes;
    int axes_count;
    struct model_card *models;
    int model_count;
    bool has_metrics;
    struct metric_rows metrics, view_metrics;
    char (*left_out)[256]; /* photographs in the folder that are not in the list */
    int left_out_count;

    double known;                   /* mean share of pixels with a depth, over views that have a depth map */
    double inherited;               /* the same of inherited ones; -1: some depth map does not say */
    int depth_count;                /* views that have one */
    long long segments;             /* of all views */
    double error_median, error_rms; /* reprojection of the points into the rectified views, px */
    double track_mean;              /* observations a point */

    struct usage_table usage;
    struct settings settings;

    char (*notes)[NOTE_SIZE];
    int note_count;
};

/* defaults may be NULL. ST_IO if `folder` is not there; ST_NOMEM. */
enum status contents_read(struct contents *c, const char *folder, const char *shared, const char *photos,
                          const char *defaults, struct err *err);
void contents_release(struct contents *c);

#endif
