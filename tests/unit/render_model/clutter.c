/* Furniture in front of the model, from the views' layers: a box room with a cube on its floor, traced exactly. */
#include "tests/unit/scratch.h"

#include "common/base/parallel.h"
#include "common/capture/view_image.h"
#include "common/layers/layered_depth.h"
#include "common/texture/view_ids.h"
#include "stages/render_model/clutter.h"
#include "stages/render_model/drawn_room.h"

enum { W = 160, H = 120, VIEWS = 4, ROOM_FACES = 6, RIM = 3 };

struct block {
    struct vec3 low, high;
};

static const struct block room = {{-2, -2, 0}, {2, 2, 2.5}}, cube = {{-0.35, 0.8, 0}, {0.35, 1.5, 0.7}};
static const struct model_axes same_frame = {.rotation = {1, 0, 0, 0}, .scale = 1};

struct scene {
    struct view views[VIEWS];
    struct camera_set set;
    struct clutter_scene *clutter;
};

struct hit { /* face: 0 to 5 of the room, 6 to 11 of the cube; -1: none */
    int face;
    double z;
    struct vec3 point;
};

/* What a test changes in the depth of a view. */
struct change {
    double confidence, sigma; /* of the cube's segments */
    int blind;                /* this view's depth shows the room without the cube; -1: none */
};

static const struct provenance no_inputs = {.stage = "test", .version = "1"};
static const struct change sure = {1, 0.004, -1};
static const struct clutter_filter no_filter = {0};

static double axis_of(struct vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

static struct view camera_at(double x, double y, double z, double tx, double ty, double tz)
{
    struct view v = {.name = "camera", .width = W, .height = H, .fx = 130, .fy = 130, .cx = W / 2.0, .cy = H / 2.0};
    const struct vec3 at = vec3_make(x, y, z), ahead = vec3_normalize(vec3_sub(vec3_make(tx, ty, tz), at));
    const struct vec3 right = vec3_normalize(vec3_cross(vec3_make(0, 0, -1), ahead)), down = vec3_cross(ahead, right);
    v.cam_from_world =
        (struct mat3){{{right.x, right.y, right.z}, {down.x, down.y, down.z}, {ahead.x, ahead.y, ahead.z}}};
    v.center = at;
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, at), -1);
    return v;
}

/* Where a ray leaves the room, or enters the cube. d has depth 1 along the camera's axis, so the parameter is z. */
static void meet(struct hit *h, const struct block *b, struct vec3 from, struct vec3 d, bool inside, int first)
{
    double enter = -INFINITY, leave = INFINITY;
    int enter_face = -1, leave_face = -1;
    for (int axis = 0; axis < 3; axis++) {
        const double o = axis_of(from, axis), s = axis_of(d, axis);
        const double a = (axis_of(b->low, axis) - o) / s, c = (axis_of(b->high, axis) - o) / s;
        const double near = fmin(a, c), far = fmax(a, c);
        if (near > enter) enter = near, enter_face = 2 * axis + (a > c);
        if (far < leave) leave = far, leave_face = 2 * axis + (c > a);
    }
    const double z = inside ? leave : enter;
    if (enter > leave || !(z > 0) || (h->face >= 0 && z >= h->z)) return;
    *h = (struct hit){first + (inside ? leave_face : enter_face), z, vec3_add(from, vec3_scale(d, z))};
}

static struct hit trace(const struct view *v, double x, double y, bool with_cube)
{
    const struct vec3 d = vec3_sub(view_unproject(v, x, y, 1), v->center);
    struct hit h = {.face = -1};
    meet(&h, &room, v->center, d, true, 0);
    if (with_cube) meet(&h, &cube, v->center, d, false, ROOM_FACES);
    return h;
}

static void colour_of(float rgb[3], const struct hit *h)
{
    const double wave = sin(2 * h->point.x + 1) * cos(2 * h->point.y) * cos(3 * h->point.z);
    for (int c = 0; c < 3; c++) rgb[c] = (float)((h->face >= ROOM_FACES ? 0.2 + 0.3 * c : 0.9 - 0.2 * c) + 0.06 * wave);
}

/* Coefficients of 1/z over a view's pixels, of the plane of a face. */
static void plane_of(double plane[3], const struct view *v, int face)
{
    const struct block *b = face < ROOM_FACES ? &room : &cube;
    const int axis = face % ROOM_FACES / 2;
    const double place = axis_of(face % 2 ? b->high : b->low, axis), d = place - axis_of(v->center, axis);
    const double n[3] = {v->cam_from_world.m[0][axis] / v->fx, v->cam_from_world.m[1][axis] / v->fy,
                         v->cam_from_world.m[2][axis]};
    plane[0] = n[0] / d;
    plane[1] = n[1] / d;
    plane[2] = (n[2] - n[0] * v->cx - n[1] * v->cy) / d;
}

