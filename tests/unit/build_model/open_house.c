/* open_house.c - walls of a real house by lines at the floor, for developers who have ../shared/data/zind-open: its
 * cameras and its walls are known. Pixels are the true ones of the layout with an error of 2 px, as clicks have. */
#include "tests/unit/build_model/scripted.h"

#include "common/base/rng.h"
#include "common/math/numbers.h"
#include "stages/build_model/place/place.h"

#define HOUSE "../shared/data/zind-open/"
#define CLICK 2.0 /* px */

enum { MAX_WALLS = 64, MAX_VIEWS = 200, STEPS = 200, CHOSEN = 5 };

struct segment {
    double a[2], b[2];
};

static struct house {
    struct sfm_model model;
    struct view views[MAX_VIEWS];
    struct lens lenses[MAX_VIEWS];
    struct camera_set set;
    struct lens_list list;
    struct placer placer;
    struct segment walls[MAX_WALLS]; /* the outline, then the partition that it lacks */
    int wall_count, outline_count;
} house;

static const struct model_params params = MODEL_PARAMS_DEFAULT;
static const struct model_axes axes = {.rotation = {1, 0, 0, 0}, .scale = 1, .metric = true, .ceiling = 2.3};
static const struct camera_set no_views = {0};
static const struct lens_list no_lenses = {0};

/* The first outline of the layout: all rooms have the same. */
static void read_outline(void)
{
    char *text = scratch_read(HOUSE "layout.json"), *at = strstr(text, "\"walls\""), *end;
    double p[MAX_WALLS][2];
    int count = 0;
    assert_non_null(at);
    at = strchr(at, '[') + 1;
    for (;; count++) {
        at += strspn(at, " \t\n,");
        if (*at != '[' || count == MAX_WALLS) break;
        p[count][0] = strtod(at + 1, &end);
        p[count][1] = strtod(end + strspn(end, " \t\n,"), &end);
        at = strchr(end, ']') + 1;
    }
    assert_true(count > 4);
    for (int i = 0; i < count; i++) {
        const double *a = p[i], *b = p[(i + 1) % count];
        house.walls[i] = (struct segment){{a[0], a[1]}, {b[0], b[1]}};
    }
    house.outline_count = house.wall_count = count;
    free(text);
}

/* The wall between kitchen and living room is in the README alone: "x A to B, y C to D and x A to B, y C to D". */
static void read_partition(void)
{
    char *text = scratch_read(HOUSE "README.md"), *at = strstr(text, "missing in the merged outline: ");
    double x[2][2], y[2][2];
    assert_non_null(at);
    assert_int_equal(sscanf(at,
                            "missing in the merged outline: x %lf to %lf, y %lf to %lf and x %lf to %lf, y %lf to %lf",
                            &x[0][0], &x[0][1], &y[0][0], &y[0][1], &x[1][0], &x[1][1], &y[1][0], &y[1][1]),
                     8);
    for (int k = 0; k < 2; k++) {
        const double c[4][2] = {{x[k][0], y[k][0]}, {x[k][1], y[k][0]}, {x[k][1], y[k][1]}, {x[k][0], y[k][1]}};
        for (int i = 0; i < 4; i++) {
            const double *a = c[i], *b = c[(i + 1) % 4];
            house.walls[house.wall_count++] = (struct segment){{a[0], a[1]}, {b[0], b[1]}};
        }
    }
    free(text);
}

static int start(void **state)
{
    struct err err = ERR_INIT;
    FILE *there = fopen(HOUSE "layout.json", "r");
    if (!there) return scratch_make(state);
    fclose(there);
    read_outline();
    read_partition();
    assert_ok(sfm_model_read_cameras(&house.model, HOUSE "truth", NULL, &err), err);
    const int count = house.model.image_count;
    assert_true(count > 10 && count <= MAX_VIEWS);
    for (int i = 0; i < count; i++) {
        const struct sfm_image *im = &house.model.images[i];
        const struct camera *lens = &house.model.cameras[im->camera_idx].camera;
        struct view *v = &house.views[i];
        *v = (struct view){.name = im->name, .width = lens->width, .height = lens->height};
        camera_focal(lens, &v->fx, &v->fy, &v->cx, &v->cy);
        v->cam_from_world = mat3_from_quat(im->cam_from_world.rotation);
        v->translation = im->cam_from_world.translation;
        v->center = pose_center(&im->cam_from_world);
        house.lenses[i] = (struct lens){im->name, im->name, *lens, {1, 0, 0, 0}};
    }
    house.set = (struct camera_set){.views = house.views, .view_count = count};
    house.list = (struct lens_list){house.lenses, count};
    const struct placer_views known[2] = {{&house.set, &house.list}, {&no_views, &no_lenses}};
    return scratch_make(state) || place_init(&house.placer, known, &axes, NULL, &params, &err);
}

