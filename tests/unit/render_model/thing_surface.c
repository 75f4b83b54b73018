/* thing_surface.c - the surface of a thing in a volume of signed distances: where rays meet it, what hides it, and the
 * colours that views give it. */
#include "stages/render_model/thing_surface.h"

#include "common/base/parallel.h"
#include "stages/render_model/thing_hull.h"
#include "tests/unit/box_solids.h"

enum { SIZE = 40, W = 80, H = 60, SOURCES = 3, THING = 2 };

#define VOXEL 0.05
#define BAND  (3 * VOXEL)

/* The model is turned, moved, and twice as large as the scene; its grid is 2 x 2 x 2 about (1, 2, 3). */
static const struct model_axes axes = {
    .rotation = {0.96, 0, 0, 0.28}, .translation = {0.5, 1, 0.25}, .scale = 2, .metric = true};
static const struct vec3 middle = {1, 2, 3};

struct scene {
    struct clutter_scene clutter;
    struct clutter_choice choice;
    struct clutter_source sources[SOURCES];
    struct view views[SOURCES], camera; /* scene frame */
    struct camera_set set;
    struct thing_volume volume;
    struct flat_outline outline;
    float shell[W * H];
    struct clutter_layer layer;
};

typedef double distance_fn(struct vec3 p); /* from the middle, model frame */

static double to_ball(struct vec3 p) { return vec3_length(p) - 0.5; }

static double to_block(struct vec3 p) { return fmax(fabs(p.x) - 0.412, fmax(fabs(p.y) - 0.333, fabs(p.z) - 0.287)); }

/* The surface with its band before and behind it, and what is deeper, is of the thing; all else is unseen. */
static void fill(struct thing_volume *v, distance_fn *distance)
{
    const double half = 0.5 * SIZE * VOXEL;
    v->grid = (struct voxel_grid){{middle.x - half, middle.y - half, middle.z - half}, VOXEL, {SIZE, SIZE, SIZE}};
    v->id = calloc(voxel_count(&v->grid), sizeof *v->id);
    v->distance = calloc(voxel_count(&v->grid), sizeof *v->distance);
    assert_true(v->id && v->distance);
    for (int64_t i = 0; i < (int64_t)voxel_count(&v->grid); i++) {
        const double d = distance(vec3_sub(thing_voxel_centre(&v->grid, i), middle)) / BAND;
        v->id[i] = d <= 1 ? THING : 0;
        v->distance[i] = d <= 1 ? (float)fmax(d, -1) : THING_UNSEEN;
    }
}

/* A camera of the scene's frame at a point of the model's, that looks at the middle of the grid. */
static struct view looking_from(double x, double y, double z)
{
    struct view v = {.name = "v", .width = W, .height = H, .fx = 70, .fy = 70, .cx = W / 2.0, .cy = H / 2.0};
    v.center = world_from_model_point(&axes, vec3_make(x, y, z));
    const struct vec3 ahead = vec3_normalize(vec3_sub(world_from_model_point(&axes, middle), v.center)),
                      right = vec3_normalize(vec3_cross(vec3_make(0, 0, -1), ahead)), down = vec3_cross(ahead, right);
    v.cam_from_world =
        (struct mat3){{{right.x, right.y, right.z}, {down.x, down.y, down.z}, {ahead.x, ahead.y, ahead.z}}};
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
    return v;
}

/* A view with one colour everywhere, all of it clutter at one depth. depth: scene units; 0: no clutter. */
static void make_source(struct scene *s, int at, float red, float green, double depth)
{
    struct layered_depth d = {0};
    struct view_ids ids = {0};
    struct err err = ERR_INIT;
    assert_ok(layered_depth_init(&d, W, H, &err), err);
    assert_ok(view_ids_init(&ids, W, H, &err), err);
    d.segments = calloc(1, sizeof *d.segments);
    assert_non_null(d.segments);
    d.segment_count = 1;
    d.segments[0] = (struct depth_segment){
        .id = 1, .plane = {0, 0, 1 / (depth > 0 ? depth : 9)}, .sigma = 0.002, .confidence = 1, .pixels = W * H};
    for (int i = 0; i < W * H; i++) {
        d.interior.id[i] = 1;
        d.interior.z[i] = (float)(depth > 0 ? depth : 9);
        d.interior.rgba[4 * i] = red;
        d.interior.rgba[4 * i + 1] = green;
        d.interior.rgba[4 * i + 2] = 0.25f;
        d.interior.rgba[4 * i + 3] = 1;
        ids.id[i] = 1;
        ids.z[i] = 9;
        ids.clutter[i] = depth > 0;
    }
    assert_ok(clutter_view_make(&s->sources[at].view, &d, &ids, NULL, "v", &err), err);
    s->sources[at].loaded = true;
    view_ids_release(&ids);
}