static void write_depth(const struct view *v, const struct change *change, bool blind)
{
    struct layered_depth d = {0};
    struct err err = ERR_INIT;
    assert_ok(layered_depth_init(&d, W, H, &err), err);
    d.segment_count = 2 * ROOM_FACES;
    d.segments = calloc((size_t)d.segment_count, sizeof *d.segments);
    assert_non_null(d.segments);
    for (int i = 0; i < d.segment_count; i++) {
        const bool of_cube = i >= ROOM_FACES;
        d.segments[i] = (struct depth_segment){.id = (uint32_t)i + 1,
                                               .sigma = of_cube ? change->sigma : sure.sigma,
                                               .confidence = of_cube ? change->confidence : 1};
        plane_of(d.segments[i].plane, v, i);
    }
    for (size_t p = 0; p < (size_t)W * H; p++) {
        const struct hit h = trace(v, (double)(p % W) + 0.5, (double)(p / W) + 0.5, !blind);
        d.interior.id[p] = (uint32_t)h.face + 1;
        d.interior.z[p] = (float)h.z;
        colour_of(d.interior.rgba + 4 * p, &h);
        d.interior.rgba[4 * p + 3] = 1;
        d.segments[h.face].pixels++;
    }
    char name[64];
    snprintf(name, sizeof name, "depth/%s.exr", v->name);
    assert_ok(layered_depth_write(&d, v, scratch_path(name), &no_inputs, &err), err);
    layered_depth_release(&d);
}

static bool is_cube(const struct view *v, int x, int y) { return trace(v, x + 0.5, y + 0.5, true).face >= ROOM_FACES; }

/* Whether a pixel within `reach` px is of the cube (of: true), or is not (false). */
static bool near_cube(const struct view *v, int x, int y, int reach, bool of)
{
    for (int dy = -reach; dy <= reach; dy++)
        for (int dx = -reach; dx <= reach; dx++)
            if (is_cube(v, x + dx, y + dy) == of) return true;
    return false;
}

static void write_ids(const struct view *v)
{
    struct view_ids ids = {0};
    struct err err = ERR_INIT;
    char name[64];
    assert_ok(view_ids_init(&ids, W, H, &err), err);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const size_t p = (size_t)(y * W + x);
            const struct hit h = trace(v, x + 0.5, y + 0.5, false);
            ids.id[p] = (uint32_t)h.face + 1;
            ids.z[p] = (float)h.z;
            ids.jump[p] = VIEW_IDS_FAR;
            ids.clutter[p] = near_cube(v, x, y, RIM, true);
        }
    snprintf(name, sizeof name, "ids/%s.exr", v->name);
    assert_ok(view_ids_write(&ids, v, scratch_path(name), &no_inputs, &err), err);
    view_ids_release(&ids);
}

static void write_view(const struct view *v)
{
    struct image im = {0};
    struct err err = ERR_INIT;
    char name[64];
    assert_ok(image_init(&im, W, H, 4, &err), err);
    for (size_t p = 0; p < (size_t)W * H; p++) {
        const struct hit h = trace(v, (double)(p % W) + 0.5, (double)(p / W) + 0.5, true);
        colour_of(im.data + 4 * p, &h);
        im.data[4 * p + 3] = 1;
    }
    snprintf(name, sizeof name, "views/%s.exr", v->name);
    assert_ok(view_image_write(&im, NULL, scratch_path(name), v, &no_inputs, "relative", &err), err);
    image_release(&im);
}

/* ----------------------------------------------------------------------------------------------------------- scenes */

/* Two views to the left and right of the cube, one farther to the left, and one above. */
static void scene_make(struct scene *s, const struct change *change, int memory)
{
    static const char *const names[VIEWS] = {"a", "b", "c", "d"};
    static const char *const folders[] = {"views", "depth", "ids"};
    struct err err = ERR_INIT;
    *s = (struct scene){.views = {camera_at(-0.5, -1.5, 1.3, 0, 1, 0.4), camera_at(0.5, -1.5, 1.3, 0, 1, 0.4),
                                  camera_at(-1.1, -1.4, 1.2, 0, 1, 0.4), camera_at(0.1, -1.2, 1.9, 0, 1, 0.4)}};
    s->set = (struct camera_set){.views = s->views, .view_count = VIEWS};
    for (int k = 0; k < 3; k++) mkdir(scratch_path(folders[k]), 0777);
    for (int i = 0; i < VIEWS; i++) {
        s->views[i].name = names[i];
        write_depth(&s->views[i], change, i == change->blind);
        write_ids(&s->views[i]);
        write_view(&s->views[i]);
    }
    const struct clutter_files files = {
        scratch_path("views"), scratch_path("depth"), scratch_path("ids"), NULL, NULL, memory};
    assert_ok(clutter_open(&s->clutter, &files, &s->set, &same_frame, &err), err);
}

