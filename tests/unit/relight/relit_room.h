/* relit_room.h - shared by tests of relight: a room of edit_room.h, its atlas updated, a picture of it relit. */
#ifndef REMODEL_TESTS_RELIT_ROOM_H
#define REMODEL_TESTS_RELIT_ROOM_H

#include "stages/relight/relit.h"
#include "stages/update_vita/update.h"

#include "common/math/numbers.h"
#include "tests/unit/edit_room.h"

enum { WIDTH = 40, HEIGHT = 30, PIXELS = WIDTH * HEIGHT };

struct relit_room {
    struct light_change change;
    struct model_picture picture;
    struct pixels pixels;
    struct relit relit;
    struct relight_params params;
    float was[3 * PIXELS];
};

static const struct quat to_ceiling = {1, 0, 0, 0}, to_floor = {0, 1, 0, 0};

/* A wide picture from a place in the room: the colours of its faces, with a pattern. */
static inline void draw_picture(struct relit_room *r, struct vec3 from, struct quat turn, const float colours[6][3])
{
    const struct camera lens = {CAMERA_PINHOLE, WIDTH, HEIGHT, {14, 14, WIDTH / 2.0, HEIGHT / 2.0}};
    struct pose pose = {turn, vec3_scale(mat3_apply(mat3_from_quat(turn), from), -1)};
    const struct mat3 model_from_cam = mat3_transpose(mat3_from_quat(turn));
    const struct model_rays *m = &r->change.after.model;
    struct err err = ERR_INIT;
    assert_ok(model_picture_resize(&r->picture, WIDTH, HEIGHT, &err), err);
    model_picture_set_camera(&r->picture, &lens, &pose);
    for (int i = 0; i < PIXELS; i++) {
        struct vec3 ray;
        struct ray_hit hit;
        assert_true(camera_unproject(&lens, i % WIDTH + 0.5, i / WIDTH + 0.5, &ray));
        ray = mat3_apply(model_from_cam, ray);
        if (!ray_scene_hit(&m->rays, from, ray, &hit) || (int)hit.id >= m->mesh.face_count) continue;
        const int id = solid_face_id(&m->mesh, (int)hit.id);
        r->picture.made[i] = MADE_PHOTO;
        r->picture.id[i] = (uint32_t)id;
        r->picture.z[i] = 1;
        for (int c = 0; c < 3; c++)
            r->picture.rgb[3 * i + c] =
                id >= FIRST && id < FIRST + 6 ? colours[id - FIRST][c] * (1 + 0.02f * (float)(i % 7)) : 0;
    }
    memcpy(r->was, r->picture.rgb, sizeof r->was);
}

static inline const char *update_room(struct edit *e)
{
    const char *out = keep_path("relit");
    struct update_job job = {.files = e->files,
                             .params = UPDATE_PARAMS_DEFAULT,
                             .out = out,
                             .prov = {.stage = "update_vita", .version = "1"}};
    struct err err = ERR_INIT;
    job.params.spacing = 0.1;
    job.params.finest = 0.05;
    job.params.rays = 512;
    job.params.rounds = 1000;
    job.params.tolerance = 0.003;
    job.params.max_samples = 2000;
    assert_ok(update_vita(&job, &err), err);
    provenance_release(&job.prov);
    return out;
}

static inline void relight_picture(struct relit_room *r)
{
    struct err err = ERR_INIT;
    assert_ok(pixels_find(&r->pixels, &r->change, &r->picture, NULL, NULL, &err), err);
    assert_ok(relit_make(&r->relit, &r->picture, &r->pixels, &r->change, &r->params, &err), err);
}

/* Updates the atlas of an edit, draws a picture and relights it. */
static inline void relight_room(struct relit_room *r, struct edit *e, struct vec3 from, struct quat turn)
{
    struct err err = ERR_INIT;
    *r = (struct relit_room){.params = RELIGHT_PARAMS_DEFAULT};
    edit_write(e);
    update_room(e);
    e->files.edited_vita = keep_path("relit/vita");
    e->files.object_light = keep_path("relit/objects.txt");
    assert_ok(light_change_read(&r->change, &e->files, NULL, &err), err);
    draw_picture(r, from, turn, e->colours);
    relight_picture(r);
}

static inline void relit_room_release(struct relit_room *r)
{
    relit_release(&r->relit);
    pixels_release(&r->pixels);
    model_picture_release(&r->picture);
    light_change_release(&r->change);
}

static inline int by_value(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

/* All pixels are finite, and none is more than ten times as bright as the median of the 24 around it; `cause` (NULL:
 * none is) says which pixels may be. */
static inline void assert_no_fireflies(const struct relit_room *r, bool (*cause)(const struct relit_room *r, int i))
{
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % WIDTH, y = i / WIDTH;
        float around[25];
        int count = 0;
        for (int c = 0; c < 3; c++) {
            assert_true(isfinite(r->picture.rgb[3 * i + c]) && r->picture.rgb[3 * i + c] >= 0);
            assert_true(isfinite(r->relit.quotient[i][c]) && r->relit.quotient[i][c] >= 0);
            assert_true(isfinite(r->relit.albedo[i][c]));
        }
        for (int v = y - 2; v <= y + 2; v++)
            for (int u = x - 2; u <= x + 2; u++)
                if (u >= 0 && v >= 0 && u < WIDTH && v < HEIGHT)
                    around[count++] = r->picture.rgb[3 * (v * WIDTH + u) + 1];
        qsort(around, (size_t)count, sizeof *around, by_value);
        if (r->picture.rgb[3 * i + 1] > 10 * around[count / 2] + 1e-6f && !(cause && cause(r, i)))
            fail_msg("pixel (%d, %d) is %g, the median around it %g", x, y, (double)r->picture.rgb[3 * i + 1],
                     (double)around[count / 2]);
    }
}

#endif
