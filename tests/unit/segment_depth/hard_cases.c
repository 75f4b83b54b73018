/* hard_cases.c - the whole stage where matching is ambiguous: blank walls, wallpaper, gloss, no neighbour, broken and
 * odd pictures; and that a second round does not make the first one's depth worse. */
#include "tests/unit/scratch.h"
#include "tests/unit/segment_depth/whole.h"

#include <sys/resource.h>
#include <time.h>

#include "common/capture/view_image.h"

static const struct segment_params params = SEGMENT_PARAMS_DEFAULT;

static struct painted_surface *floor_at(double y, double far)
{
    struct painted_surface *floor = scene_surface(&scene, vec3_make(0, y, far / 2));
    floor->across = vec3_make(15, 0, 0);
    floor->down = vec3_make(0, 0, far / 2);
    return floor;
}

/* ------------------------------------------------------------------------------------------------- ambiguous
 * surfaces */

/* The relative depth error of half a pixel of disparity between the nearest views: the accuracy of matching. */
static double half_a_step(double z) { return 0.5 * z / (FOCAL * 0.4); }

/* A room whose back wall has no texture; the floor, the ceiling and the side walls have. */
static void a_textureless_wall_closes_the_room(void **state)
{
    (void)state;
    for (int points = 0; points < 2; points++) {
        struct layered_depth d[2];
        start();
        scene_wall(&scene, 0, 0, 6, 2, 1.5, 0)->contrast = 0;
        floor_at(1.5, 6)->colour[0] = 0.15f;
        floor_at(-1.5, 6)->colour[1] = 0.15f;
        for (int side = -1; side <= 1; side += 2) {
            struct painted_surface *wall = scene_surface(&scene, vec3_make(2 * side, 0, 3));
            wall->across = vec3_make(0, 0, 3);
            wall->down = vec3_make(0, 1.5, 0);
        }
        place_cameras(5);
        scene_points(&scene, points * 300);
        must_work_in_rounds(d, 1, &params);
        for (int round = 0; round < 2; round++) {
            assert_true(fraction_correct(&d[round], 0, half_a_step(6)) > 0.95);
            assert_true(fraction_correct(&d[round], -1, half_a_step(6)) > 0.95);
            layered_depth_release(&d[round]);
        }
    }
}

/* Wallpaper whose stripes match at many depths, between textured plaster above and below. Without points. */
static void wallpaper_gets_the_depth_of_its_frame(void **state)
{
    (void)state;
    struct layered_depth d[2];
    start();
    scene_wall(&scene, 0, 0, 5, 9, 9, 0);
    scene_wall(&scene, 0, 0, 5 - 1e-4, 1.2, 0.5, 0)->period = 0.31; /* 10 px */
    place_cameras(5);
    must_work_in_rounds(d, 1, &params);
    for (int round = 0; round < 2; round++) {
        assert_true(fraction_correct(&d[round], 0, 0.02) > 0.95);
        assert_true(fraction_correct(&d[round], 1, 0.02) > 0.9);
        layered_depth_release(&d[round]);
    }
}

/* A lamp is reflected in the floor: the spot moves from view to view like a lamp below the floor. A weak one does not
 * change the floor's depth. A bright one hides the floor, but changes the depth only where it is. */