/* One source, at the camera, sees all of the thing. */
static void scene_make(struct scene *s, distance_fn *distance)
{
    struct err err = ERR_INIT;
    *s = (struct scene){.camera = looking_from(3.5, 3, 3.75)};
    fill(&s->volume, distance);
    for (int k = 0; k < SOURCES; k++) s->views[k] = s->camera;
    s->set = (struct camera_set){.views = s->views, .view_count = SOURCES};
    s->clutter = (struct clutter_scene){.set = &s->set, .axes = axes, .sources = s->sources};
    s->choice = (struct clutter_choice){.view = {0}, .fade = {1}, .count = 1};
    make_source(s, 0, 0.75f, 0.5f, 1.4);
    assert_ok(clutter_layer_init(&s->layer, W, H, &err), err);
}

static void scene_release(struct scene *s)
{
    for (int k = 0; k < SOURCES; k++) clutter_view_release(&s->sources[k].view);
    thing_volume_release(&s->volume);
    flat_outline_release(&s->outline);
    clutter_layer_release(&s->layer);
}

/* The box of the whole grid. */
static struct thing_points points_of(const struct thing_volume *v)
{
    const double side = SIZE * VOXEL;
    return (struct thing_points){.low = v->grid.origin, .high = vec3_add(v->grid.origin, vec3_make(side, side, side))};
}

static void draw(struct scene *s)
{
    const size_t pixels = (size_t)W * H;
    memset(s->layer.rgba, 0, 4 * pixels * sizeof *s->layer.rgba);
    memset(s->layer.z, 0, pixels * sizeof *s->layer.z);
    const struct thing_points points = points_of(&s->volume);
    struct thing_rows rows;
    const struct thing_shape thing = {THING, &s->volume, &points, &s->outline};
    struct err err = ERR_INIT;
    assert_ok(thing_surface_draw(&rows, &s->layer, s->shell, &s->clutter, &s->choice, &s->camera, &thing, &err), err);
    for (int i = 0; i < W * H; i++)
        assert_true(!(s->layer.rgba[4 * i + 3] > 0) || ((size_t)(i / W) >= rows.first && (size_t)(i / W) < rows.last));
}

static bool is_drawn(const struct scene *s, int i) { return s->layer.rgba[4 * i + 3] > 0; }

static int count_drawn(const struct scene *s)
{
    int count = 0;
    for (int i = 0; i < W * H; i++) count += is_drawn(s, i);
    return count;
}

/* The point of the pixel's ray at a depth (scene units), from the middle of the grid, model frame. */
static struct vec3 ray_point(const struct scene *s, int i, double z)
{
    const struct vec3 p = view_unproject(&s->camera, i % W + 0.5, i / W + 0.5, z);
    return vec3_sub(model_from_world_point(&axes, p), middle);
}

/* ----------------------------------------------------------------------------------------------------------- places */

/* The depth at which a pixel's ray enters the ball, scene units; 0: it passes. *slant: the cosine of its angle there.
 * */
static double ball_depth(const struct scene *s, int i, double *slant)
{
    const struct vec3 from = ray_point(s, i, 0), way = vec3_sub(ray_point(s, i, 1), from);
    const double a = vec3_dot(way, way), b = vec3_dot(from, way), c = vec3_dot(from, from) - 0.25, root = b * b - a * c;
    *slant = root > 0 ? sqrt(root / a) / 0.5 : 0;
    return root > 0 ? (-b - sqrt(root)) / a : 0;
}