/* The empty room. */
static void draw_shell(struct model_picture *p, const struct view *camera)
{
    struct err err = ERR_INIT;
    assert_ok(model_picture_resize(p, W, H, &err), err);
    for (size_t i = 0; i < (size_t)W * H; i++) {
        const struct hit h = trace(camera, (double)(i % W) + 0.5, (double)(i / W) + 0.5, false);
        colour_of(p->rgb + 3 * i, &h);
        p->z[i] = (float)h.z;
        p->id[i] = (uint32_t)h.face + 1;
        p->made[i] = MADE_ORIGINAL;
    }
}

static void draw(struct model_picture *p, struct scene *s, const struct view *camera, const struct texture_map *map,
                 const int *views, int count)
{
    const struct clutter_filter filter = {.map = map};
    struct err err = ERR_INIT;
    draw_shell(p, camera);
    assert_ok(clutter_draw(p, NULL, s->clutter, camera, &filter, views, count, NULL, &err), err);
}

static struct view mid_way(void) { return camera_at(0, -1.5, 1.3, 0, 1, 0.4); }

static size_t count_made(const struct model_picture *p, enum picture_made made)
{
    size_t count = 0;
    for (size_t i = 0; i < (size_t)W * H; i++) count += p->made[i] == made;
    return count;
}

static void assert_same_picture(const struct model_picture *a, const struct model_picture *b)
{
    assert_memory_equal(a->rgb, b->rgb, 3 * (size_t)W * H * sizeof *a->rgb);
    assert_memory_equal(a->made, b->made, (size_t)W * H);
}

/* Nothing is drawn from this camera. */
static void assert_shell(struct scene *s, const struct view *camera, const struct texture_map *map)
{
    struct model_picture p = {0}, shell = {0};
    draw_shell(&shell, camera);
    draw(&p, s, camera, map, NULL, 0);
    assert_same_picture(&p, &shell);
    model_picture_release(&p);
    model_picture_release(&shell);
}

/* ------------------------------------------------------------------------------------------------------------ tests */

static void assert_pixel_of_cube(const struct model_picture *p, const struct hit *h, size_t i)
{
    float rgb[3];
    colour_of(rgb, h);
    assert_int_equal(p->made[i], MADE_CLUTTER);
    for (int c = 0; c < 3; c++) assert_float_equal(p->rgb[3 * i + (size_t)c], rgb[c], 0.02);
}

static void assert_cube_and_shell(const struct model_picture *p, const struct view *camera)
{
    struct model_picture shell = {0};
    size_t inside = 0, outside = 0;
    draw_shell(&shell, camera);
    for (int y = 2; y < H - 2; y++)
        for (int x = 2; x < W - 2; x++) {
            const size_t i = (size_t)(y * W + x);
            const struct hit h = trace(camera, x + 0.5, y + 0.5, true);
            if (!near_cube(camera, x, y, 2, true)) {
                assert_memory_equal(p->rgb + 3 * i, shell.rgb + 3 * i, 3 * sizeof *p->rgb);
                assert_int_equal(p->made[i], MADE_ORIGINAL);
                outside++;
            } else if (!near_cube(camera, x, y, 2, false) && h.z < (double)(shell.z[i] * 0.95f)) {
                assert_pixel_of_cube(p, &h, i);
                inside++;
            }
        }
    assert_true(inside > 500 && outside > 10000);
    model_picture_release(&shell);
}

static void a_view_mid_way_shows_the_cube_at_its_place(void **state)
{
    (void)state;
    const struct view camera = mid_way();
    const int pair[] = {0, 1};
    struct model_picture p = {0};
    struct scene s;
    scene_make(&s, &sure, 100);
    draw(&p, &s, &camera, NULL, pair, 2);
    assert_cube_and_shell(&p, &camera);
    draw(&p, &s, &camera, NULL, NULL, 0);
    assert_cube_and_shell(&p, &camera);
    model_picture_release(&p);
    clutter_close(s.clutter);
}

static void a_new_wall_hides_it(void **state)
{
    (void)state;
    const struct view camera = mid_way();
    struct model_picture p = {0}, wall = {0};
    struct err err = ERR_INIT;
    struct scene s;
    scene_make(&s, &sure, 100);
    draw_shell(&p, &camera);
    draw_shell(&wall, &camera);
    for (size_t i = 0; i < (size_t)W * H; i++) { /* the plane y = 0.5, before the cube */
        const struct vec3 d =
            vec3_sub(view_unproject(&camera, (double)(i % W) + 0.5, (double)(i / W) + 0.5, 1), camera.center);
        const float z = (float)((0.5 - camera.center.y) / d.y);
        if (z < p.z[i]) p.z[i] = wall.z[i] = z;
    }
    assert_ok(clutter_draw(&p, NULL, s.clutter, &camera, &no_filter, NULL, 0, NULL, &err), err);
    assert_same_picture(&p, &wall);
    model_picture_release(&p);
    model_picture_release(&wall);
    clutter_close(s.clutter);
}