static void a_highlight_on_a_glossy_floor_changes_only_its_own_pixels(void **state)
{
    (void)state;
    for (int burnt = 0; burnt < 2; burnt++) {
        struct layered_depth d[2];
        start();
        struct painted_surface *floor = floor_at(1, 14);
        floor->gloss = burnt ? 5 : 0.3;
        floor->light = vec3_make(0, -0.5, 9);
        scene_wall(&scene, 0, 0, 12, 20, 20, 0)->cell = 0.6;
        place_cameras(5);
        scene_points(&scene, 300);
        must_work_in_rounds(d, 1, &params);
        for (int round = 0; round < 2; round++) {
            int pixels[2] = {0}, good[2] = {0}; /* outside, inside the highlight */
            for (int y = 0; y < H; y++)
                for (int x = 0; x < W; x++) {
                    int at;
                    const double z = scene_depth(&scene, &scene.views[0], x + 0.5, y + 0.5, &at);
                    const struct vec3 p = view_unproject(&scene.views[0], x + 0.5, y + 0.5, z);
                    assert_true(d[round].interior.z[y * W + x] > 0);
                    if (at != 0 || at_jump(x, y)) continue;
                    const bool lit = scene_highlight(floor, p, scene.views[0].center) > 0.1;
                    pixels[lit]++;
                    good[lit] += fabs(1 / (double)d[round].interior.z[y * W + x] - 1 / z) < 0.5 / (FOCAL * 0.4);
                }
            if (getenv("VERDICT"))
                print_message("  %d of %d dull, %d of %d lit\n", good[0], pixels[0], good[1], pixels[1]);
            assert_true(pixels[1] > 200 && good[0] > 0.95 * pixels[0]);
            if (!burnt) assert_true(good[1] > 0.95 * pixels[1]);
            layered_depth_release(&d[round]);
        }
    }
}

/* A floor at y = 1 that reflects, with weight `mirror`, a wall of other colours at z = 9. */
static double mirror;
static enum status mirroring_photo(void *ctx, int view_idx, struct image *im, struct err *err)
{
    struct scene *s = &scene;
    const struct view *v = &s->views[view_idx];
    (void)ctx;
    if (scene_photo(s, view_idx, im, err)) return err->status;
    for (int y = 0; y < v->height; y++)
        for (int x = 0; x < v->width; x++) {
            float *rgba = image_at(im, x, y), sum[3] = {0};
            int at;
            for (int k = 0; k < 9; k++) {
                const double u = x + (k % 3 + 0.5) / 3, w = y + (k / 3 + 0.5) / 3, z = scene_depth(s, v, u, w, &at);
                if (at != 0) break;
                const struct vec3 p = view_unproject(v, u, w, z), d = vec3_sub(p, v->center);
                const double t = (9 - p.z) / d.z;
                float rgb[3] = {0};
                scene_paint(&s->surfaces[1], vec3_make(p.x + t * d.x, p.y - t * d.y, 9), rgb);
                for (int c = 0; c < 3; c++) sum[c] += rgb[c] / 9;
            }
            if (at != 0) continue;
            for (int c = 0; c < 3; c++) rgba[c] = (1 - (float)mirror) * rgba[c] + (float)mirror * sum[c];
        }
    return ST_OK;
}

/* A polished floor gets its own depth. A near-perfect mirror shows the wall's reflection in all views: it gets one of
 * the two depths, and the wall keeps its own. */
static void a_floor_is_found_unless_it_is_a_mirror(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        struct layered_depth d[2];
        start();
        mirror = k & 1 ? 0.85 : 0.3;
        floor_at(1, 9);
        struct painted_surface *wall = scene_wall(&scene, 0, 0, 9, 20, 20, 0);
        wall->cell = 0.6;
        wall->colour[0] = 0.15f;
        place_cameras(5);
        scene_points(&scene, k & 2 ? 300 : 0);
        must_work_in_rounds_of(d, 1, &params, mirroring_photo);
        for (int round = 0; round < 2; round++) {
            int floor = 0, mirrored = 0, own = 0;
            for (int y = 0; y < H; y++)
                for (int x = 0; x < W; x++) {
                    int at;
                    const double z = scene_depth(&scene, &scene.views[0], x + 0.5, y + 0.5, &at);
                    const double found = (double)d[round].interior.z[y * W + x];
                    if (at != 0 || at_jump(x, y)) continue;
                    floor++;
                    if (fabs(found / z - 1) <= 0.05)
                        own++;
                    else
                        mirrored += fabs(found / 9 - 1) <= 0.05;
                }
            if (getenv("VERDICT"))
                print_message(
                    "  mirrors %.2f, %d points: of %d px of floor %d are the floor's, %d the mirror image's\n", mirror,
                    k & 2 ? 300 : 0, floor, own, mirrored);
            assert_true(own + (k & 1 ? mirrored : 0) > 0.95 * floor);
            assert_true(fraction_correct(&d[round], 1, half_a_step(9) / 9) > 0.95);
            layered_depth_release(&d[round]);
        }
    }
}

