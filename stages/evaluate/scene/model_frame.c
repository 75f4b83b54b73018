/* model_frame.c - see model_frame.h. */
#include "stages/evaluate/scene/model_frame.h"

enum status model_frame_read(struct model_frame *f, struct evaluation *e, struct mat3 room_from_world,
                             struct vec3 origin, struct err *err)
{
    char path[FILE_PATH];
    *f = (struct model_frame){
        .truth_from_scene = e->truth_from_scene, .room_from_world = room_from_world, .origin = origin};
    return evaluation_path(path, e, PRODUCT_AXES, NULL, err) ? err->status
                                                             : model_axes_read(&f->axes, path, e->prov, err);
}

struct vec3 truth_from_model_point(const struct model_frame *f, struct vec3 p)
{
    const struct similarity *s = &f->truth_from_scene;
    const struct vec3 scene = world_from_model_point(&f->axes, p);
    const struct vec3 world = vec3_add(vec3_scale(mat3_apply(s->rotation, scene), s->scale), s->translation);
    return mat3_apply(f->room_from_world, vec3_sub(world, f->origin));
}

struct vec3 model_from_truth_point(const struct model_frame *f, struct vec3 p)
{
    const struct similarity *s = &f->truth_from_scene;
    const struct vec3 world = vec3_add(mat3_apply(mat3_transpose(f->room_from_world), p), f->origin);
    const struct vec3 turned = mat3_apply(mat3_transpose(s->rotation), vec3_sub(world, s->translation));
    return model_from_world_point(&f->axes, vec3_scale(turned, 1 / s->scale));
}

struct vec3 model_from_truth_direction(const struct model_frame *f, struct vec3 d)
{
    const struct vec3 world = mat3_apply(mat3_transpose(f->room_from_world), d);
    return model_from_world_direction(&f->axes, mat3_apply(mat3_transpose(f->truth_from_scene.rotation), world));
}

double model_frame_truth_per_unit(const struct model_frame *f) { return f->truth_from_scene.scale / f->axes.scale; }