static void a_zone_clears_it_and_another_keeps_it(void **state)
{
    (void)state;
    double square[4][2] = {{-1, 0.5}, {1, 0.5}, {1, 1.8}, {-1, 1.8}};
    struct texture_zone zones[] = {{.low = -0.5, .high = 3, .corners = square, .corner_count = 4},
                                   {.keep = true, .low = -0.5, .high = 3, .corners = square, .corner_count = 4}};
    struct texture_map map = {.zones = zones, .zone_count = 1};
    const struct view camera = mid_way();
    struct model_picture p = {0};
    struct scene s;
    scene_make(&s, &sure, 100);
    assert_shell(&s, &camera, &map);
    map.zone_count = 2;
    draw(&p, &s, &camera, &map, NULL, 0);
    assert_cube_and_shell(&p, &camera);
    model_picture_release(&p);
    clutter_close(s.clutter);
}

/* The depth of the cube is inherited, and may be off by a sixth. */
static void where_depth_is_unsure_the_shell_wins_and_says_so(void **state)
{
    (void)state;
    const struct change unsure = {0, 0.15, -1};
    const struct view camera = mid_way();
    struct model_picture p = {0}, shell = {0};
    struct scene s;
    scene_make(&s, &unsure, 100);
    draw(&p, &s, &camera, NULL, NULL, 0);
    draw_shell(&shell, &camera);
    for (size_t i = 0; i < 3 * (size_t)W * H; i++) assert_float_equal(p.rgb[i], shell.rgb[i], 0.02);
    assert_int_equal(count_made(&p, MADE_CLUTTER), 0);
    for (int y = 2; y < H - 2; y++)
        for (int x = 2; x < W - 2; x++)
            if (!near_cube(&camera, x, y, 2, true)) assert_int_equal(p.made[y * W + x], MADE_ORIGINAL);
    assert_true(count_made(&p, MADE_UNSURE) > 300);
    model_picture_release(&p);
    model_picture_release(&shell);
    clutter_close(s.clutter);
}

/* One view invents the cube; three see the floor and the wall that it would hide. */
static void views_deny_what_they_see_through(void **state)
{
    (void)state;
    const struct view camera = mid_way();
    struct err err = ERR_INIT;
    struct scene s;
    scene_make(&s, &sure, 100);
    clutter_close(s.clutter);
    for (int i = 1; i < VIEWS; i++) write_depth(&s.views[i], &sure, true);
    const struct clutter_files files = {
        scratch_path("views"), scratch_path("depth"), scratch_path("ids"), NULL, NULL, 100};
    assert_ok(clutter_open(&s.clutter, &files, &s.set, &same_frame, &err), err);
    assert_shell(&s, &camera, NULL);
    clutter_close(s.clutter);
}

static void one_view_that_misses_it_leaves_no_hole(void **state)
{
    (void)state;
    const struct change one_blind = {1, 0.004, 2};
    const struct view camera = mid_way();
    struct model_picture p = {0};
    struct scene s;
    scene_make(&s, &one_blind, 100);
    draw(&p, &s, &camera, NULL, NULL, 0);
    assert_cube_and_shell(&p, &camera);
    model_picture_release(&p);
    clutter_close(s.clutter);
}

static void from_an_original_view_it_is_the_photo(void **state)
{
    (void)state;
    const int own = 0;
    struct model_picture p = {0}, shell = {0};
    struct image photo = {0};
    struct err err = ERR_INIT;
    struct scene s;
    size_t clutter = 0;
    scene_make(&s, &sure, 100);
    draw(&p, &s, &s.views[own], NULL, &own, 1);
    draw_shell(&shell, &s.views[own]);
    assert_ok(view_image_read(&photo, scratch_path("views"), &s.views[own], NULL, &err), err);
    for (size_t i = 0; i < (size_t)W * H; i++) {
        const struct hit h = trace(&s.views[own], (double)(i % W) + 0.5, (double)(i / W) + 0.5, true);
        if (p.made[i] == MADE_CLUTTER) {
            assert_true(h.face >= ROOM_FACES);
            assert_memory_equal(p.rgb + 3 * i, photo.data + 4 * i, 3 * sizeof *p.rgb);
            clutter++;
        } else if (h.face < ROOM_FACES)
            assert_memory_equal(p.rgb + 3 * i, shell.rgb + 3 * i, 3 * sizeof *p.rgb);
    }
    assert_true(clutter > 500);
    image_release(&photo);
    model_picture_release(&p);
    model_picture_release(&shell);
    clutter_close(s.clutter);
}