/* The first photo shows something else on a part of the front wall, as a reflection does. */
static const int reflected[4] = {40, 40, 80, 80}; /* x0, y0, x1, y1 */
static enum status reflecting_photo(void *ctx, int view_idx, struct image *im, struct err *err)
{
    (void)ctx;
    if (scene_photo(&scene, view_idx, im, err)) return err->status;
    if (view_idx) return ST_OK;
    for (int y = reflected[1]; y < reflected[3]; y++)
        for (int x = reflected[0]; x < reflected[2]; x++)
            scene_paint(&scene.surfaces[0], vec3_make(70 + 0.03 * x, 50 + 0.03 * y, 5), image_at(im, x, y));
    return ST_OK;
}

/* What matches in no other view does not hide behind the wall, where no picture would speak against it: the other views
 * know the wall. */
static void a_reflection_beside_an_edge_does_not_hide_behind_its_wall(void **state)
{
    (void)state;
    struct layered_depth d[2];
    int pixels = 0, good[2] = {0};
    start();
    scene_wall(&scene, -2.5, 0, 5, 2.5, 9, 0); /* up to the middle of the picture */
    scene_wall(&scene, 0, 0, 9, 20, 20, 0)->cell = 0.5;
    place_cameras(5);
    scene_points(&scene, 300);
    must_work_in_rounds_of(d, 1, &params, reflecting_photo);
    for (int round = 0; round < 2; round++) {
        for (int y = reflected[1]; y < reflected[3]; y++)
            for (int x = reflected[0]; x < reflected[2] - 4; x++) {
                pixels += !round;
                good[round] += fabs((double)d[round].interior.z[y * W + x] / 5 - 1) <= 0.02;
            }
        layered_depth_release(&d[round]);
    }
    if (getenv("VERDICT")) print_message("  of %d px %d, then %d are on the wall\n", pixels, good[0], good[1]);
    assert_true(good[1] > 0.95 * pixels);
}

/* --------------------------------------------------------------------------------------------------- missing
 * neighbours */

static void a_view_without_neighbours_is_an_error(void **state)
{
    (void)state;
    for (int views = 1; views <= 2; views++) {
        struct result r = {0};
        struct err err = ERR_INIT;
        start();
        scene_wall(&scene, 0, 0, 5, 9, 9, 0);
        place_cameras(1);
        if (views == 2) scene_view(&scene, W, H, FOCAL, 0.4, 0, 0, M_PI); /* faces the other way */
        assert_int_equal(depth_of(&r, &params, &err), ST_DATA);
        assert_err(err, ST_DATA, "view a has no neighbour to match with: none of the ");
        assert_contains(err.text, views == 1 ? "the 0 other view(s)" : "the 1 other view(s)");
        assert_contains(err.text, "at least two views taken from different positions");
        assert_int_equal(r.neighbour_count, 0);
        assert_true(!r.depth.interior.id && !r.depth.segments);
    }
}

static void put_text(FILE *fp, const char *name, const char *type, const void *value, uint32_t size)
{
    fwrite(name, 1, strlen(name) + 1, fp);
    fwrite(type, 1, strlen(type) + 1, fp);
    fwrite(&size, 4, 1, fp);
    fwrite(value, 1, size, fp);
}

