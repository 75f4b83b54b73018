/* contents.h - everything that the page shows of a scene, thumbnails included.
 *
 * A product that is missing or cannot be read becomes a sentence in `notes`, not an error: a scene that is only partly
 * made has a page too. */
#ifndef REMODEL_CONTENTS_H
#define REMODEL_CONTENTS_H

#include "common/capture/camera_path.h"
#include "common/capture/lens_list.h"
#include "common/capture/photo_list.h"
#include "stages/report/contents_light.h"
#include "stages/report/contents_relit.h"
#include "stages/report/contents_rooms.h"
#include "stages/report/metric_rows.h"
#include "stages/report/page_pictures.h"
#include "stages/report/settings.h"
#include "stages/report/stage_list.h"
#include "stages/report/usage.h"

#define REPORT_STAGE "report" /* this stage, whose own log is still open */

enum { NOTE_SIZE = 1024, PICTURE_HEIGHT = 180, HELD_HEIGHT = 360, AXES_HEIGHT = 400 };

enum { PAGES_SHOWN = 6, VIEWS_SHOWN = 60 }; /* of an atlas; of all, with their depth */

struct photo_card {
    const struct photo_record *record;
    int views; /* number of views made from it; 0: SfM could not place it, or it is held out */
    bool held_out;
    double residual; /* median reprojection error of its camera, px; 0: unknown */
    struct picture picture;
    char problem[NOTE_SIZE]; /* why there is no picture, or "" */
};

struct view_card {
    const struct view *view;
    const struct photo_record *photo;                     /* NULL: unknown */
    struct picture picture, depth_picture, truth_picture; /* both depths in one colour range */
    struct depth_thumb depth, truth;                      /* truth: written by `evaluate`; may be empty */
    uint32_t segments;
    double inherited; /* share of the pixels whose depth comes from adjacent segments; -1: unknown */
    /* range of the colours: the true depths, or else its own, without 2 % at either end; 0: no pixel has a depth */
    double near, far;
    char problem[NOTE_SIZE]; /* the last product that could not be read, or "" */
};

struct held_card { /* a held-out view */
    const struct view *view;
    struct picture picture, frame; /* the photograph, and the picture rendered in its place */
    char problem[NOTE_SIZE];       /* the last product that could not be read, or "" */
};

struct pan_card { /* the same move in 2D */
    char *video;  /* file name, owned; NULL: not made */
    long long video_bytes;
    char view[256];        /* the view that it shows; "": unknown */
    double misfit[2];      /* median error of the scene's points in the first and last frame, px; -1: unknown */
    struct picture poster; /* the first frame */
};

struct flicker_card { /* of a film, relative (film_flicker.h) */
    double middle, high;
    bool known;
};

struct tour_card {    /* a film of a walk through the rooms */
    char change[256]; /* "": the rooms as they are */
    bool relit;       /* in the light that the change makes */
    char *video;      /* file name, owned */
    long long bytes;
    struct flicker_card flicker;
};

struct film_kind { /* the film for two eyes, or in another format */
    char name[64]; /* "vr180-hlg" */
    char *file;    /* owned */
    long long bytes;
};

struct effect_card {
    char name[256];
    struct camera_path path; /* frame_count 0: missing, or it cannot be read */
    char *video;             /* file name, owned; NULL: not made */
    long long video_bytes;
    struct film_kind *kinds; /* by name; owned */
    int kind_count;
    double *holes, *unfilled; /* of each frame: share of its pixels before and after filling; -1: unknown */
    int frames_found;
    struct flicker_card flicker;
    struct picture poster; /* the first frame */
    char *validity;        /* file name of the picture of valid viewpoints, owned; NULL: not made */
    struct pan_card pan;
};

struct lens_form_row { /* a form of lens that was compared; -1: unknown */
    char lens[32], center[16], verdict[16];
    int parameters;
    double median, noise, bic; /* px, px, above the lowest */
};

struct axes_card { /* a view with the room's axes drawn on it */
    char view[256];
    struct picture picture;
};

struct model_card {                 /* a solid model */
    char name[256];                 /* the edit; "": the unedited model */
    char *plan, *view;              /* files of its pictures, owned; NULL: not made */
    char **overlays, **overlay_ids; /* files with its edges on photographs, and the photographs' ids; owned */
    int overlay_count, overlays_left_out;
};

struct texture_view { /* what a view shows of the model, with the atlas's texture */
    char name[256];
    struct picture photo, texture, sources; /* sources: where the texels come from, in colours */
};

struct texture_source {
    char *name; /* of a view; owned */
    bool original;
    unsigned char rgb[3];
    long long pixels; /* of the pictures of sources */
};

struct texture_card { /* an atlas */
    char name[256];   /* the photo; "": the view-independent one */
    struct texture_view *views;
    int view_count;
    struct picture pages[PAGES_SHOWN];
    int page_sizes[PAGES_SHOWN][2];
    int page_count, tile_count; /* of the atlas; the first PAGES_SHOWN pages have pictures */
    struct texture_source *sources;
    int source_count;
    long long empty, synthesised, by_default, total; /* pixels of the pictures of sources that show the model */
};

struct contents {
    struct stage_list stages;
    struct photo_list photos;
    struct camera_set views;
    struct lens_list lenses;
    const char *folder; /* of the scene */
    bool has_photos, has_views;
    bool has_remodel_page, has_walk, has_draw, has_levels; /* remodel/, walk/, draw/, lux/index.html exist */

    struct rooms rooms; /* before and after each change */
    struct tour_card *tours;
    int tour_count;

    struct photo_card *photo_cards; /* photos.count */
    struct view_card *view_cards;   /* views.view_count */
    struct camera_set held;
    struct lens_list held_lenses;
    struct held_card *held_cards; /* held.view_count */
    struct effect_card *effects;
    int effect_count;
    struct lens_form_row *lens_forms;
    int lens_form_count;
    struct axes_card *axes;
    int axes_count;
    struct model_card *models;
    int model_count;
    char *thing_sheet, *thing_plan; /* files of the pictures of all things, owned; NULL: not made */
    struct texture_card *textures;
    int texture_count, viewpoint_count; /* cards; viewpoints that have an atlas, shown or not */
    struct light_contents light;
    struct relit_card *relit; /* edits in the light that they make, with one view each */
    int relit_count;
    bool has_metrics;
    struct metric_rows metrics, view_metrics;
    char (*left_out)[256]; /* photographs of the folder that are not in the list */
    int left_out_count;

    double known;                   /* mean share of pixels with a depth, over views that have a depth map */
    double inherited;               /* the same for inherited depths; -1: unknown for some depth map */
    int depth_count;                /* views with a depth map */
    long long segments;             /* sum over the views */
    double error_median, error_rms; /* reprojection of the points into the rectified views, px */
    double track_mean;              /* observations per point */

    struct usage_table usage;
    struct settings settings;

    char (*notes)[NOTE_SIZE];
    int note_count;
};

struct contents_sources {
    const char *folder;   /* out/SCENE of one quality */
    const char *shared;   /* the folder of photo records and SfM; may be the same */
    const char *photos;   /* the folder of the photographs */
    const char *stages;   /* names of the pipeline's stages in data-flow order, separated by spaces */
    const char *defaults; /* default configuration, or NULL */
    const char *scripts;  /* of the edits, or NULL */
};

/* c is empty on entry; the caller releases it, also after an error. ST_IO: there is no `folder`; ST_USAGE: `stages` is
 * not a list of names; ST_NOMEM. */
enum status contents_read(struct contents *c, const struct contents_sources *from, struct err *err);
void contents_release(struct contents *c);

#endif