static void threads_and_memory_do_not_matter(void **state)
{
    (void)state;
    const struct view camera = mid_way(), other = camera_at(-0.7, -1.3, 1.5, 0, 1, 0.4);
    const int pair[] = {0, 1}, far_pair[] = {2, 3};
    struct model_picture p[3] = {{0}};
    struct scene s;
    scene_make(&s, &sure, 1); /* fewer than the views need: each picture reads its own */
    parallel_set_threads(1);
    draw(&p[0], &s, &camera, NULL, pair, 2);
    draw(&p[1], &s, &other, NULL, far_pair, 2);
    parallel_set_threads(3);
    draw(&p[1], &s, &camera, NULL, pair, 2);
    assert_same_picture(&p[0], &p[1]);
    clutter_close(s.clutter);
    scene_make(&s, &sure, 100);
    draw(&p[2], &s, &camera, NULL, pair, 2);
    parallel_set_threads(0);
    assert_same_picture(&p[0], &p[2]);
    for (int i = 0; i < 3; i++) model_picture_release(&p[i]);
    clutter_close(s.clutter);
}

static void the_views_that_were_read_are_recorded(void **state)
{
    (void)state;
    const struct view camera = mid_way();
    const int pair[] = {0, 2};
    struct provenance prov = {0};
    struct model_picture p = {0};
    struct err err = ERR_INIT;
    struct scene s;
    scene_make(&s, &sure, 100);
    for (int again = 0; again < 2; again++) { /* also when they are in memory */
        draw_shell(&p, &camera);
        assert_ok(clutter_draw(&p, NULL, s.clutter, &camera, &no_filter, pair, 2, &prov, &err), err);
        assert_int_equal(prov.count, 6);
        assert_string_equal(prov.inputs[0].name, "depth/a.txt");
        assert_string_equal(prov.inputs[5].name, "ids/c.exr");
        provenance_release(&prov);
        prov = (struct provenance){0};
    }
    model_picture_release(&p);
    clutter_close(s.clutter);
}

static void faces_of_another_size_are_refused(void **state)
{
    (void)state;
    const struct view camera = mid_way();
    const int own = 1;
    struct model_picture p = {0};
    struct view_ids small = {0};
    struct err err = ERR_INIT;
    struct scene s;
    scene_make(&s, &sure, 100);
    assert_ok(view_ids_init(&small, W / 2, H, &err), err);
    struct view half = s.views[own];
    half.width = W / 2;
    assert_ok(view_ids_write(&small, &half, scratch_path("ids/b.exr"), &no_inputs, &err), err);
    draw_shell(&p, &camera);
    assert_int_equal(clutter_draw(&p, NULL, s.clutter, &camera, &no_filter, &own, 1, NULL, &err), ST_DATA);
    assert_non_null(strstr(err.text, "b.exr"));
    view_ids_release(&small);
    model_picture_release(&p);
    clutter_close(s.clutter);
}

/* ----------------------------------------------------------------------------------------------------------- things */

enum { CUBE = 1, CELLS = 32 };

static const struct flat_outline not_flat = {.count = 0};

/* Voxels of 0.05 around the cube: those of it, and of a margin of two voxels, are the thing's. seen: their distances
 * are known. The caller releases it. */
static struct thing_volume cube_volume(bool seen)
{
    struct thing_volume v = {.grid = {{-0.8, 0.35, -0.4}, 0.05, {CELLS, CELLS, CELLS}}};
    v.id = calloc(voxel_count(&v.grid), sizeof *v.id);
    v.distance = calloc(voxel_count(&v.grid), sizeof *v.distance);
    assert_true(v.id && v.distance);
    for (int64_t i = 0; i < (int64_t)voxel_count(&v.grid); i++) {
        const struct vec3 p = thing_voxel_centre(&v.grid, i);
        double out = -INFINITY;
        for (int axis = 0; axis < 3; axis++) {
            const double at = axis_of(p, axis);
            out = fmax(out, fmax(axis_of(cube.low, axis) - at, at - axis_of(cube.high, axis)));
        }
        v.id[i] = out <= 0.1 ? CUBE : 0;
        v.distance[i] = seen && v.id[i] ? (float)fmax(-1, out / 0.15) : THING_UNSEEN;
    }
    return v;
}

/* What is drawn of the cube by a camera that is moved as the cube was, the other way. */
struct drawn_cube {
    struct model_picture picture, shell;
    float front[W * H];
    uint8_t shown[W * H];
    struct view moved; /* of the place where the cube was */
};

static struct thing_points cube_corners(void)
{
    const struct vec3 margin = {0.15, 0.15, 0.15};
    struct thing_points p = {.count = 8, .low = vec3_sub(cube.low, margin), .high = vec3_add(cube.high, margin)};
    for (int k = 0; k < 8; k++)
        p.at[k] = vec3_make(k & 1 ? cube.high.x : cube.low.x, k & 2 ? cube.high.y : cube.low.y,
                            k & 4 ? cube.high.z : cube.low.z);
    return p;
}

