/* shell_points.h - what the true pictures of a scene show at points of its surfaces, without and with its furniture.
 *
 * A picture of TRUTH/shell shows the scene without furniture, and its depth says where. Clutter stands in front of the
 * model where the ids of the shell differ from those of the same camera with furniture (TRUTH/ids, TRUTH/novel/ids), or
 * where the shell itself holds what the model lacks: a lamp, a beam. Points and normals are in the truth's world. */
#ifndef REMODEL_SHELL_POINTS_H
#define REMODEL_SHELL_POINTS_H

#include "stages/evaluate/scene/evaluation_parts.h"
#include "stages/evaluate/scene/traced_model.h"

#define CLUTTER_MARGIN  1 /* px: pixels this near clutter count as clutter, because outlines blend */
#define RADIANCE_MARGIN 1 /* px around the four that are interpolated: they must show the same surface */

struct surface_point {
    struct vec3 point, normal; /* unit, out of the solid */
    int face;                  /* id of the model's face */
};

struct shell_view {
    const char *name;   /* of the true picture; borrowed */
    int photo;          /* index into the list of photos; -1: a view that nobody photographed */
    struct camera lens; /* of the true picture */
    struct pose pose;   /* camera_from_world of the truth */
    float (*points)[3]; /* owned: the surface at each pixel's centre, in the truth's world */
    uint8_t *known;     /* owned; 0: the shell has no depth there */
    uint32_t *faces;    /* owned: id of the model's face at each pixel's centre, without glass; 0: none */
    uint8_t *clutter;   /* owned; 1: clutter stands in front of it; NULL: the truth has no ids of both kinds */
    struct image rgb;   /* 3 channels: true radiance of the shell; data NULL: none */
    struct vec3 centre; /* of the camera */
    struct mat3 world_to_camera;
};

struct shell_points {
    struct true_set set;
    struct shell_view *views;
    int count;
    double tolerance; /* from the surface's plane, in the unit of the truth: farther away is another surface */
};

/* Reads the pictures of TRUTH/shell that have depths, and traces the model from their cameras. Without any, count is 0.
 * ST_DATA: a damaged picture. */
enum status shell_points_read(struct shell_points *s, struct evaluation *e, const struct model_rays *model,
                              const struct model_frame *frame, struct err *err);
void shell_points_release(struct shell_points *s);

/* A view from the shell's depth, as truth_photo_read_depth() reads it. The caller releases it. */
enum status shell_view_make(struct shell_view *v, const struct true_photo *shell, struct err *err);
void shell_view_release(struct shell_view *v);
/* What is known of each pixel of a view. */
struct shell_pixel_ids {
    const uint32_t *shell, *whole; /* true ids without and with furniture */
    const uint32_t *faces;         /* ids of the model's faces */
    const float *distance;         /* of the shell's point from the plane of that face */
};
/* Sets faces and clutter. Points farther than `tolerance` from the model's face are not of the model. */
enum status shell_view_mark(struct shell_view *v, const struct shell_pixel_ids *ids, double tolerance, struct err *err);

enum shell_sight {
    SHELL_HIDDEN_POINT, /* outside the picture, turned away, behind another face of the model, or not known */
    SHELL_CLUTTER,      /* clutter stands in front */
    SHELL_CLEAN,        /* the camera sees the point, with furniture too */
};
/* How a camera sees a point. */
enum shell_sight shell_view_sight(const struct shell_view *v, const struct surface_point *p);

/* The radiance that a view's picture shows at a point, interpolated linearly; false: outside it. The picture may be
 * another one of the same camera. shell: wanted is the surface's; false too if the shell shows something else within
 * RADIANCE_MARGIN px. */
bool shell_view_radiance(float rgb[3], const struct shell_view *v, const struct image *picture,
                         const struct surface_point *p, double tolerance, bool shell);

/* The true radiance of a point: from view `first` (-1: none), else from the view in which a small piece of the surface
 * takes the most pixels: cos / distance^2 times the two focal lengths. False: no picture shows it. */
bool shell_radiance(float rgb[3], const struct shell_points *s, const struct surface_point *p, int first);

#endif
