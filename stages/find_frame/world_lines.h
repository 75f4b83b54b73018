/* world_lines.h - the straight edges of all views in space: each spans a plane with its camera. */
#ifndef REMODEL_WORLD_LINES_H
#define REMODEL_WORLD_LINES_H

#include "common/capture/camera_set.h"
#include "common/capture/line_list.h"
#include "common/capture/room_frame.h"

struct world_line {
    int view, station;   /* station: of world_lines_place() */
    struct vec3 ends[2]; /* unit rays to the ends of the line */
    struct vec3 middle;  /* unit ray between them */
    struct vec3 normal;  /* unit, of the plane through the camera and the line */
    struct vec3 across;  /* unit, normal x middle: along the line, across the ray */
    double length;       /* px */
    double error;        /* of the line's direction about its middle, radians */
};

struct world_lines {
    struct world_line *lines; /* owned */
    int count, stations;
};

/* Adds the lines of a view. */
enum status world_lines_add(struct world_lines *w, const struct view *view, int view_idx, const struct line_list *list,
                            struct err *err);
void world_lines_release(struct world_lines *w);

/* A scene's size: the median distance of its points from the cameras that observed them; without points, the spread of
 * the cameras. 0: neither says anything. */
double world_lines_size(const struct camera_set *set);

/* Sets the lines' stations: views whose centres are within `reach` of each other have one, since they show a line from
 * the same place. ST_NOMEM. */
enum status world_lines_place(struct world_lines *w, const struct camera_set *set, double reach, struct err *err);

/* The angle between a line and a direction as the line's view shows them, seen at the line's middle, in radians: the
 * line may run along the direction if it is small. Near the direction's vanishing point it says nothing, and is
 * PI / 2. world_line_slope(): its tangent, or HUGE_VAL. */
double world_line_slope(const struct world_line *l, struct vec3 direction);
double world_line_angle(const struct world_line *l, struct vec3 direction);

/* Where the middle of a line that runs along a wall's heading lies, if it is on the wall: its height, up . X, and its
 * place along it. False: its view sees the wall from behind, or at a grazing angle. */
bool world_line_on_wall(double *height, double *place, const struct world_line *l, const struct frame_wall *wall,
                        const struct room_frame *f, const struct camera_set *set);

#endif