static void a_ball_is_met_at_its_front(void **state)
{
    static struct scene s;
    int inside = 0, outside = 0;
    (void)state;
    scene_make(&s, to_ball);
    draw(&s);
    for (int i = 0; i < W * H; i++) {
        double slant;
        const double z = ball_depth(&s, i, &slant);
        if (slant > 0.5) {
            assert_true(is_drawn(&s, i));
            const struct vec3 off = vec3_sub(ray_point(&s, i, (double)s.layer.z[i]), ray_point(&s, i, z));
            assert_true(vec3_length(off) < 0.1 * VOXEL);
            inside++;
        } else if (!(z > 0)) {
            const struct vec3 from = ray_point(&s, i, 0), way = vec3_normalize(vec3_sub(ray_point(&s, i, 1), from));
            if (vec3_length(vec3_cross(from, way)) < 0.5 + 0.5 * VOXEL) continue; /* the outline */
            assert_false(is_drawn(&s, i));
            outside++;
        }
    }
    assert_true(inside > 300 && outside > 1000);
    scene_release(&s);
}

static void the_faces_of_a_block_are_met_exactly(void **state)
{
    static struct scene s;
    static const double half[3] = {0.412, 0.333, 0.287};
    int met[3] = {0};
    (void)state;
    scene_make(&s, to_block);
    draw(&s);
    for (int i = 0; i < W * H; i++) {
        if (!is_drawn(&s, i)) continue;
        const struct vec3 p = ray_point(&s, i, (double)s.layer.z[i]);
        assert_true(fabs(to_block(p)) < 0.75 * VOXEL); /* edges are rounded */
        const double off[3] = {p.x - half[0], p.y - half[1], p.z - half[2]};
        const int face = off[0] > off[1] ? off[0] > off[2] ? 0 : 2 : off[1] > off[2] ? 1 : 2;
        bool at_edge = false;
        for (int k = 0; k < 3; k++) at_edge |= k != face && fabs(off[k] + half[k]) > half[k] - 3.25 * VOXEL;
        if (at_edge) continue;
        assert_float_equal(off[face], 0, 0.01 * VOXEL);
        met[face]++;
    }
    for (int k = 0; k < 3; k++) assert_true(met[k] > 10);
    scene_release(&s);
}

static void what_a_view_shows_of_another_thing_is_no_colour(void **state)
{
    static struct scene s;
    (void)state;
    scene_make(&s, to_ball);
    for (int k = 0; k < 3; k++) {
        static const uint16_t shown[] = {0, THING, THING + 1};
        for (int i = 0; i < W * H; i++) s.sources[0].view.sight[i].thing = shown[k];
        draw(&s);
        assert_int_equal(count_drawn(&s) > 300, k < 2);
        assert_int_equal(count_drawn(&s) == 0, k == 2);
    }
    for (int k = 0; k < 2; k++) { /* something near that is no known thing */
        for (int i = 0; i < W * H; i++) s.sources[0].view.sight[i] = (struct clutter_sight){.nearest = 5};
        s.sources[0].view.knows_things = k;
        draw(&s);
        assert_int_equal(count_drawn(&s) > 300, !k);
        assert_int_equal(count_drawn(&s) == 0, k);
    }
    scene_release(&s);
}

/* A view that shows the thing where it is, with true depth, and a wall behind it; the upper half of the picture is red,
 * the lower half green. */
static void see_ball(struct scene *s, int at)
{
    struct clutter_view *v = &s->sources[at].view;
    const struct view camera = s->camera;
    clutter_view_release(v);
    make_source(s, at, 1, 0, 1.4);
    s->camera = s->views[at];
    for (int i = 0; i < W * H; i++) {
        double slant;
        const double z = ball_depth(s, i, &slant);
        v->sight[i] = (struct clutter_sight){.nearest = (float)(z > 0 ? 1 / z : 0.2),
                                             .thing = z > 0 ? THING : 0,
                                             .sure = CLUTTER_SURE,
                                             .shows = z > 0 ? CLUTTER_SURE : 0};
        uint16_t *c = v->layers.photo[(size_t)(i / W + 1) * (size_t)v->layers.stride + (size_t)(i % W) + 1];
        if (i / W >= H / 2) c[0] = 0, c[1] = 0x3c00; /* 1 as half */
    }
    v->knows_things = true;
    s->camera = camera;
}

