/* box_room.h - a box room in which each face has one colour, two viewpoints and a held-out photo, and atlases of it. */
#ifndef REMODEL_TESTS_BOX_ROOM_H
#define REMODEL_TESTS_BOX_ROOM_H

#include "common/image/exr.h"
#include "common/image/image.h"
#include "stages/evaluate/texture/textures.h"
#include "tests/unit/scratch.h"

enum { W = 60, H = 44, FACES = 6, TILE = 64 };
static const struct vec3 room = {4, 3, 2.5}; /* from the origin */
static const char *const face_names[FACES] = {"x0", "x1", "y0", "y1", "z0", "z1"};

static inline float gray_of(int face) { return linear_from_srgb((float)(40 + 30 * face) / 255); }

static inline double side(int axis) { return axis == 0 ? room.x : axis == 1 ? room.y : room.z; }

/* -------------------------------------------------------------------------------------------------------- the scene */

static inline void write_model(const char *path)
{
    /* normals point into the room, as those of walls do */
    static const int quads[FACES][4] = {{2, 6, 4, 0}, {5, 7, 3, 1}, {4, 5, 1, 0},
                                        {3, 7, 6, 2}, {1, 3, 2, 0}, {6, 7, 5, 4}};
    static const int size = 4;
    struct solid_polygon polygons[FACES];
    struct vec3 vertices[8];
    struct solid_mesh mesh = {0};
    struct err err = ERR_INIT;
    for (int i = 0; i < 8; i++) vertices[i] = vec3_make(i & 1 ? room.x : 0, i & 2 ? room.y : 0, i & 4 ? room.z : 0);
    for (int i = 0; i < FACES; i++) {
        const double s = i % 2 ? -1 : 1;
        polygons[i] = (struct solid_polygon){face_names[i],
                                             "room",
                                             {i / 2 == 0 ? s : 0, i / 2 == 1 ? s : 0, i / 2 == 2 ? s : 0},
                                             i % 2 ? -side(i / 2) : 0,
                                             quads[i],
                                             &size,
                                             1};
    }
    assert_ok(solid_mesh_make(&mesh, vertices, 8, polygons, FACES, NULL, &err), err);
    assert_ok(solid_mesh_write(&mesh, path, NULL, &err), err);
    solid_mesh_release(&mesh);
}

/* A camera at `from` that looks along +y. */
static inline struct view view_at(const char *name, struct vec3 from)
{
    struct view v = {name, W, H, 40, 40, W / 2.0, H / 2.0, {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}}, {0, 0, 0}, from};
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, from), -1);
    return v;
}

/* The face that pixel i of the view shows, and where. */
static inline int face_at(const struct view *v, int i, struct vec3 *at)
{
    const struct vec3 d = vec3_sub(view_unproject(v, i % W + 0.5, i / W + 0.5, 1), v->center);
    const double from[3] = {v->center.x, v->center.y, v->center.z}, to[3] = {d.x, d.y, d.z};
    double nearest = INFINITY;
    int face = -1;
    for (int k = 0; k < 3; k++) {
        const double t = to[k] == 0 ? INFINITY : ((to[k] > 0 ? side(k) : 0) - from[k]) / to[k];
        if (t < nearest) nearest = t, face = 2 * k + (to[k] > 0);
    }
    *at = vec3_add(v->center, vec3_scale(d, nearest));
    return face;
}

static struct view cameras[3]; /* near, far, held out */
static struct view kept[2];    /* the first two in order of name */
static const struct evaluate_params params = EVALUATE_PARAMS_DEFAULT;

static struct provenance prov;

/* A scene with a near and a far viewpoint, and a held-out photo beside the near one. */
static inline struct evaluation scene_make(void)
{
    struct evaluation e = {.folder = scratch, .prov = &prov, .params = &params, .has_held = true};
    prov = (struct provenance){.stage = "test", .version = "1"};
    cameras[0] = view_at("near", vec3_make(1, 0.5, 1.2));
    cameras[1] = view_at("far", vec3_make(3.6, 0.4, 1.3));
    cameras[2] = view_at("held", vec3_make(1.237, 0.513, 1.291));
    kept[0] = cameras[1];
    kept[1] = cameras[0];
    e.views.cameras = (struct camera_set){.views = kept, .view_count = 2};
    e.held.cameras = (struct camera_set){.views = cameras + 2, .view_count = 1};
    return e;
}

static inline void scene_release(struct evaluation *e)
{
    metric_table_release(&e->table);
    provenance_release(&prov);
}

static inline int make_files(void **state)
{
    struct exr_image im;
    struct err err = ERR_INIT;
    struct vec3 at;
    float rgba[W * H * 4];
    if (scratch_make(state)) return -1;
    for (const char *const *f = (const char *const[]){"model", "holdout", "holdout/views", "reveal", "vdta", NULL}; *f;
         f++)
        mkdir(scratch_path(*f), 0777);
    scene_make();
    write_model(scratch_path("model/model.txt"));
    scratch_write("model/axes.txt", "remodel-axes 1\nrotation 1 0 0 0\ntranslation 0 0 0\nscale 1 metres\nceiling 2.5\n"
                                    "thickness none\nerror tilt 0\nerror heading 0\nerror floor 0\nerror ceiling 0\n"
                                    "error scale 0\n");
    for (int i = 0; i < W * H; i++) {
        const float gray = gray_of(face_at(&cameras[2], i, &at));
        for (int c = 0; c < 4; c++) rgba[4 * i + c] = c < 3 ? gray : 1;
    }
    assert_ok(exr_init_rgba(&im, rgba, W, H, &err), err);
    assert_ok(exr_write(&im, scratch_path("holdout/views/held.exr"), &prov, &err), err);
    exr_image_release(&im);
    return 0;
}