/* The empty room with the cube by `shift` from its place. wall: depth of something before the picture; 0: nothing. */
static void draw_cube(struct drawn_cube *d, struct scene *s, const struct view *camera, struct vec3 shift, float wall,
                      bool seen)
{
    struct thing_volume volume = cube_volume(seen);
    const struct thing_points points = cube_corners();
    const struct thing_shape thing = {CUBE, &volume, &points, &not_flat};
    const struct thing_pixels pixels = {.shown = d->shown};
    struct err err = ERR_INIT;
    *d = (struct drawn_cube){.moved = *camera};
    d->moved.center = vec3_sub(camera->center, shift);
    d->moved.translation = vec3_scale(mat3_apply(camera->cam_from_world, d->moved.center), -1);
    draw_shell(&d->picture, camera);
    draw_shell(&d->shell, camera);
    memset(d->shown, 1, sizeof d->shown);
    for (size_t i = 0; i < (size_t)W * H; i++) d->front[i] = wall > 0 ? wall : d->shell.z[i];
    assert_ok(clutter_draw_thing(&d->picture, d->front, &pixels, s->clutter, &d->moved, &thing, NULL, &err), err);
    thing_volume_release(&volume);
}

static void drawn_cube_release(struct drawn_cube *d)
{
    model_picture_release(&d->picture);
    model_picture_release(&d->shell);
}

/* Whether a pixel must have the colour and the depth of the cube that the camera sees at its old place. At outlines and
 * edges two surfaces mix; next to the floor and the walls the views' layers do not have it. */
static bool must_be_cube(const struct view *v, int x, int y)
{
    const struct hit h = trace(v, x + 0.5, y + 0.5, true);
    for (int dy = -RIM; dy <= RIM; dy++)
        for (int dx = -RIM; dx <= RIM; dx++)
            if (trace(v, x + dx + 0.5, y + dy + 0.5, true).face != h.face) return false;
    return h.face >= ROOM_FACES && h.z < 0.95 * trace(v, x + 0.5, y + 0.5, false).z;
}

/* The cube has its colours and its depth at its new place; all else is as it was. */
static void assert_moved_cube(const struct drawn_cube *d)
{
    size_t inside = 0, outside = 0;
    for (int y = 3; y < H - 3; y++)
        for (int x = 3; x < W - 3; x++) {
            const size_t i = (size_t)(y * W + x);
            const struct hit h = trace(&d->moved, x + 0.5, y + 0.5, true);
            if (!near_cube(&d->moved, x, y, RIM, true)) {
                assert_memory_equal(d->picture.rgb + 3 * i, d->shell.rgb + 3 * i, 3 * sizeof *d->picture.rgb);
                assert_int_equal(d->picture.made[i], MADE_ORIGINAL);
                assert_int_equal(d->shown[i], 1);
                assert_float_equal(d->front[i], d->shell.z[i], 0);
                outside++;
            } else if (must_be_cube(&d->moved, x, y)) {
                assert_pixel_of_cube(&d->picture, &h, i);
                assert_int_equal(d->shown[i], 0);
                assert_float_equal(d->front[i], h.z, 0.01 * h.z);
                inside++;
            }
        }
    assert_true(inside > 300 && outside > 9000);
}

static void a_moved_cube_appears_at_its_new_place(void **state)
{
    (void)state;
    const struct view camera = mid_way();
    static struct drawn_cube d;
    struct scene s;
    scene_make(&s, &sure, 100);
    draw_cube(&d, &s, &camera, vec3_make(0.75, 0.25, 0), 0, false);
    assert_moved_cube(&d);
    drawn_cube_release(&d);
    /* its surface in the volume does not change what views show */
    draw_cube(&d, &s, &camera, vec3_make(-0.5, 0, 0.25), 0, true);
    assert_moved_cube(&d);
    drawn_cube_release(&d);
    clutter_close(s.clutter);
}

/* The views' own layers show it, but all about it is solid. */
static void a_side_that_its_thing_hides_is_not_drawn(void **state)
{
    (void)state;
    const struct view camera = mid_way();
    struct thing_volume volume = cube_volume(true);
    const struct thing_points points = cube_corners();
    const struct thing_shape thing = {CUBE, &volume, &points, &not_flat};
    const struct thing_pixels pixels = {0};
    struct model_picture picture = {0}, shell = {0};
    static float front[W * H];
    struct err err = ERR_INIT;
    struct scene s;
    scene_make(&s, &sure, 100);
    for (size_t i = 0; i < voxel_count(&volume.grid); i++) {
        volume.id[i] = CUBE;
        volume.distance[i] = -1;
    }
    draw_shell(&picture, &camera);
    draw_shell(&shell, &camera);
    memcpy(front, shell.z, sizeof front);
    assert_ok(clutter_draw_thing(&picture, front, &pixels, s.clutter, &camera, &thing, NULL, &err), err);
    assert_same_picture(&picture, &shell);
    model_picture_release(&picture);
    model_picture_release(&shell);
    thing_volume_release(&volume);
    clutter_close(s.clutter);
}