/* Writes an EXR with arbitrary floats, which the project's own writer rejects: uncompressed, one line per chunk. */
static void write_any_exr(const char *path, const struct image *im)
{
    static const char magic[8] = {0x76, 0x2f, 0x31, 0x01, 2};
    static const int channel_of[4] = {3, 2, 1, 0}; /* A B G R */
    const int32_t window[4] = {0, 0, im->width - 1, im->height - 1};
    const float one = 1, centre[2] = {0, 0};
    char list[4 * 18 + 1] = {0};
    FILE *fp = fopen(path, "wb");
    assert_non_null(fp);
    for (int c = 0; c < 4; c++) {
        char *at = list + (ptrdiff_t)18 * c; /* name, float, linear, sampling 1 1 */
        const int32_t type = 2, sampling = 1;
        at[0] = "ABGR"[c];
        memcpy(at + 2, &type, 4);
        memcpy(at + 10, &sampling, 4);
        memcpy(at + 14, &sampling, 4);
    }
    fwrite(magic, 1, 8, fp);
    put_text(fp, "channels", "chlist", list, sizeof list);
    put_text(fp, "compression", "compression", "", 1);
    put_text(fp, "dataWindow", "box2i", window, sizeof window);
    put_text(fp, "displayWindow", "box2i", window, sizeof window);
    put_text(fp, "lineOrder", "lineOrder", "", 1);
    put_text(fp, "pixelAspectRatio", "float", &one, 4);
    put_text(fp, "screenWindowCenter", "v2f", centre, 8);
    put_text(fp, "screenWindowWidth", "float", &one, 4);
    fputc(0, fp);
    const uint64_t table = (uint64_t)ftell(fp) + 8 * (uint64_t)im->height, line = 8 + 16 * (uint64_t)im->width;
    for (int y = 0; y < im->height; y++) fwrite(&(uint64_t){table + line * (uint64_t)y}, 8, 1, fp);
    for (int32_t y = 0; y < im->height; y++) {
        fwrite(&y, 4, 1, fp);
        fwrite(&(int32_t){16 * im->width}, 4, 1, fp);
        for (int c = 0; c < 4; c++)
            for (int x = 0; x < im->width; x++) fwrite(&im->data[4 * (y * im->width + x) + channel_of[c]], 4, 1, fp);
    }
    assert_int_equal(fclose(fp), 0);
}

static enum status photo_on_disk(void *ctx, int view_idx, struct image *im, struct err *err)
{
    (void)ctx;
    return view_image_read(im, scratch, &scene.views[view_idx], NULL, err);
}

/* In the view itself or in a neighbour: an error with file, channel and pixel. */
static void a_nan_in_a_view_is_an_error_with_its_pixel(void **state)
{
    (void)state;
    const struct view_source source = {.read = photo_on_disk};
    start();
    scene_wall(&scene, 0, 0, 5, 9, 9, 0.2);
    place_cameras(3);
    for (int broken = -1; broken < 6; broken++) {
        struct result r = {0};
        struct err err = ERR_INIT;
        for (int k = 0; k < 3; k++) {
            struct image photo;
            char name[8];
            assert_int_equal(scene_photo(&scene, k, &photo, &err), ST_OK);
            if (broken >= 0 && broken % 3 == k) image_at(&photo, 41, 17)[1] = broken < 3 ? NAN : -INFINITY;
            snprintf(name, sizeof name, "%s.exr", scene.views[k].name);
            write_any_exr(scratch_path(name), &photo);
            image_release(&photo);
        }
        const enum status st =
            view_depth(&r.depth, r.neighbours, &r.neighbour_count, &scene.set, 0, &source, &params, &err);
        if (broken < 0) { /* neither file is broken */
            assert_ok(st, err);
            assert_true(fraction_correct(&r.depth, -1, 0.02) > 0.95);
            layered_depth_release(&r.depth);
            continue;
        }
        assert_int_equal(st, ST_DATA);
        assert_err(err, ST_DATA, "channel G holds NaN or infinity at pixel (41, 17)");
        char name[8];
        snprintf(name, sizeof name, "/%s.exr", scene.views[broken % 3].name);
        assert_contains(err.text, name);
        assert_true(!r.depth.interior.id && !r.depth.segments);
    }
}

/* A previous round of another picture, or none. */
static enum status depth_of_narrower(void *ctx, int view_idx, struct layered_depth *d, struct err *err)
{
    const enum status st = rounds_depth(ctx, view_idx, d, err);
    d->width -= view_idx == 0;
    return st;
}
static enum status no_depth(void *ctx, int view_idx, struct layered_depth *d, struct err *err)
{
    (void)ctx, (void)d;
    return err_set(err, ST_IO, "there is no depth of view %d.", view_idx);
}