/* ---------------------------------------------------------------------------------------------------------- atlases */

static uint32_t texel_source = ATLAS_VIEWS; /* of all texels: the view "far" */

static inline void write_atlas(struct atlas *a, const float *grays, const char *folder)
{
    struct err err = ERR_INIT;
    struct atlas_page pages[FACES] = {{0}};
    char *sources[] = {(char *)(uintptr_t) "far", (char *)(uintptr_t) "near"};
    a->sources = sources;
    a->source_count = 2;
    assert_ok(atlas_pack(a, &err), err);
    for (int i = 0; i < a->page_count; i++)
        assert_ok(atlas_page_init(&pages[i], a->page_sizes[i][0], a->page_sizes[i][1], &err), err);
    for (int k = 0; k < a->tile_count; k++) {
        struct atlas_tile *t = &a->tiles[k];
        struct atlas_page *p = &pages[t->page];
        for (int j = 0; j < 2; j++) /* to the place on the page */
            for (int c = 0; c < 4; c++) t->matrix[j][c] += (j ? t->y : t->x) * t->matrix[2][c];
        for (int y = t->y; y < t->y + t->height; y++)
            for (int x = t->x; x < t->x + t->width; x++) {
                const int i = y * p->width + x;
                p->source[i] = texel_source;
                for (int c = 0; c < 3; c++) p->rgb[3 * i + c] = grays[t->face - 1];
            }
    }
    assert_ok(atlas_write(a, pages, folder, &prov, &err), err);
    for (int i = 0; i < a->page_count; i++) atlas_page_release(&pages[i]);
    free(a->page_sizes);
    a->page_sizes = NULL;
}

/* Orthogonal tiles of TILE x TILE texels: the face's first `share` of the first axis in it. */
static inline void write_vita(double share, float factor)
{
    struct atlas_tile tiles[FACES];
    struct atlas a = {.tiles = tiles, .tile_count = FACES};
    float grays[FACES];
    for (int i = 0; i < FACES; i++) {
        const int u = i / 2 == 0 ? 1 : 0, v = i / 2 == 2 ? 1 : 2;
        tiles[i] = (struct atlas_tile){.face = i + 1, .view = -1, .width = (int)(TILE * share), .height = TILE};
        tiles[i].matrix[0][u] = TILE / side(u);
        tiles[i].matrix[1][v] = TILE / side(v);
        tiles[i].matrix[2][3] = 1;
        grays[i] = factor * gray_of(i);
    }
    write_atlas(&a, grays, scratch_path("vita"));
}

/* A tile of each face, all of the size of the view: the faces are cut by looking up, not by texels. */
static inline void write_vdta(int camera, float factor)
{
    const struct view *v = &cameras[camera];
    char *views[] = {(char *)(uintptr_t)v->name};
    struct atlas_tile tiles[FACES];
    struct atlas a = {.viewpoint = views[0],
                      .centre = v->center,
                      .views = views,
                      .view_count = 1,
                      .tiles = tiles,
                      .tile_count = FACES};
    float grays[FACES];
    char name[64];
    for (int i = 0; i < FACES; i++) {
        tiles[i] = (struct atlas_tile){.face = i + 1, .view = 0, .width = W, .height = H};
        for (int c = 0; c < 4; c++) {
            const double x = c < 3 ? v->cam_from_world.m[0][c] : v->translation.x;
            const double y = c < 3 ? v->cam_from_world.m[1][c] : v->translation.y;
            const double z = c < 3 ? v->cam_from_world.m[2][c] : v->translation.z;
            tiles[i].matrix[0][c] = v->fx * x + v->cx * z;
            tiles[i].matrix[1][c] = v->fy * y + v->cy * z;
            tiles[i].matrix[2][c] = z;
        }
        grays[i] = factor * gray_of(i);
    }
    snprintf(name, sizeof name, "vdta/%s", v->name);
    write_atlas(&a, grays, scratch_path(name));
}

/* -1: the table lacks it. */
static inline double metric(const struct evaluation *e, const char *name)
{
    for (int i = 0; i < e->table.count; i++)
        if (!e->table.metrics[i].view[0] && !strcmp(e->table.metrics[i].name, name)) return e->table.metrics[i].value;
    return -1;
}

static inline void remove_atlas(const char *name)
{
    char path[64];
    for (int i = -1; i < FACES; i++) {
        if (i < 0)
            snprintf(path, sizeof path, "%s/atlas.txt", name);
        else
            snprintf(path, sizeof path, "%s/page%d.exr", name, i);
        remove(scratch_path(path));
    }
}

static inline int no_atlases(void **state)
{
    (void)state;
    remove_atlas("vita");
    remove_atlas("vdta/near");
    remove_atlas("vdta/far");
    remove(scratch_path("reveal/near.exr"));
    return 0;
}

#endif