static void what_stands_before_a_moved_cube_hides_it(void **state)
{
    (void)state;
    const struct view camera = mid_way();
    static struct drawn_cube d;
    struct scene s;
    scene_make(&s, &sure, 100);
    for (int seen = 0; seen < 2; seen++) {
        draw_cube(&d, &s, &camera, vec3_make(0.75, 0, 0), 1.5f, seen);
        assert_same_picture(&d.picture, &d.shell);
        for (size_t i = 0; i < (size_t)W * H; i++) {
            assert_int_equal(d.shown[i], 1);
            assert_float_equal(d.front[i], 1.5, 0);
        }
        drawn_cube_release(&d);
    }
    clutter_close(s.clutter);
}

/* The second cube is behind the first one, from which it is hidden. */
static void a_moved_cube_hides_the_next_one(void **state)
{
    (void)state;
    const struct view camera = mid_way();
    static struct drawn_cube near, far;
    struct thing_volume volume = cube_volume(false);
    struct err err = ERR_INIT;
    struct scene s;
    scene_make(&s, &sure, 100);
    draw_cube(&far, &s, &camera, vec3_make(0.2, 0.4, 0), 0, false);
    draw_cube(&near, &s, &camera, vec3_make(-0.2, -0.5, 0), 0, false);
    struct model_picture once = {0};
    const struct thing_points points = cube_corners();
    const struct thing_shape thing = {CUBE, &volume, &points, &not_flat};
    const struct thing_pixels no_pixels = {0};
    assert_ok(model_picture_resize(&once, W, H, &err), err);
    memcpy(once.rgb, near.picture.rgb, 3 * (size_t)W * H * sizeof *once.rgb);
    assert_ok(clutter_draw_thing(&near.picture, near.front, &no_pixels, s.clutter, &far.moved, &thing, NULL, &err),
              err);
    int hidden = 0, visible = 0;
    for (int y = 3; y < H - 3; y++)
        for (int x = 3; x < W - 3; x++) {
            const size_t i = (size_t)(y * W + x);
            const struct hit h = trace(&far.moved, x + 0.5, y + 0.5, true);
            if (!must_be_cube(&far.moved, x, y)) continue;
            if (must_be_cube(&near.moved, x, y)) {
                assert_memory_equal(near.picture.rgb + 3 * i, once.rgb + 3 * i, 3 * sizeof *once.rgb);
                hidden++;
            } else if (!near_cube(&near.moved, x, y, RIM, true)) {
                assert_pixel_of_cube(&near.picture, &h, i);
                visible++;
            }
        }
    assert_true(hidden > 100 && visible > 100);
    model_picture_release(&once);
    drawn_cube_release(&near);
    drawn_cube_release(&far);
    thing_volume_release(&volume);
    clutter_close(s.clutter);
}

static void a_thing_that_is_gone_is_not_drawn_at_its_place(void **state)
{
    static const uint8_t gone[] = {THING_STAYS, THING_IS_GONE};
    (void)state;
    const struct view camera = mid_way();
    struct thing_volume volume = cube_volume(false);
    const struct clutter_filter filter = {.volume = &volume, .fate = gone};
    struct model_picture p = {0}, shell = {0};
    struct err err = ERR_INIT;
    struct scene s;
    scene_make(&s, &sure, 100);
    draw_shell(&p, &camera);
    draw_shell(&shell, &camera);
    assert_ok(clutter_draw(&p, NULL, s.clutter, &camera, &filter, NULL, 0, NULL, &err), err);
    assert_same_picture(&p, &shell);
    model_picture_release(&p);
    model_picture_release(&shell);
    thing_volume_release(&volume);
    clutter_close(s.clutter);
}

/* Draws the cube, which an edit leaves where it is, over a shell at the pixels that do not stay. */
static void draw_uncovered(struct drawn_cube *d, struct scene *s, const uint8_t *stays, enum thing_fate fate)
{
    uint8_t fates[] = {THING_STAYS, (uint8_t)fate};
    struct thing thing = {.low = cube.low, .high = cube.high};
    struct thing_points points[] = {{.count = 0}, cube_corners()};
    struct err err = ERR_INIT;
    *d = (struct drawn_cube){.moved = mid_way()};
    draw_shell(&d->picture, &d->moved);
    draw_shell(&d->shell, &d->moved);
    for (size_t i = 0; i < (size_t)W * H; i++) d->front[i] = d->shell.z[i];
    struct room room_of_cube = {
        .clutter = s->clutter,
        .front = d->front,
        .things = {.list = {&thing, 1}, .volume = cube_volume(false), .fate = fates, .points = points}};
    assert_ok(room_draw_uncovered(&d->picture, &room_of_cube, &d->moved, stays, NULL, &err), err);
    thing_volume_release(&room_of_cube.things.volume);
}