/* The ball, which one view sees from +x. */
static void make_ball_seen_from_x(struct scene *s)
{
    scene_make(s, to_ball);
    s->camera = s->views[0] = looking_from(3.5, 2, 3);
    see_ball(s, 0);
}

/* From behind nobody saw the ball: it is drawn in the colours of the front at the same height. */
static void a_side_that_no_view_sees_has_the_colours_at_its_height(void **state)
{
    static struct scene s;
    int upper = 0, lower = 0;
    (void)state;
    make_ball_seen_from_x(&s);
    s.camera = looking_from(-1.5, 2, 3);
    draw(&s);
    for (int i = 0; i < W * H; i++) {
        double slant;
        const double z = ball_depth(&s, i, &slant), height = z > 0 ? ray_point(&s, i, z).z : 0;
        const float *c = &s.layer.rgba[4 * i];
        if (slant < 0.6) continue;
        assert_true(is_drawn(&s, i));
        if (height > 3 * VOXEL) assert_true(c[0] > 0.95f && c[1] < 0.05f), upper++;
        if (height < -3 * VOXEL) assert_true(c[0] < 0.05f && c[1] > 0.95f), lower++;
    }
    assert_true(upper > 50 && lower > 50);
    scene_release(&s);
}

/* Whether the hull holds a place, from the middle of the grid. */
static bool hull_holds(const struct thing_hull *h, double x, double y, double z)
{
    return thing_hull_at(h, vec3_add(middle, vec3_make(x, y, z)));
}

static void hull_of(struct thing_hull *h, const struct scene *s)
{
    struct err err = ERR_INIT;
    const struct thing_points points = points_of(&s->volume);
    const struct thing_shape thing = {THING, &s->volume, &points, &s->outline};
    assert_ok(thing_hull_find(h, &s->clutter, &s->choice, &thing, &err), err);
}

/* What is before the back of the ball was not looked into. */
static void forget_back(struct scene *s)
{
    for (int64_t i = 0; i < (int64_t)voxel_count(&s->volume.grid); i++)
        if (thing_voxel_centre(&s->volume.grid, i).x < middle.x && s->volume.distance[i] > 0)
            s->volume.id[i] = 0, s->volume.distance[i] = THING_UNSEEN;
}

/* One view alone sees the ball, from +x: all that is in its shadow may be filled, until something says otherwise. */
static void the_hull_is_what_a_thing_hides(void **state)
{
    static struct scene s;
    struct thing_hull h;
    (void)state;
    make_ball_seen_from_x(&s);
    for (size_t i = 0; i < voxel_count(&s.volume.grid); i++)
        if (!s.volume.id[i]) s.volume.distance[i] = THING_UNSEEN;
    hull_of(&h, &s);
    assert_true(hull_holds(&h, 0, 0, 0) && hull_holds(&h, 0.4, 0, 0) && hull_holds(&h, -0.9, 0, 0));
    assert_true(hull_holds(&h, -0.8, 0.55, 0));   /* in the cone of the shadow */
    assert_false(hull_holds(&h, 0, 0.6, 0));      /* beside the ball */
    assert_false(hull_holds(&h, 0.6, 0, 0));      /* before it */
    assert_false(hull_holds(&h, -0.8, 0.9, 0.2)); /* beside the shadow */
    thing_hull_release(&h);
    /* another view sees the other side */
    s.views[1] = looking_from(1, 4.5, 3);
    see_ball(&s, 1);
    s.choice = (struct clutter_choice){.view = {0, 1}, .fade = {1, 1}, .count = 2};
    hull_of(&h, &s);
    assert_true(hull_holds(&h, 0, 0, 0));
    assert_false(hull_holds(&h, -0.9, 0, 0) || hull_holds(&h, 0, -0.9, 0));
    thing_hull_release(&h);
    scene_release(&s);
}

/* Places that the depth of any view calls free, and those of other things, are not filled. */
static void the_hull_leaves_out_what_is_free_or_of_another_thing(void **state)
{
    static struct scene s;
    struct thing_hull h;
    (void)state;
    make_ball_seen_from_x(&s);
    forget_back(&s);
    for (int64_t i = 0; i < (int64_t)voxel_count(&s.volume.grid); i++) {
        const struct vec3 p = vec3_sub(thing_voxel_centre(&s.volume.grid, i), middle);
        if (p.x < -0.7 && p.z > 0) s.volume.id[i] = 0, s.volume.distance[i] = 1;
        if (p.x < -0.7 && p.z < 0) s.volume.id[i] = THING + 1;
    }
    hull_of(&h, &s);
    assert_true(hull_holds(&h, -0.6, 0, 0.1) && hull_holds(&h, -0.6, 0, -0.1));
    assert_false(hull_holds(&h, -0.8, 0, 0.1) || hull_holds(&h, -0.8, 0, -0.1));
    thing_hull_release(&h);
    scene_release(&s);
}