static int stop(void **state)
{
    place_release(&house.placer);
    sfm_model_release(&house.model);
    return scratch_remove(state);
}

static double cross(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static bool hidden(const double camera[2], const double p[2], int wall)
{
    for (int i = 0; i < house.wall_count; i++) {
        const struct segment *s = &house.walls[i];
        if (i != wall && cross(camera, p, s->a) * cross(camera, p, s->b) < 0 &&
            cross(s->a, s->b, camera) * cross(s->a, s->b, p) < 0)
            return true;
    }
    return false;
}

/* The pixel of a place on the floor; false: it is near the border of the picture, or outside. */
static bool is_in_picture(const struct photo_camera *c, const double p[2], double *u, double *v)
{
    const struct vec3 at = vec3_make(p[0], p[1], 0);
    return mat3_apply(c->cam_from_world, vec3_sub(at, c->center)).z > 0 && photo_camera_project(c, at, u, v) &&
           *u > 8 && *v > 8 && *u < c->lens.width - 8 && *v < c->lens.height - 8;
}

/* The longest part of a wall's foot that a photo shows, as pixels; its length in px. */
static double visible_foot(double pixels[4], int photo, int wall)
{
    const struct photo_camera *c = &house.placer.photos[photo].camera;
    const struct segment *s = &house.walls[wall];
    const double camera[2] = {c->center.x, c->center.y};
    double run[4] = {0}, longest = 0;
    bool in_run = false;
    for (int i = 0; i <= STEPS; i++) {
        const double t = 0.02 + 0.96 * i / STEPS;
        const double p[2] = {s->a[0] + t * (s->b[0] - s->a[0]), s->a[1] + t * (s->b[1] - s->a[1])};
        double u, v;
        const bool seen = is_in_picture(c, p, &u, &v) && !hidden(camera, p, wall);
        if (seen && !in_run) run[0] = u, run[1] = v;
        if (seen) run[2] = u, run[3] = v;
        in_run = seen;
        if (seen && hypot(run[2] - run[0], run[3] - run[1]) > longest) {
            longest = hypot(run[2] - run[0], run[3] - run[1]);
            memcpy(pixels, run, sizeof run);
        }
    }
    return longest;
}

static double normal(const struct rng *rng, uint64_t i, uint64_t k)
{
    return sqrt(-2 * log(1 - rng_uniform(rng, i, 2 * k))) * cos(2 * PI * rng_uniform(rng, i, 2 * k + 1));
}

static double length_of(const struct segment *s) { return hypot(s->b[0] - s->a[0], s->b[1] - s->a[1]); }

/* The five longest walls, each in the photo that shows the longest piece of its foot. */
static void five_walls_lie_within_clicks_of_the_layout(void **state)
{
    const struct rng rng = rng_make(3, "open_house", "clicks");
    bool used[MAX_WALLS] = {false};
    (void)state;
    if (!house.wall_count) {
        print_message(HOUSE " does not exist: skipped\n");
        skip();
    }
    for (int n = 0; n < CHOSEN; n++) {
        struct script script = {0};
        struct plan plan;
        struct err err = ERR_INIT;
        double pixels[4] = {0}, best[4], longest = 0;
        int wall = -1, photo = 0;
        char text[400];
        for (int i = 0; i < house.outline_count; i++)
            if (!used[i] && (wall < 0 || length_of(&house.walls[i]) > length_of(&house.walls[wall]))) wall = i;
        used[wall] = true;
        for (int k = 0; k < house.placer.photo_count; k++) {
            const double length = visible_foot(pixels, k, wall);
            if (!(length > longest)) continue;
            longest = length;
            photo = k;
            memcpy(best, pixels, sizeof best);
        }
        for (int k = 0; k < 4; k++) best[k] += CLICK * normal(&rng, (uint64_t)wall, (uint64_t)k);
        snprintf(text, sizeof text, "remodel-script 1\nwall w foot in %s %.9g %.9g %.9g %.9g\n",
                 house.placer.photos[photo].id, best[0], best[1], best[2], best[3]);
        plan_begin(&plan, &axes);
        assert_ok(script_read(&script, scratch_write("model.txt", text), &err), err);
        assert_ok(plan_apply(&plan, &script, false, &house.placer, &err), err);
        const struct segment *s = &house.walls[wall];
        const struct plan_line in = plan_wall_face(&plan.walls[0], SIDE_IN);
        const double off = in.n[0] * 0.5 * (s->a[0] + s->b[0]) + in.n[1] * 0.5 * (s->a[1] + s->b[1]) - in.c;
        print_message("wall of %.1f m in %s: %.1f cm off\n", length_of(s), house.placer.photos[photo].id,
                      100 * fabs(off));
        assert_true(fabs(off) < 0.1);
        script_release(&script);
        plan_release(&plan);
    }
}

/* The photo nearest to a place on the floor that shows it, and its pixel. */
static int nearest_photo(const double p[2], double pixel[2])
{
    double nearest = 1e9;
    int photo = -1;
    for (int k = 0; k < house.placer.photo_count; k++) {
        const struct photo_camera *c = &house.placer.photos[k].camera;
        const double camera[2] = {c->center.x, c->center.y}, distance = hypot(p[0] - camera[0], p[1] - camera[1]);
        const double before[2] = {p[0] + 0.01 * (camera[0] - p[0]), p[1] + 0.01 * (camera[1] - p[1])};
        double u, v;
        if (distance > nearest || !is_in_picture(c, p, &u, &v) || hidden(camera, before, -1)) continue;
        nearest = distance;
        photo = k;
        pixel[0] = u;
        pixel[1] = v;
    }
    return photo;
}

/* The whole outline, with its bay of two angled walls, by its corners; each in the photo that is nearest to it. */
static void a_chain_of_corners_gives_the_whole_outline(void **state)
{
    const struct rng rng = rng_make(4, "open_house", "corners");
    struct script script = {0};
    struct plan plan;
    struct err err = ERR_INIT;
    char text[8000];
    double sum = 0, worst = 0;
    (void)state;
    if (!house.wall_count) skip();
    size_t n = (size_t)snprintf(text, sizeof text, "remodel-script 1\nwalls");
    for (int i = 0; i < house.outline_count; i++) n += (size_t)snprintf(text + n, sizeof text - n, " w%d", i);
    for (int i = 0; i < house.outline_count; i++) {
        double pixel[2];
        const int photo = nearest_photo(house.walls[i].a, pixel);
        assert_true(photo >= 0);
        for (int k = 0; k < 2; k++) pixel[k] += CLICK * normal(&rng, (uint64_t)i, (uint64_t)k);
        n += (size_t)snprintf(text + n, sizeof text - n, " corner in %s %.9g %.9g", house.placer.photos[photo].id,
                              pixel[0], pixel[1]);
    }
    /* thin: a spur of 14 cm is part of the outline */
    snprintf(text + n, sizeof text - n, " closed angled thickness 0.02\n");
    plan_begin(&plan, &axes);
    assert_ok(script_read(&script, scratch_write("model.txt", text), &err), err);
    assert_ok(plan_apply(&plan, &script, false, &house.placer, &err), err);
    for (int i = 0; i < plan.wall_count; i++) {
        const struct segment *s = &house.walls[i];
        const struct plan_line in = plan_wall_face(&plan.walls[i], SIDE_IN);
        const double off = in.n[0] * 0.5 * (s->a[0] + s->b[0]) + in.n[1] * 0.5 * (s->a[1] + s->b[1]) - in.c;
        sum += off * off / plan.wall_count;
        worst = fmax(worst, fabs(off));
    }
    print_message("%d walls: %.1f cm off (RMS), %.1f at most\n", plan.wall_count, 100 * sqrt(sum), 100 * worst);
    assert_true(sqrt(sum) < 0.03 && worst < 0.08);
    script_release(&script);
    plan_release(&plan);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_chain_of_corners_gives_the_whole_outline),
        cmocka_unit_test(five_walls_lie_within_clicks_of_the_layout),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
