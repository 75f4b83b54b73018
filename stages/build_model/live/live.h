/* live.h - the model of a scene while somebody draws it: what a page calls of the WebAssembly module, one scene at a
 * time.
 *
 * The page puts files into the module's file system, under the paths that they have in the scene, and calls these
 * functions with such paths. Functions return 0, or another number after a failure, which live_error() says as a
 * sentence. Model frame and units; pixels are those of the photographs as they are stored. */
#ifndef REMODEL_BUILD_MODEL_LIVE_H
#define REMODEL_BUILD_MODEL_LIVE_H

#include <stddef.h>

/* exported; everything else of the module is hidden */
#pragma GCC visibility push(default)

/* Memory for a text or numbers that the caller writes; NULL: there is none. live_free() releases it. */
void *live_alloc(size_t size);
void live_free(void *memory);

/* What the last function that failed says; "" if none did. */
const char *live_error(void);

/* Reads cameras and axes; points may be NULL or "", and so may config, a file of parameters. Forgets what was read
 * before. */
int live_begin(const char *views, const char *axes, const char *points, const char *config);
void live_end(void);

/* Builds the model of a script and of an edit. things, edit, scene and base as in building.h; NULL or "": none. The
 * last model that could be built stays after a failure. */
int live_build(const char *script, const char *things, const char *edit, const char *scene, const char *base);
/* Writes plan.txt, merged.txt and model.txt of the last model into a folder, as build_model does, of an edit with a
 * base also texture.txt and objects.txt. */
int live_write(const char *folder);
int live_write_plan(const char *path); /* plan.svg of it */
int live_plan_place(void);             /* left, top and scale of plan.svg: plan_picture.h */

/* JSON, valid until the next call of the same function; NULL after a failure. */
const char *live_model(void);  /* the plan and the faces of the last model: live_json.h */
const char *live_photos(void); /* [{"id": ..., "width": ..., "height": ..., "centre": [x, y, z]}, ...] */

/* Numbers of the last function that says so. */
const double *live_numbers(void);

/* Edges of the last model in a photo, as u, v and flags (1: visible, 2: glass, 4: the first dot of an edge) of each
 * dot. apart: px between dots. Returns how many dots there are, or -1. */
int live_edges(int photo, double apart);
/* Points of the scene that face a photo's camera and lie in it, as u, v and the axis of their normal (0 to 2, 3: none).
 * Every point that is not of the first `most` is passed over evenly. Returns how many there are, or -1. */
int live_points(int photo, int most);
/* The ray of a pixel: origin and direction, six numbers. */
int live_ray(int photo, double u, double v);
/* The first face that the pixel shows, whose name live_picked() has: x, y, z of the place. */
int live_pick(int photo, double u, double v);
const char *live_picked(void);
/* The pixel of a point: u, v. Not 0: the lens does not show it. */
int live_project(int photo, double x, double y, double z);
/* The ceiling's height, 0 if it is unknown, and whether units are metres. */
double live_ceiling(void);
int live_is_metric(void);

/* Furniture, in the order of its numbers from 1: its middle, the radius of a ball that holds it, and whether it hangs
 * from the ceiling, which leaves it where a place is cleared; and memory for
 * which of it a photo shows, on a grid of its pixels, for the caller to fill; NULL after a failure. live_begin()
 * forgets both. */
int live_thing(const char *name, double x, double y, double z, double radius, int hangs);
/* Its surface, for what stands elsewhere after an edit: memory for nine numbers a triangle, its corners, for the caller
 * to fill. thing: from 0. NULL after a failure. */
float *live_thing_corners(int thing, int triangles);
unsigned char *live_mask(int photo, int columns, int rows);
/* Compares the last model, of an edit, with the rooms of the script alone: a draft of what make remodel draws. Building
 * a model forgets it. */
int live_draft(const char *script, const char *things);
/* Rows of a grid over a photo; for each cell its kind (0: what a photo shows at a pixel, 1: a colour, 2: what no photo
 * shows), the photo, then u and v of the pixel or the albedo. Returns how many cells there are, or -1. */
int live_draft_rows(int photo, int columns, int rows, int first, int count);
/* Pixels of a grid over a photo that another one shows too, in the rooms as they were photographed: u, v in both.
 * Returns how many there are, or -1. */
int live_shared(int photo, int other, int columns, int rows);
/* For each piece of furniture whether the edit takes it from its place, 0 or 1. Returns how many there are. */
int live_draft_gone(void);
/* What stands at a new place, and objects: the furniture's number from 0, -1 for an object, and x, y, z of its middle.
 * Returns how many there are. */
int live_draft_placed(void);

#pragma GCC visibility pop

#endif