/* A wall stands in the shadow: the hull ends there. */
static void the_hull_ends_at_walls(void **state)
{
    static struct scene s;
    struct thing_hull h;
    struct err err = ERR_INIT;
    const struct box boxes[] = {{"walls", "out", {-3, -3, -3}, {9, 9, 9}, false},
                                {"walls", "in", {-2.8, -2.8, -2.8}, {8.8, 8.8, 8.8}, true},
                                {"wall/a", "a", {0.3, -2, -2}, {0.4, 8, 8}, false}};
    struct model_rays walls = {.mesh = make_boxes(boxes, 3)};
    (void)state;
    assert_ok(model_rays_build(&walls, MODEL_WITH_GLASS, &err), err);
    scene_make(&s, to_ball);
    s.clutter.walls = &walls;
    s.camera = s.views[0] = looking_from(3.5, 2, 3);
    see_ball(&s, 0);
    forget_back(&s);
    hull_of(&h, &s);
    assert_true(hull_holds(&h, -0.55, 0, 0));
    assert_false(hull_holds(&h, -0.65, 0, 0) || hull_holds(&h, -0.8, 0, 0));
    thing_hull_release(&h);
    model_rays_release(&walls);
    scene_release(&s);
}

/* A bookcase of which views saw the front alone: its side is where the hull ends. */
static void a_ray_meets_the_hull_where_no_surface_is(void **state)
{
    static struct scene s;
    int drawn = 0;
    (void)state;
    make_ball_seen_from_x(&s);
    for (int64_t i = 0; i < (int64_t)voxel_count(&s.volume.grid); i++)
        if (thing_voxel_centre(&s.volume.grid, i).x < middle.x + 0.2)
            s.volume.id[i] = 0, s.volume.distance[i] = THING_UNSEEN;
    s.camera = looking_from(1, 4.5, 3);
    draw(&s);
    for (int i = 0; i < W * H; i++) {
        if (!is_drawn(&s, i)) continue;
        const struct vec3 p = ray_point(&s, i, (double)s.layer.z[i]);
        drawn += p.x < 0;
        assert_true(hypot(p.y, p.z) < 0.85); /* the shadow's cone at the end of the box */
    }
    assert_true(drawn > 300);
    scene_release(&s);
}

static void the_shell_hides_what_is_behind_it(void **state)
{
    static struct scene s;
    (void)state;
    scene_make(&s, to_ball);
    draw(&s); /* without a shell */
    const int all = count_drawn(&s);
    assert_true(all > 300);
    /* depths of the shell are of the model, twice those of the scene */
    for (int i = 0; i < W * H; i++) s.shell[i] = 2 * 5;
    draw(&s);
    assert_int_equal(count_drawn(&s), all);
    for (int i = 0; i < W * H; i++) s.shell[i] = 2 * 0.5f;
    draw(&s);
    assert_int_equal(count_drawn(&s), 0);
    /* on the left a wall before it, on the right the floor that it touches, a little before its surface */
    memset(s.shell, 0, sizeof s.shell);
    draw(&s);
    for (int i = 0; i < W * H; i++) s.shell[i] = 2 * s.layer.z[i] * (i % W < W / 2 ? 0.9f : 0.98f);
    int right = 0;
    for (int i = 0; i < W * H; i++) right += i % W >= W / 2 && is_drawn(&s, i);
    draw(&s);
    assert_int_equal(count_drawn(&s), right);
    for (int i = 0; i < W * H; i++) assert_true(i % W >= W / 2 || !is_drawn(&s, i));
    scene_release(&s);
}