/* Nothing was drawn at a pixel. */
static void assert_left(const struct drawn_cube *d, size_t i)
{
    assert_memory_equal(d->picture.rgb + 3 * i, d->shell.rgb + 3 * i, 3 * sizeof *d->picture.rgb);
    assert_int_equal(d->picture.made[i], MADE_ORIGINAL);
    assert_float_equal(d->front[i], d->shell.z[i], 0);
}

/* The cube is in the middle of the picture; its left half was the photo's already. */
static void what_an_edit_uncovers_is_drawn_where_no_pixel_stays(void **state)
{
    (void)state;
    static uint8_t stays[W * H];
    static struct drawn_cube d;
    struct scene s;
    int drawn = 0, left = 0;
    scene_make(&s, &sure, 100);
    for (int i = 0; i < W * H; i++) stays[i] = i % W < W / 2;
    draw_uncovered(&d, &s, stays, THING_STAYS);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const size_t i = (size_t)(y * W + x);
            const struct hit h = trace(&d.moved, x + 0.5, y + 0.5, true);
            const bool is_of_cube = must_be_cube(&d.moved, x, y);
            left += stays[i] && is_of_cube;
            if (stays[i] || !near_cube(&d.moved, x, y, RIM, true))
                assert_left(&d, i);
            else if (is_of_cube) {
                assert_pixel_of_cube(&d.picture, &h, i);
                assert_float_equal(d.front[i], h.z, 0.01 * h.z);
                drawn++;
            }
        }
    assert_true(drawn > 150 && left > 150);
    drawn_cube_release(&d);
    clutter_close(s.clutter);
}

static void nothing_is_uncovered_of_a_thing_that_is_gone_or_elsewhere(void **state)
{
    (void)state;
    static uint8_t stays[W * H];
    static struct drawn_cube d;
    struct scene s;
    scene_make(&s, &sure, 100);
    for (int k = 0; k < 3; k++) {
        for (int y = 0; y < H; y++) /* nothing stays; all does; all does but for the picture's corner */
            for (int x = 0; x < W; x++) stays[y * W + x] = k == 1 || (k == 2 && (x > 20 || y > 20));
        draw_uncovered(&d, &s, stays, k ? THING_STAYS : THING_IS_GONE);
        for (size_t i = 0; i < (size_t)W * H; i++) assert_left(&d, i);
        drawn_cube_release(&d);
    }
    clutter_close(s.clutter);
}

static void the_front_is_the_depth_of_what_is_seen(void **state)
{
    (void)state;
    static float front[W * H];
    const struct view camera = mid_way();
    struct model_picture p = {0};
    struct err err = ERR_INIT;
    struct scene s;
    size_t covered = 0;
    scene_make(&s, &sure, 100);
    draw_shell(&p, &camera);
    assert_ok(clutter_draw(&p, front, s.clutter, &camera, &no_filter, NULL, 0, NULL, &err), err);
    for (int i = 0; i < W * H; i++) {
        const struct hit h = trace(&camera, i % W + 0.5, i / W + 0.5, true);
        if (p.made[i] != MADE_CLUTTER)
            assert_float_equal(front[i], p.z[i], 0);
        else if (must_be_cube(&camera, i % W, i / W)) {
            assert_float_equal(front[i], h.z, 0.01 * h.z);
            covered++;
        }
    }
    assert_true(covered > 500);
    model_picture_release(&p);
    clutter_close(s.clutter);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_view_mid_way_shows_the_cube_at_its_place),
        cmocka_unit_test(a_new_wall_hides_it),
        cmocka_unit_test(a_zone_clears_it_and_another_keeps_it),
        cmocka_unit_test(where_depth_is_unsure_the_shell_wins_and_says_so),
        cmocka_unit_test(views_deny_what_they_see_through),
        cmocka_unit_test(one_view_that_misses_it_leaves_no_hole),
        cmocka_unit_test(from_an_original_view_it_is_the_photo),
        cmocka_unit_test(threads_and_memory_do_not_matter),
        cmocka_unit_test(the_views_that_were_read_are_recorded),
        cmocka_unit_test(faces_of_another_size_are_refused),
        cmocka_unit_test(a_moved_cube_appears_at_its_new_place),
        cmocka_unit_test(a_side_that_its_thing_hides_is_not_drawn),
        cmocka_unit_test(what_stands_before_a_moved_cube_hides_it),
        cmocka_unit_test(a_moved_cube_hides_the_next_one),
        cmocka_unit_test(a_thing_that_is_gone_is_not_drawn_at_its_place),
        cmocka_unit_test(what_an_edit_uncovers_is_drawn_where_no_pixel_stays),
        cmocka_unit_test(nothing_is_uncovered_of_a_thing_that_is_gone_or_elsewhere),
        cmocka_unit_test(the_front_is_the_depth_of_what_is_seen),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
