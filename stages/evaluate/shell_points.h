/* shell_points.h - what the true pictures of a scene show at points of its surfaces, without and with its furniture.
 *
 * A picture of TRUTH/shell shows the scene without furniture, its depth says where, and its ids differ from those of
 * the same camera with furniture (TRUTH/ids, TRUTH/novel/ids) where furniture stands in front. Points and normals are
 * in the truth's world. */
#ifndef REMODEL_SHELL_POINTS_H
#define REMODEL_SHELL_POINTS_H

#include "stages/evaluate/evaluation_parts.h"

#define FURNITURE_MARGIN 1 /* px: pixels this near furniture count as furniture, because outlines blend */
#define RADIANCE_MARGIN  1 /* px around the four that are interpolated: they must show the same surface */

struct surface_point {
    struct vec3 point, normal; /* unit, out of the solid */
};

struct shell_view {
    const char *name;   /* of the true picture; borrowed */
    int photo;          /* index into the list of photos; -1: a view that nobody photographed */
    struct camera lens; /* of the true picture */
    struct pose pose;   /* camera_from_world of the truth */
    float (*points)[3]; /* owned: the surface at each pixel's centre, in the truth's world */
    uint8_t *known;     /* owned; 0: the shell has no depth there */
    uint8_t *furniture; /* owned; 1: furniture stands in front; NULL: the truth has no ids of both kinds */
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

/* Reads the pictures of TRUTH/shell that have depths. Without any, count is 0. ST_DATA: a damaged picture. */
enum status shell_points_read(struct shell_points *s, struct evaluation *e, struct err *err);
void shell_points_release(struct shell_points *s);

/* A view from the shell's depth, as read by true_photo_read_depth(), and the ids of the shell and of the scene with
 * furniture, which may be NULL. The caller releases it. */
enum status shell_view_make(struct shell_view *v, const struct true_photo *shell, const uint32_t *shell_ids,
                            const uint32_t *whole_ids, struct err *err);
void shell_view_release(struct shell_view *v);

enum shell_sight {
    SHELL_HIDDEN_POINT, /* outside the picture, turned away, or behind another surface of the shell */
    SHELL_FURNITURE,    /* furniture stands in front */
    SHELL_CLEAN,        /* the camera sees the point, with furniture too */
};
/* How a camera sees a point; v->furniture must not be NULL for an answer other than hidden. */
enum shell_sight shell_view_sight(const struct shell_view *v, const struct surface_point *p, double tolerance);

/* The radiance that a view's picture shows at a point, interpolated linearly; false: it does not see it, or sees
 * another surface within RADIANCE_MARGIN px. The picture may be another one of the same camera. */
bool shell_view_radiance(float rgb[3], const struct shell_view *v, const struct image *picture,
                         const struct surface_point *p, double tolerance);

/* The true radiance of a point: from view `first` (-1: none), else from the view in which a small piece of the surface
 * takes the most pixels: cos / distance^2 times the two focal lengths. False: no picture shows it. */
bool shell_radiance(float rgb[3], const struct shell_points *s, const struct surface_point *p, int first);

#endif