static void a_previous_round_of_another_picture_is_an_error(void **state)
{
    (void)state;
    static struct rounds before;
    struct result r = {0};
    struct err err = ERR_INIT;
    start();
    scene_wall(&scene, 0, 0, 5, 9, 9, 0.2);
    place_cameras(2);
    before.scene = &scene;
    const struct view_source first = {.read = scene_photo, .ctx = &scene},
                             less = {.read = rounds_photo, .read_depth = depth_of_narrower, .ctx = &before},
                             none = {.read = rounds_photo, .read_depth = no_depth, .ctx = &before};
    for (int k = 0; k < 2; k++)
        assert_ok(view_depth(&before.depth[k], r.neighbours, &r.neighbour_count, &scene.set, k, &first, &params, &err),
                  err);
    assert_int_equal(view_depth(&r.depth, r.neighbours, &r.neighbour_count, &scene.set, 0, &less, &params, &err),
                     ST_DATA);
    assert_err(err, ST_DATA, "the previous round of view a has ");
    assert_true(!r.depth.interior.id && !r.depth.segments);
    err = (struct err)ERR_INIT;
    assert_int_equal(view_depth(&r.depth, r.neighbours, &r.neighbour_count, &scene.set, 0, &none, &params, &err),
                     ST_IO);
    assert_string_equal(err.text, "there is no depth of view 1.");
    assert_true(!r.depth.interior.id && !r.depth.segments);
    for (int k = 0; k < 2; k++) layered_depth_release(&before.depth[k]);
}

/* The only neighbour is half as wide as the view: the parts outside its frame inherit their depth. */
static void unmatched_parts_inherit_depth_and_are_counted(void **state)
{
    (void)state;
    for (int points = 0; points < 2; points++) {
        struct layered_depth d[2];
        start();
        scene_wall(&scene, 0, 0, 5, 9, 9, 0);
        place_cameras(1);
        scene_view(&scene, W / 2, H, FOCAL, 0.4, 0, 0, 0);
        scene_points(&scene, points * 300);
        must_work_in_rounds(d, 1, &params);
        const double left = W / 2.0 - W / 4.0 + FOCAL * 0.4 / 5, right_end = left + W / 2.0, margin = 6;
        for (int round = 0; round < 2; round++) {
            int unseen = 0, seen = 0, inherited = 0, confident = 0;
            for (int i = 0; i < W * H; i++) {
                const bool sure = d[round].segments[d[round].interior.id[i] - 1].confidence >= DEPTH_INHERITED;
                const double u = i % W + 0.5;
                if (u > left + margin && u < right_end - margin) seen++, confident += sure;
                if (u < left - margin || u > right_end + margin) unseen++, inherited += !sure;
            }
            const struct depth_shares shares = layered_depth_shares(&d[round]);
            if (getenv("VERDICT"))
                print_message("  %.4f of unseen inherited, %.4f of seen confident, %.4f of all inherited\n",
                              inherited / (double)unseen, confident / (double)seen, shares.inherited);
            assert_true(inherited > 0.99 * unseen);
            assert_true(confident > 0.98 * seen);
            assert_true(shares.unknown == 0);
            assert_near(shares.inherited, 0.5, 0.04);
            assert_true(fraction_correct(&d[round], 0, 0.02) > 0.97);
            layered_depth_release(&d[round]);
        }
    }
}

/* All views have a masked disc. */
static void masked_pixels_have_no_depth_and_are_counted(void **state)
{
    (void)state;
    struct result r;
    int masked = 0;
    start();
    scene_wall(&scene, 0, 0, 5, 9, 9, 0);
    place_cameras(3);
    scene.holes = true;
    must_work(&r);
    for (int i = 0; i < W * H; i++) masked += hypot(i % W + 0.5 - W / 2.0, i / W + 0.5 - H / 2.0) < H / 6.0;
    assert_near(layered_depth_shares(&r.depth).unknown, masked / (double)(W * H), 1e-12);
    layered_depth_release(&r.depth);
}

/* ------------------------------------------------------------------------------------------------------- odd
 * pictures */

