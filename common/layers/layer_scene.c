/* layer_scene.c - reading and packing of a scene of layered depth maps; see layer_scene.h. */
#include "common/layers/layer_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/math/weighted.h"
#include "common/product/product.h"

#define NEAR_PERCENTILE 0.02
#define FAR_PERCENTILE  0.98

static enum status measure_depths(struct layer_scene *s, struct err *err)
{
    size_t max_count = 1, count = 0;
    for (int i = 0; i < s->set->view_count; i++) max_count += (size_t)s->depths[i].segment_count;
    struct weighted *depths = malloc(max_count * sizeof *depths), *sigmas = malloc(max_count * sizeof *sigmas);
    if (!depths || !sigmas) {
        free(depths);
        free(sigmas);
        return err_nomem(err, "the segments' depths", 2 * max_count * sizeof *depths);
    }
    for (int i = 0; i < s->set->view_count; i++)
        for (int k = 0; k < s->depths[i].segment_count; k++) {
            const struct depth_segment *seg = &s->depths[i].segments[k];
            const struct segment_shape *shape = &s->views[i].shapes[k];
            const double inverse = seg->plane[0] * shape->u + seg->plane[1] * shape->v + seg->plane[2];
            if (!(inverse > 0) || !(shape->pixels > 0)) continue;
            depths[count] = (struct weighted){1 / inverse, shape->pixels};
            sigmas[count++] = (struct weighted){seg->sigma, shape->pixels};
        }
    s->near_depth = weighted_percentile(depths, count, NEAR_PERCENTILE);
    s->far_depth = weighted_percentile(depths, count, FAR_PERCENTILE);
    s->sigma = weighted_percentile(sigmas, count, 0.5);
    free(depths);
    free(sigmas);
    return ST_OK;
}

static enum status scene_open(struct layer_scene *s, const struct camera_set *set, struct err *err)
{
    *s = (struct layer_scene){.set = set};
    s->depths = calloc((size_t)set->view_count + 1, sizeof *s->depths);
    s->views = calloc((size_t)set->view_count + 1, sizeof *s->views);
    return s->depths && s->views ? ST_OK
                                 : err_nomem(err, "the views of a scene", (size_t)set->view_count * sizeof *s->depths);
}

static enum status scene_add(struct layer_scene *s, int view, struct err *err)
{
    const struct layered_depth *d = &s->depths[view];
    const struct view *v = &s->set->views[view];
    if (d->width != v->width || d->height != v->height)
        return err_set(
            err, ST_DATA,
            "the depth map of view %s has %d x %d pixels, but its camera has %d x %d. Make the depth map again.",
            v->name, d->width, d->height, v->width, v->height);
    return layer_view_pack(&s->views[view], &s->depths[view], v->name, err);
}

enum status layer_scene_read(struct layer_scene *scene, const struct camera_set *set, const char *depth_folder,
                             struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    scene_open(scene, set, err);

    for (int i = 0; !err->status && i < set->view_count; i++) {
        const char *view = set->views[i].name;
        if (!product_path_in(path, depth_folder, PRODUCT_DEPTH, &(struct product_key){.view = view}, err) &&
            !layered_depth_read(&scene->depths[i], path, prov, err))
            scene_add(scene, i, err);
    }
    if (!err->status && !view_mesh_build(&scene->mesh, set, err)) measure_depths(scene, err);
    if (err->status) layer_scene_release(scene);
    return err->status;
}

enum status layer_scene_init(struct layer_scene *scene, const struct camera_set *set, struct layered_depth *depths,
                             struct err *err)
{
    scene_open(scene, set, err);

    for (int i = 0; i < set->view_count; i++) {
        struct layered_depth taken = depths[i];
        depths[i] = (struct layered_depth){0};
        if (err->status) {
            layered_depth_release(&taken);
            continue;
        }
        scene->depths[i] = taken;
        scene_add(scene, i, err);
    }
    if (!err->status && !view_mesh_build(&scene->mesh, set, err)) measure_depths(scene, err);
    if (err->status) layer_scene_release(scene);
    return err->status;
}

enum status layer_scene_match_exposures(struct layer_scene *scene, struct err *err)
{
    photo_exposures_fit(&scene->exposures, scene->set, scene->views, err);
    for (int i = 0; !err->status && i < scene->set->view_count; i++)
        photo_exposures_remove(&scene->exposures, i, &scene->set->views[i], &scene->views[i], err);
    return err->status;
}

struct soft_z layer_scene_soft_z(const struct layer_scene *scene, double widths)
{
    const double range = fmax(scene->far_depth - scene->near_depth, 1e-6 * scene->far_depth);
    return (struct soft_z){.widths = (float)widths, .range = (float)range};
}

void layer_scene_release(struct layer_scene *scene)
{
    if (!scene) return;
    for (int i = 0; scene->set && i < scene->set->view_count; i++) {
        if (scene->depths) layered_depth_release(&scene->depths[i]);
        if (scene->views) layer_view_release(&scene->views[i]);
    }
    free(scene->depths);
    free(scene->views);
    view_mesh_release(&scene->mesh);
    photo_exposures_release(&scene->exposures);
    *scene = (struct layer_scene){0};
}