static void unseen_and_foreign_voxels_make_no_surface(void **state)
{
    static struct scene s;
    (void)state;
    for (int foreign = 0; foreign < 2; foreign++) {
        int kept = 0;
        scene_make(&s, to_ball);
        for (int64_t i = 0; i < (int64_t)voxel_count(&s.volume.grid); i++)
            if (thing_voxel_centre(&s.volume.grid, i).z > middle.z) {
                if (foreign)
                    s.volume.id[i] = THING - 1;
                else
                    s.volume.distance[i] = THING_UNSEEN;
            }
        draw(&s);
        for (int i = 0; i < W * H; i++) {
            double slant;
            const double z = ball_depth(&s, i, &slant);
            const double height = ray_point(&s, i, z).z;
            if (slant > 0.5 && height < -VOXEL) assert_true(is_drawn(&s, i));
            if (is_drawn(&s, i)) assert_true(ray_point(&s, i, (double)s.layer.z[i]).z <= 0);
            kept += is_drawn(&s, i);
        }
        assert_true(kept > 100);
        scene_release(&s);
    }
}

/* Without the voxels before it, a surface begins nowhere: its inside alone is not drawn. */
static void a_surface_needs_what_is_before_it(void **state)
{
    static struct scene s;
    (void)state;
    scene_make(&s, to_ball);
    for (size_t i = 0; i < voxel_count(&s.volume.grid); i++)
        if (s.volume.distance[i] > 0) s.volume.distance[i] = THING_UNSEEN;
    draw(&s);
    assert_int_equal(count_drawn(&s), 0);
    scene_release(&s);
}

/* ------------------------------------------------------------------------------------------------------------ rims */

/* A rug of five corners, turned against the voxels, in the plane through the middle of the grid. Its voxels are as
 * find_things makes them: of whole columns. */
static void lay_rug(struct scene *s)
{
    static const double corners[][2] = {{-0.8, -0.3}, {0.1, -0.85}, {0.75, -0.2}, {0.3, 0.6}, {-0.5, 0.45}};
    struct err err = ERR_INIT;
    assert_ok(flat_outline_init(&s->outline, vec3_make(0, 0, 1), middle.z, 5, &err), err);
    for (int i = 0; i < 5; i++)
        flat_outline_put(&s->outline, i, vec3_add(middle, vec3_make(corners[i][0], corners[i][1], 0)));
    for (int64_t i = 0; i < (int64_t)voxel_count(&s->volume.grid); i++) {
        const struct vec3 p = thing_voxel_centre(&s->volume.grid, i);
        const double above = (p.z - middle.z) / VOXEL;
        const bool has = above > -1 && above <= 2 && flat_outline_holds(&s->outline, p);
        s->volume.id[i] = has ? THING : 0;
        s->volume.distance[i] = has ? (float)(above / 2.5) : THING_UNSEEN;
    }
}

/* The distance in the picture, px, of a place from the rim of the rug. */
static double from_rim(const struct scene *s, double x, double y)
{
    double least = INFINITY, at[2][2];
    for (int i = 0; i < s->outline.count; i++) {
        for (int k = 0; k < 2; k++) {
            const struct vec3 corner = flat_outline_corner(&s->outline, (i + k) % s->outline.count);
            view_project(&s->camera, world_from_model_point(&axes, corner), &at[k][0], &at[k][1]);
        }
        const double dx = at[1][0] - at[0][0], dy = at[1][1] - at[0][1];
        const double t = fmin(1, fmax(0, ((x - at[0][0]) * dx + (y - at[0][1]) * dy) / (dx * dx + dy * dy)));
        least = fmin(least, hypot(x - at[0][0] - t * dx, y - at[0][1] - t * dy));
    }
    return least;
}

/* The area of the rug in the picture, px. */
static double area_seen(const struct scene *s)
{
    double sum = 0, u[2], v[2];
    for (int i = 0; i < s->outline.count; i++) {
        for (int k = 0; k < 2; k++)
            view_project(&s->camera,
                         world_from_model_point(&axes, flat_outline_corner(&s->outline, (i + k) % s->outline.count)),
                         &u[k], &v[k]);
        sum += u[0] * v[1] - u[1] * v[0];
    }
    return fabs(sum / 2);
}

/* Its rim is that of its outline within a pixel, wherever the camera that draws it stands. Voxels would be off by up to
 * two pixels here. */