static void photos_of_one_pixel_work_in_rounds(void **state)
{
    (void)state;
    for (int points = 0; points < 2; points++) {
        struct layered_depth d[3];
        start();
        scene_wall(&scene, 0, 0, 5, 90, 90, 0);
        for (int k = 0; k < 3; k++) scene_view(&scene, 1, 1, 20, 0.02 * k, 0, 0, 0);
        scene_points(&scene, points * 60);
        must_work_in_rounds(d, 2, &params);
        for (int round = 0; round < 3; round++) {
            assert_int_equal(d[round].segment_count, 1);
            if (getenv("VERDICT")) print_message("  depth %.3f\n", (double)d[round].interior.z[0]);
            assert_true(points ? fabs((double)d[round].interior.z[0] / 5 - 1) < 0.05 : d[round].interior.z[0] > 0);
            layered_depth_release(&d[round]);
        }
    }
}

/* A strip of a wall at depth 5, one ray per pixel. */
static enum status strip_photo(void *ctx, int view_idx, struct image *im, struct err *err)
{
    const struct scene *s = ctx;
    const struct view *v = &s->views[view_idx];
    if (image_init(im, v->width, v->height, 4, err)) return err->status;
    for (int y = 0; y < v->height; y++)
        for (int x = 0; x < v->width; x++) {
            const struct vec3 p = view_unproject(v, x + 0.5, y + 0.5, 5);
            float *rgba = image_at(im, x, y);
            for (int c = 0; c < 3; c++) rgba[c] = 0.1f + 0.5f * (float)scene_noise(p.x / 0.02 + 31 * c, p.y / 0.02, 0);
            rgba[3] = 1;
        }
    return ST_OK;
}

/* Radiance as from brackets, neither quantized nor clipped. On a wall at depth 5 it falls from 1 to 1e-6 from left to
 * right, or a lamp is a million times as bright as the rest. */
static bool lamp;
static enum status bright_photo(void *ctx, int view_idx, struct image *im, struct err *err)
{
    const struct view *v = &scene.views[view_idx];
    (void)ctx;
    if (image_init(im, v->width, v->height, 4, err)) return err->status;
    for (int y = 0; y < v->height; y++)
        for (int x = 0; x < v->width; x++) {
            const struct vec3 p = view_unproject(v, x + 0.5, y + 0.5, 5);
            float rgb[3] = {0}, *rgba = image_at(im, x, y);
            scene_paint(&scene.surfaces[0], p, rgb);
            const double light = lamp ? hypot(p.x - 0.8, p.y + 0.5) < 0.3 ? 1e6 : 1 : pow(10, -6 * (p.x + 2.5) / 5);
            for (int c = 0; c < 3; c++) rgba[c] = (float)light * rgb[c];
            rgba[3] = 1;
        }
    return ST_OK;
}

static void a_dynamic_range_of_a_million_to_one_is_matched(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        struct layered_depth d[2];
        lamp = k & 1;
        start();
        scene_wall(&scene, 0, 0, 5, 9, 9, 0);
        place_cameras(5);
        scene_points(&scene, k & 2 ? 200 : 0);
        must_work_in_rounds_of(d, 1, &params, bright_photo);
        for (int round = 0; round < 2; round++) {
            assert_true(fraction_correct(&d[round], 0, 0.02) > 0.95);
            layered_depth_release(&d[round]);
        }
    }
}

/* A white, overexposed window in a wall, with a landscape 12 times as far behind it. The landscape's depth cannot be
 * known: it must have low confidence and lie at the wall or behind it, and the wall must keep its own. */
