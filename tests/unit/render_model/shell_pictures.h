/* shell_pictures.h - shared by the tests of the shell: a painted room with a box, two viewpoints, pictures of it. */
#ifndef REMODEL_TESTS_SHELL_PICTURES_H
#define REMODEL_TESTS_SHELL_PICTURES_H

#include "tests/unit/render_model/painted_room.h"
#include "tests/unit/render_model/shell_doubles.h"

#include "stages/render_model/shell_scene.h"

static const struct box room[] = {ROOM_OUTSIDE, ROOM_INSIDE, {"box", "box", {-0.5, 0.4, 0.2}, {0.7, 2, 1.1}, false}};
static const struct box bare[] = {ROOM_OUTSIDE, ROOM_INSIDE};
static const struct outdoors some_outdoors;

/* The view of viewpoint a, that of b beside it, and one between them. */
static inline struct view view_a(void) { return view_at(vec3_make(-0.4, -0.3, -1.3), 0.1, 0.05, W, H, 60); }
static inline struct view view_b(void) { return view_at(vec3_make(0.6, -0.1, -1.1), -0.25, -0.02, W, H, 60); }
static inline struct view view_between(void) { return view_at(vec3_make(0.1, -0.2, -1.2), -0.05, 0.03, W, H, 60); }

static inline struct shell_scene *make_scene_with(struct solid_mesh mesh, struct texture_map map, const char *vita)
{
    struct shell_scene *scene;
    struct err err = ERR_INIT;
    assert_ok(shell_make(&scene, &mesh, &map, scratch_path("vdta"), vita, 100, &err), err);
    return scene;
}

static inline struct shell_scene *make_scene(const struct box *boxes, int count)
{
    return make_scene_with(make_boxes(boxes, count), (struct texture_map){0}, scratch_path("vita"));
}

static inline struct model_picture draw(struct shell_scene *scene, const struct view *camera, const char *a,
                                        const char *b, double t)
{
    const char *const photos[2] = {a, b};
    struct model_picture p = {0};
    struct err err = ERR_INIT;
    assert_ok(shell_draw(&p, scene, camera, photos, t, &some_outdoors, &err), err);
    for (int i = 0; i < 3 * p.width * p.height; i++) assert_true(isfinite(p.rgb[i]) && p.rgb[i] >= 0);
    for (int i = 0; i < p.width * p.height; i++) assert_true(isfinite(p.z[i]) && (p.z[i] > 0) == (p.id[i] > 0));
    return p;
}

/* The room with a box, viewpoints a and b and the VITA in three values. */
static inline void paint_room(enum paint paint, double a, double b, double vita)
{
    struct solid_mesh mesh = make_boxes(room, 3);
    const struct view from_a = view_a(), from_b = view_b();
    paint_viewpoint(&mesh, &from_a, "a", paint, a);
    paint_viewpoint(&mesh, &from_b, "b", paint, b);
    paint_vita(&mesh, paint, vita, 0.05);
    solid_mesh_release(&mesh);
}

static inline int pixels_made(const struct model_picture *p, enum picture_made made)
{
    int count = 0;
    for (int i = 0; i < p->width * p->height; i++) count += p->made[i] == made;
    return count;
}

static inline void assert_same_picture(const struct model_picture *p, const struct model_picture *q)
{
    const size_t pixels = (size_t)(p->width * p->height);
    assert_memory_equal(p->rgb, q->rgb, 3 * pixels * sizeof *p->rgb);
    assert_memory_equal(p->z, q->z, pixels * sizeof *p->z);
    assert_memory_equal(p->id, q->id, pixels * sizeof *p->id);
    assert_memory_equal(p->made, q->made, pixels);
}

/* Pixel (x, y) shows the face of this name. */
static inline bool shows(const struct shell_scene *s, const struct model_picture *p, int at, const char *name)
{
    for (int i = 0; i < s->mesh.name_count; i++)
        if (s->mesh.names[i].id == (int)p->id[at]) return !strcmp(s->mesh.names[i].name, name);
    return false;
}

#endif