static void the_rim_of_a_rug_is_straight(void **state)
{
    static const double cameras[][3] = {{3.5, 3, 4.5}, {2, 4.25, 3.6}, {1.1, 2.2, 5}};
    static struct scene s;
    (void)state;
    for (size_t c = 0; c < sizeof cameras / sizeof *cameras; c++) {
        int inside = 0, rim = 0;
        double covered = 0;
        scene_make(&s, to_ball);
        s.camera = s.views[0] = looking_from(cameras[c][0], cameras[c][1], cameras[c][2]);
        lay_rug(&s);
        draw(&s);
        for (int i = 0; i < W * H; i++) {
            const double x = i % W + 0.5, y = i / W + 0.5, away = from_rim(&s, x, y);
            const struct vec3 from = model_from_world_point(&axes, s.camera.center),
                              one = model_from_world_point(&axes, view_unproject(&s.camera, x, y, 1));
            const bool is_rug = flat_outline_meets(NULL, &s.outline, from, vec3_sub(one, from));
            const float part = s.layer.rgba[4 * i + 3];
            if (x < 3 || y < 3 || x > W - 3 || y > H - 3) continue; /* the view's border gives no colour */
            covered += (double)part;
            if (away > 1) {
                assert_float_equal(part, is_rug, 0);
                inside += is_rug;
            } else if (part > 0) {
                assert_float_equal(s.layer.rgba[4 * i], 0.75f * part, 1e-3); /* its own colour, premultiplied */
                rim++;
            }
            if (part >= 0.5f) assert_float_equal(ray_point(&s, i, (double)s.layer.z[i]).z, 0, 1e-6);
        }
        assert_true(inside > 100 && rim > 50);
        assert_float_equal(covered / area_seen(&s), 1, 0.01);
        scene_release(&s);
    }
}

/* What lies flat is hidden by what is a little before it: its depth is exact. */
static void legs_on_a_rug_hide_it(void **state)
{
    static struct scene s;
    (void)state;
    scene_make(&s, to_ball);
    lay_rug(&s);
    draw(&s);
    for (int i = 0; i < W * H; i++) s.shell[i] = 2 * s.layer.z[i] * (i % W < W / 2 ? 0.98f : 0.999f);
    int right = 0;
    for (int i = 0; i < W * H; i++) right += i % W >= W / 2 && is_drawn(&s, i);
    draw(&s);
    assert_true(right > 100);
    for (int i = 0; i < W * H; i++) assert_true(i % W >= W / 2 || !is_drawn(&s, i) || !(s.shell[i] > 0));
    memset(s.shell, 0, sizeof s.shell);
    scene_release(&s);
}

/* ---------------------------------------------------------------------------------------------------------- colours */

static void it_has_the_colour_of_the_views_that_see_it(void **state)
{
    static struct scene s;
    double slant;
    const int centre = H / 2 * W + W / 2;
    (void)state;
    scene_make(&s, to_ball);
    const double z = ball_depth(&s, centre, &slant);
    clutter_view_release(&s.sources[0].view);
    make_source(&s, 0, 0.75f, 0.5f, z);
    make_source(&s, 1, 0.1f, 0.9f, 0.5 * z); /* something else hides the thing from this one */
    make_source(&s, 2, 0.1f, 0.9f, 0);       /* this one shows no clutter */
    s.choice = (struct clutter_choice){.view = {0, 1, 2}, .fade = {1, 1, 1}, .count = 3};
    draw(&s);
    assert_float_equal(s.layer.rgba[4 * centre], 0.75, 0.005);
    assert_float_equal(s.layer.rgba[4 * centre + 1], 0.5, 0.005);
    assert_float_equal(s.layer.rgba[4 * centre + 3], 1, 0);
    /* those that do not see it count if there are no others */
    s.choice = (struct clutter_choice){.view = {1, 2}, .fade = {1, 1}, .count = 2};
    draw(&s);
    assert_float_equal(s.layer.rgba[4 * centre], 0.1, 0.005);
    assert_float_equal(s.layer.rgba[4 * centre + 1], 0.9, 0.005);
    s.choice = (struct clutter_choice){.view = {2}, .fade = {1}, .count = 1};
    draw(&s);
    assert_int_equal(count_drawn(&s), 0);
    scene_release(&s);
}