static void an_overexposed_window_has_low_confidence_and_its_wall_is_found(void **state)
{
    (void)state;
    for (int points = 0; points < 2; points++) {
        struct layered_depth d[2];
        start();
        for (int side = -1; side <= 1; side += 2) { /* the wall around it */
            scene_wall(&scene, side * 6.2, 0, 5, 5, 12, 0);
            scene_wall(&scene, 0, side * 5.9, 5, 1.2, 5, 0);
        }
        struct painted_surface *outside = scene_wall(&scene, 0, 0, 60, 90, 90, 0);
        for (int c = 0; c < 3; c++) outside->colour[c] = 30;
        place_cameras(5);
        scene_points(&scene, points * 200);
        must_work_in_rounds(d, 1, &params);
        for (int round = 0; round < 2; round++) {
            int window = 0, behind = 0, inner = 0, confident = 0;
            for (int i = 0; i < W * H; i++) {
                int at;
                const double z = scene_depth(&scene, &scene.views[0], i % W + 0.5, i / W + 0.5, &at);
                if (z < 10 || at_jump(i % W, i / W)) continue;
                window++;
                behind += d[round].interior.z[i] > 4.85f;
                /* one segment inside the rim, which belongs to the wall and matches */
                if (fabs(i % W + 0.5 - W / 2.0) > 38 - 10 || fabs(i / W + 0.5 - H / 2.0) > 28 - 10) continue;
                inner++;
                confident += d[round].segments[d[round].interior.id[i] - 1].confidence < DEPTH_INHERITED;
            }
            if (getenv("VERDICT"))
                print_message("  of %d px %d at the wall or behind, of %d inner ones %d confident as inherited\n",
                              window, behind, inner, confident);
            assert_true(inner > 1000 && behind > 0.95 * window && confident > 0.9 * inner);
            for (int k = 0; k < 4; k++) assert_true(fraction_correct(&d[round], k, 0.02) > 0.97);
            layered_depth_release(&d[round]);
        }
    }
}

/* 20000 x 16 px and 16 x 20000 px, a third of a megapixel: no more time and memory than for other pictures of that
 * size. */
static void an_extremely_long_photo_works(void **state)
{
    (void)state;
    const struct view_source source = {.read = strip_photo, .ctx = &scene};
    for (int upright = 0; upright < 2; upright++) {
        struct result r = {0};
        struct err err = ERR_INIT;
        const int width = upright ? 16 : 20000, height = upright ? 20000 : 16;
        const clock_t began = clock();
        start();
        for (int k = 0; k < 2; k++)
            scene_view(&scene, width, height, 2000, upright ? 0 : 0.05 * k, upright ? 0.05 * k : 0, 0, 0);
        for (int i = 0; i < 60; i++) {
            const double along = 10 * (i + 0.5) / 30 - 10;
            scene_point(&scene,
                        vec3_make(upright ? 0.004 : along, upright ? along : 0.004,
                                  i % 4   ? 5
                                  : i % 8 ? 4.6
                                          : 5.4),
                        3);
        }
        if (view_depth(&r.depth, r.neighbours, &r.neighbour_count, &scene.set, 0, &source, &params, &err))
            fail_msg("%s", err.text);
        assert_true(r.depth.width == width && r.depth.height == height);
        assert_true(r.depth.segment_count > 20000 * 16 / 200);
        int good = 0;
        for (int i = 0; i < width * height; i++) {
            assert_true(isfinite(r.depth.interior.z[i]) && r.depth.interior.z[i] > 0);
            good += fabsf(r.depth.interior.z[i] / 5 - 1) < 0.02f;
        }
        struct rusage used;
        assert_int_equal(getrusage(RUSAGE_SELF, &used), 0);
        if (getenv("VERDICT"))
            print_message("  %.4f of the strip, in %.1f s, with %ld MiB\n", good / 320000.0,
                          (double)(clock() - began) / CLOCKS_PER_SEC, used.ru_maxrss / 1024);
        assert_true(good > 0.97 * width * height);
#ifndef __SANITIZE_ADDRESS__
        assert_true((double)(clock() - began) / CLOCKS_PER_SEC < 30 && used.ru_maxrss / 1024 < 300);
#endif
        layered_depth_release(&r.depth);
    }
}

/* -------------------------------------------------------------------------------------------------------------
 * rounds */

/* The fraction of pixels, depth edges included, whose depth is off by more than so many steps; of all pixels or of
 * those that another view sees. */
