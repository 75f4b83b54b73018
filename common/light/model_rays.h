/* model_rays.h - a solid model (model.txt) that rays are traced against. */
#ifndef REMODEL_MODEL_RAYS_H
#define REMODEL_MODEL_RAYS_H

#include "common/capture/camera_set.h"
#include "common/light/ray_scene.h"
#include "common/model/solid_mesh.h"

enum model_glass { MODEL_WITHOUT_GLASS, MODEL_WITH_GLASS }; /* bodies "glass/...": panes of windows and doors */

/* {0} is the empty state; everything is owned. */
struct model_rays {
    struct solid_mesh mesh;
    struct ray_scene rays; /* ids are indices of faces */
    int ids;               /* largest id of a face name + 1 */
};

/* Reads a model.txt and builds the search tree. The caller releases the model. */
enum status model_rays_read(struct model_rays *m, const char *path, enum model_glass glass, struct provenance *prov,
                            struct err *err);
/* Builds the search tree of m->mesh, which the caller has set. */
enum status model_rays_build(struct model_rays *m, enum model_glass glass, struct err *err);
/* Further triangles beside those of a model; their ids are m->mesh.face_count + index. */
struct model_extra {
    const struct vec3 (*triangles)[3];
    int count;
};
/* Reads a model.txt and builds the search tree with them. */
enum status model_rays_read_with(struct model_rays *m, const char *path, enum model_glass glass,
                                 const struct model_extra *extra, struct provenance *prov, struct err *err);
void model_rays_release(struct model_rays *m);

/* The model's bounding box; all 0 without vertices. */
void model_rays_bounds(const struct model_rays *m, struct vec3 *low, struct vec3 *high);
/* Its largest side; 0 without vertices. */
double model_rays_size(const struct model_rays *m);
/* Its height; 0 without vertices. */
double model_rays_height(const struct model_rays *m);
/* The area of all its faces; needs no search tree. */
double model_rays_area(const struct model_rays *m);
/* Whether a point is within that box. */
bool model_rays_near(const struct model_rays *m, struct vec3 p);

/* Sets *direction to that of the ray through the centre of pixel (x, y), of any length; false: there is no ray. */
typedef bool model_ray_fn(const void *ctx, int x, int y, struct vec3 *direction);

/* Sets faces[y * width + x] to 1 + the index of the first face on the ray through the pixel, 0 if there is none.
 * Model frame. `direction` may be called by several threads at once. */
void model_rays_picture(uint32_t *faces, const struct model_rays *m, struct vec3 from, int width, int height,
                        model_ray_fn *direction, const void *ctx);
/* The same for a pinhole view in the model's frame (model_from_world_view()). */
void model_rays_view(uint32_t *faces, const struct model_rays *m, const struct view *view);

/* The inverse depth of a face's plane in a view (model frame): 1 / z = plane[0] u + plane[1] v + plane[2]. All 0 if the
 * camera is on the plane. */
void model_face_inverse_depth(double plane[3], const struct solid_face *face, const struct view *view);

#endif