static void a_view_beside_the_camera_counts_more_than_one_aside(void **state)
{
    static struct scene s;
    double slant;
    const int centre = H / 2 * W + W / 2;
    (void)state;
    scene_make(&s, to_ball);
    const double z = ball_depth(&s, centre, &slant);
    clutter_view_release(&s.sources[0].view);
    s.views[1] = looking_from(3, 4.25, 3.5);
    const struct vec3 p = view_unproject(&s.camera, W / 2 + 0.5, H / 2 + 0.5, z);
    double u, v;
    make_source(&s, 0, 0.75f, 0.5f, z);
    make_source(&s, 1, 0.25f, 0.5f, view_project(&s.views[1], p, &u, &v));
    s.choice = (struct clutter_choice){.view = {0, 1}, .fade = {1, 1}, .count = 2};
    draw(&s);
    assert_true(s.layer.rgba[4 * centre] > 0.7f && s.layer.rgba[4 * centre] < 0.7499f);
    scene_release(&s);
}

static void it_lies_under_what_the_layer_has(void **state)
{
    static struct scene s;
    static const float covers[] = {0.25f, 0.75f, 1};
    const int centre = H / 2 * W + W / 2;
    (void)state;
    scene_make(&s, to_ball);
    draw(&s);
    const struct thing_points points = points_of(&s.volume);
    struct thing_rows rows;
    const float surface = s.layer.z[centre];
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < W * H; i++) {
            for (int c = 0; c < 3; c++) s.layer.rgba[4 * i + c] = 0.1f * covers[k];
            s.layer.rgba[4 * i + 3] = covers[k];
            s.layer.z[i] = 1;
        }
        const struct thing_shape thing = {THING, &s.volume, &points, &s.outline};
        struct err err = ERR_INIT;
        assert_ok(thing_surface_draw(&rows, &s.layer, s.shell, &s.clutter, &s.choice, &s.camera, &thing, &err), err);
        assert_float_equal(s.layer.rgba[4 * centre], 0.1f * covers[k] + 0.75f * (1 - covers[k]), 1e-3);
        assert_float_equal(s.layer.rgba[4 * centre + 3], 1, 0);
        assert_float_equal(s.layer.z[centre], covers[k] < 0.5f ? surface : 1, 1e-6);
        assert_float_equal(s.layer.rgba[3], covers[k], 0); /* beside the ball */
    }
    scene_release(&s);
}

static void threads_do_not_matter(void **state)
{
    static struct scene s;
    (void)state;
    scene_make(&s, to_block);
    float *once = malloc(4 * (size_t)W * H * sizeof *once);
    assert_non_null(once);
    parallel_set_threads(1);
    draw(&s);
    memcpy(once, s.layer.rgba, 4 * (size_t)W * H * sizeof *once);
    parallel_set_threads(3);
    draw(&s);
    parallel_set_threads(0);
    assert_memory_equal(s.layer.rgba, once, 4 * (size_t)W * H * sizeof *once);
    free(once);
    scene_release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_is_met_at_its_front),
        cmocka_unit_test(the_faces_of_a_block_are_met_exactly),
        cmocka_unit_test(what_a_view_shows_of_another_thing_is_no_colour),
        cmocka_unit_test(a_side_that_no_view_sees_has_the_colours_at_its_height),
        cmocka_unit_test(the_hull_is_what_a_thing_hides),
        cmocka_unit_test(the_hull_leaves_out_what_is_free_or_of_another_thing),
        cmocka_unit_test(the_hull_ends_at_walls),
        cmocka_unit_test(a_ray_meets_the_hull_where_no_surface_is),
        cmocka_unit_test(the_shell_hides_what_is_behind_it),
        cmocka_unit_test(unseen_and_foreign_voxels_make_no_surface),
        cmocka_unit_test(a_surface_needs_what_is_before_it),
        cmocka_unit_test(the_rim_of_a_rug_is_straight),
        cmocka_unit_test(legs_on_a_rug_hide_it),
        cmocka_unit_test(it_has_the_colour_of_the_views_that_see_it),
        cmocka_unit_test(a_view_beside_the_camera_counts_more_than_one_aside),
        cmocka_unit_test(it_lies_under_what_the_layer_has),
        cmocka_unit_test(threads_do_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