static double wrong(const struct layered_depth *d, double steps, bool all)
{
    int bad = 0, count = 0;
    for (int i = 0; i < W * H; i++) {
        int at;
        const double u = i % W + 0.5, v = i / W + 0.5, z = scene_depth(&scene, &scene.views[0], u, v, &at);
        if (!all && !scene_seen_elsewhere(&scene, u, v)) continue;
        bad += !(fabs(1 / (double)d->interior.z[i] - 1 / z) <= steps / (FOCAL * 0.4));
        count++;
    }
    if (getenv("VERDICT")) print_message("  wrong by %g: %.4f of %d\n", steps, bad / (double)count, count);
    return bad / (double)count;
}

/* A fourth of the pixels of the card's rim, as a fraction of all. */
static const double rim = 0.003;

/* A card in front of a wall; several views or two, with and without points, facing or slanted. */
static void two_planes_are_right_in_every_round_but_for_a_rim(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        struct layered_depth d[3];
        start();
        scene_wall(&scene, 0, 0, 7, 12, 12, k & 4 ? 0.3 : 0)->cell = 0.35;
        struct painted_surface *card = scene_wall(&scene, 0.1, 0.1, 4, 0.8, 0.7, k & 4 ? -0.3 : 0);
        card->colour[0] = 0.12f;
        card->cell = 0.2;
        place_cameras(k & 2 ? 2 : 3);
        scene_points(&scene, k & 1 ? 200 : 0);
        must_work_in_rounds(d, 2, &params);
        for (int round = 0; round < 3; round++) {
            assert_true(wrong(&d[round], 0.5, false) <= rim);
            assert_true(wrong(&d[round], 2, true) <= rim);
        }
        for (int round = 0; round < 3; round++) layered_depth_release(&d[round]);
    }
}

static void thread_counts_give_the_same_bits_in_a_second_round(void **state)
{
    (void)state;
    struct layered_depth d[2][2];
    start();
    scene_wall(&scene, 0, 0, 7, 12, 12, 0.2);
    scene_surface(&scene, vec3_make(0.1, 0, 5))->radius = 1;
    place_cameras(3);
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(k + 1);
        must_work_in_rounds(d[k], 1, &params);
    }
    parallel_set_threads(1);
    const struct layered_depth *a = &d[0][1], *b = &d[1][1];
    assert_int_equal(a->segment_count, b->segment_count);
    assert_memory_equal(a->segments, b->segments, (size_t)a->segment_count * sizeof *a->segments);
    assert_memory_equal(a->interior.z, b->interior.z, sizeof(float) * W * H);
    assert_memory_equal(a->boundary.rgba, b->boundary.rgba, sizeof(float) * 4 * W * H);
    for (int k = 0; k < 4; k++) layered_depth_release(&d[k / 2][k % 2]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_textureless_wall_closes_the_room),
        cmocka_unit_test(wallpaper_gets_the_depth_of_its_frame),
        cmocka_unit_test(a_highlight_on_a_glossy_floor_changes_only_its_own_pixels),
        cmocka_unit_test(a_floor_is_found_unless_it_is_a_mirror),
        cmocka_unit_test(a_reflection_beside_an_edge_does_not_hide_behind_its_wall),
        cmocka_unit_test(a_view_without_neighbours_is_an_error),
        cmocka_unit_test(a_nan_in_a_view_is_an_error_with_its_pixel),
        cmocka_unit_test(a_previous_round_of_another_picture_is_an_error),
        cmocka_unit_test(unmatched_parts_inherit_depth_and_are_counted),
        cmocka_unit_test(masked_pixels_have_no_depth_and_are_counted),
        cmocka_unit_test(photos_of_one_pixel_work_in_rounds),
        cmocka_unit_test(a_dynamic_range_of_a_million_to_one_is_matched),
        cmocka_unit_test(an_overexposed_window_has_low_confidence_and_its_wall_is_found),
        cmocka_unit_test(an_extremely_long_photo_works),
        cmocka_unit_test(two_planes_are_right_in_every_round_but_for_a_rim),
        cmocka_unit_test(thread_counts_give_the_same_bits_in_a_second_round),
    };
    parallel_set_threads(1); /* tests run in parallel */
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
