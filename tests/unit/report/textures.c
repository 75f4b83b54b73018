/* textures.c - pictures of a box room whose texture is known: each face looked up, sources in colours, the page. */
#include "stages/report/texture_pictures.h"

#include "tests/unit/report/scratch_page.h"
#include "tests/unit/scratch.h"

#include "common/base/outfile.h"
#include "common/image/false_colour.h"
#include "stages/report/page.h"

enum { WIDTH = 60, HEIGHT = 40, FACES = 6, TEXELS_A_UNIT = 8 };
static const double SIZE[3] = {4, 3, 2.5}; /* of the room, whose corner is the model's origin */
static const struct provenance prov = {.stage = "test", .version = "0"};

/* ------------------------------------------------------------------------------------------------------ a box room */

static double coordinate(struct vec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/* The texture: affine in space, so that look-ups between texels are exact. */
static void colour_at(struct vec3 p, float rgb[3])
{
    for (int c = 0; c < 3; c++) rgb[c] = (float)(0.1 + 0.15 * coordinate(p, c));
}

/* Faces 1, 2: x is least, greatest; 3, 4: y; 5, 6: z. `from` is inside the room. */
static int hit_face(struct vec3 from, struct vec3 direction, double *t)
{
    int face = 0;
    *t = INFINITY;
    for (int f = 0; f < FACES; f++) {
        const int axis = f / 2;
        const double d = coordinate(direction, axis), wall = f % 2 ? SIZE[axis] : 0;
        const double at = (wall - coordinate(from, axis)) / d;
        if ((f % 2 ? d > 0 : d < 0) && at < *t) *t = at, face = f + 1;
    }
    return face;
}

/* An orthogonal tile for each face, with a margin of one texel: page pixel = TEXELS_A_UNIT * coordinate + margin. */
static void make_room(struct atlas *a)
{
    struct err err = ERR_INIT;
    *a = (struct atlas){.tiles = calloc(FACES, sizeof *a->tiles), .tile_count = FACES};
    assert_non_null(a->tiles);
    for (int f = 0; f < FACES; f++) {
        const int u = f / 2 == 0 ? 1 : 0, v = f / 2 == 2 ? 1 : 2;
        a->tiles[f] = (struct atlas_tile){.face = f + 1,
                                          .view = -1,
                                          .width = 2 + (int)(SIZE[u] * TEXELS_A_UNIT),
                                          .height = 2 + (int)(SIZE[v] * TEXELS_A_UNIT)};
    }
    assert_ok(atlas_pack(a, &err), err);
    assert_int_equal(a->page_count, 1);
    for (int f = 0; f < FACES; f++) {
        struct atlas_tile *t = &a->tiles[f];
        t->matrix[0][f / 2 == 0 ? 1 : 0] = t->matrix[1][f / 2 == 2 ? 1 : 2] = TEXELS_A_UNIT;
        t->matrix[0][3] = t->x + 1;
        t->matrix[1][3] = t->y + 1;
        t->matrix[2][3] = 1;
    }
}

/* Fills the page. sources[f]: of the texels of face f + 1. */
static void paint_room(struct atlas_page *p, const struct atlas *a, const uint32_t sources[FACES])
{
    struct err err = ERR_INIT;
    assert_ok(atlas_page_init(p, a->page_sizes[0][0], a->page_sizes[0][1], &err), err);
    for (int f = 0; f < FACES; f++) {
        const struct atlas_tile *t = &a->tiles[f];
        for (int y = 0; y < t->height; y++)
            for (int x = 0; x < t->width; x++) {
                const size_t at = (size_t)(t->y + y) * (size_t)p->width + (size_t)(t->x + x);
                const double u = (x - 0.5) / TEXELS_A_UNIT, v = (y - 0.5) / TEXELS_A_UNIT;
                const double w = f % 2 ? SIZE[f / 2] : 0;
                const struct vec3 place = f / 2 == 0   ? vec3_make(w, u, v)
                                          : f / 2 == 1 ? vec3_make(u, w, v)
                                                       : vec3_make(u, v, w);
                p->source[at] = sources[f];
                if (sources[f] != ATLAS_NONE) colour_at(place, p->rgb + 3 * at);
            }
    }
}

/* A scene of half the size, turned about z and moved. */
static struct model_axes turned_axes(void)
{
    return (struct model_axes){.rotation = {cos(0.3), 0, 0, sin(0.3)},
                               .translation = {0.5, -0.25, 1},
                               .scale = 2,
                               .metric = true,
                               .ceiling = 2.5};
}

/* A camera in the room's middle; its axis is along (1, 0.7, -0.05) in the model's frame. It shows faces 2, 4, 5 and
 * 6. */
static struct view room_view(const struct model_axes *axes)
{
    struct view v = {.name = "a", .width = WIDTH, .height = HEIGHT, .fx = 20, .fy = 20, .cx = 30, .cy = 20};
    const struct vec3 z = vec3_normalize(vec3_make(1, 0.7, -0.05)), x = vec3_normalize(vec3_make(0.7, -1, 0));
    const struct vec3 rows[3] = {world_from_model_direction(axes, x),
                                 world_from_model_direction(axes, vec3_cross(z, x)),
                                 world_from_model_direction(axes, z)};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) v.cam_from_world.m[i][k] = coordinate(rows[i], k);
    v.center = world_from_model_point(axes, vec3_make(2, 1.5, 1.25));
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
    return v;
}

/* What the view shows at a pixel: the face, and its point in the model's frame. */
static int seen_face(const struct view *view, const struct model_axes *axes, int x, int y, struct vec3 *point)
{
    double t;
    const struct vec3 from = model_from_world_point(axes, view->center);
    const struct vec3 at = model_from_world_point(axes, view_unproject(view, x + 0.5, y + 0.5, 1));
    const int face = hit_face(from, vec3_sub(at, from), &t);
    *point = vec3_add(from, vec3_scale(vec3_sub(at, from), t));
    return face;
}

/* Writes the view's ids; pixels of the first row show no face. */
static void write_ids(const char *name, const struct view *view, const struct model_axes *axes)
{
    struct exr_image im = {0};
    struct err err = ERR_INIT;
    assert_ok(exr_image_init(&im, WIDTH, HEIGHT, &err), err);
    assert_ok(exr_add_plane(&im, "id", EXR_UINT, NULL, &err), err);
    assert_ok(exr_add_plane(&im, "Z", EXR_FLOAT, NULL, &err), err);
    for (int y = 1; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            struct vec3 point;
            double u, v;
            const size_t at = (size_t)y * WIDTH + (size_t)x;
            im.planes[0].u[at] = (uint32_t)seen_face(view, axes, x, y, &point);
            im.planes[1].f[at] = (float)view_project(view, world_from_model_point(axes, point), &u, &v);
        }
    assert_ok(exr_write(&im, scratch_path(name), &prov, &err), err);
    exr_image_release(&im);
}

static void make_sight(struct sight *s, const struct atlas *a, const struct atlas_page *p, int orientation)
{
    const struct model_axes axes = turned_axes();
    const struct view view = room_view(&axes);
    struct err err = ERR_INIT;
    write_ids("a.exr", &view, &axes);
    assert_ok(texture_sight_make(s, a, &view, &axes, scratch_path("a.exr"), orientation, 1000, &err), err);
    texture_sight_add_page(s, a, p, 0);
}

static const unsigned char *pixel_of(const struct picture *p, int x, int y)
{
    return p->rgb + 3 * ((size_t)y * (size_t)p->width + (size_t)x);
}

/* -------------------------------------------------------------------------------------------------------- pictures */

static void each_pixel_shows_the_texel_of_its_point(void **state)
{
    (void)state;
    static const uint32_t SOURCES[FACES] = {3, 3, 3, 3, 3, 3};
    const struct model_axes axes = turned_axes();
    const struct view view = room_view(&axes);
    struct atlas a;
    struct atlas_page page;
    struct sight s;
    struct picture p = {0}, turned = {0};
    struct err err = ERR_INIT;
    int seen[FACES + 1] = {0};
    make_room(&a);
    paint_room(&page, &a, SOURCES);
    make_sight(&s, &a, &page, 1);
    assert_ok(picture_from_sight(&p, &s, &err), err);
    assert_int_equal(p.width, WIDTH);
    assert_int_equal(p.height, HEIGHT);
    for (int y = 1; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            struct vec3 point;
            float rgb[3];
            seen[seen_face(&view, &axes, x, y, &point)]++;
            colour_at(point, rgb);
            for (int c = 0; c < 3; c++) {
                const int wanted = (int)(255 * srgb_from_linear(rgb[c]) + 0.5f), found = pixel_of(&p, x, y)[c];
                if (abs(found - wanted) > 1) fail_msg("pixel (%d, %d): found %d, wanted %d", x, y, found, wanted);
            }
        }
    assert_true(seen[2] > 50 && seen[4] > 50 && seen[5] > 50 && seen[6] > 50);
    for (int x = 0; x < WIDTH; x++) assert_true(pixel_of(&p, x, 0)[0] == 120 || pixel_of(&p, x, 0)[0] == 165);
    texture_sight_release(&s);

    make_sight(&s, &a, &page, 6); /* stored lying on its side */
    assert_ok(picture_from_sight(&turned, &s, &err), err);
    assert_int_equal(turned.width, HEIGHT);
    assert_int_equal(turned.height, WIDTH);
    for (int y = 0; y < WIDTH; y++)
        for (int x = 0; x < HEIGHT - 1; x++) /* its last column shows no face */
            assert_memory_equal(pixel_of(&turned, x, y), pixel_of(&p, y, HEIGHT - 1 - x), 3);
    texture_sight_release(&s);
    texture_sight_release(NULL);
    picture_release(&p);
    picture_release(&turned);
    atlas_page_release(&page);
    atlas_release(&a);
}

static void sources_have_their_colours_and_are_counted(void **state)
{
    (void)state;
    /* of the faces that are seen: 2 is warped, 4 synthesised, 5 original, 6 default */
    static const uint32_t SOURCES[FACES] = {3, 4, 3, ATLAS_SYNTHESISED, 3, ATLAS_DEFAULT};
    static const struct source_colour COLOURS[2] = {{.original = true}, {.rgb = {200, 100, 40}}};
    const struct model_axes axes = turned_axes();
    const struct view view = room_view(&axes);
    struct atlas a;
    struct atlas_page page;
    struct sight s;
    struct picture p = {0};
    struct err err = ERR_INIT;
    long long counts[5] = {0}, seen[FACES + 1] = {0};
    make_room(&a);
    paint_room(&page, &a, SOURCES);
    make_sight(&s, &a, &page, 1);
    assert_ok(picture_from_sources(&p, &s, COLOURS, counts, &err), err);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            struct vec3 point;
            const unsigned char *c = pixel_of(&p, x, y);
            const int face = y ? seen_face(&view, &axes, x, y, &point) : 0;
            seen[face]++;
            if (face == 0) assert_true(!c[0] && !c[1] && !c[2]);
            if (face == 2) assert_true(c[0] > 105 && abs(2 * c[1] - c[0]) <= 2 && abs(5 * c[2] - c[0]) <= 5);
            if (face == 4) assert_true((c[0] == 70 || c[0] == 205) && c[0] == c[1] && c[1] == c[2]);
            if (face == 5) assert_true(c[0] > 70 && c[0] == c[1] && c[1] == c[2]);
            if (face == 6) assert_true(c[0] == 255 && c[1] == 0 && c[2] == 255);
        }
    assert_int_equal(counts[ATLAS_NONE], 0);
    assert_int_equal(counts[ATLAS_SYNTHESISED], seen[4]);
    assert_int_equal(counts[ATLAS_DEFAULT], seen[6]);
    assert_int_equal(counts[ATLAS_VIEWS], seen[5]);
    assert_int_equal(counts[ATLAS_VIEWS + 1], seen[2]);
    texture_sight_release(&s);
    picture_release(&p);
    atlas_page_release(&page);
    atlas_release(&a);
}

static void faces_without_texels_or_tiles_are_hatched_and_counted(void **state)
{
    (void)state;
    static const uint32_t SOURCES[FACES] = {3, ATLAS_NONE, 3, 3, 3, 3};
    static const struct source_colour COLOURS[1] = {{.original = true}};
    const struct model_axes axes = turned_axes();
    const struct view view = room_view(&axes);
    struct atlas a;
    struct atlas_page page;
    struct sight s;
    struct picture p = {0};
    struct err err = ERR_INIT;
    long long counts[4] = {0}, without = 0;
    make_room(&a);
    paint_room(&page, &a, SOURCES);
    a.tile_count = FACES - 1; /* none for the ceiling */
    make_sight(&s, &a, &page, 1);
    assert_ok(picture_from_sight(&p, &s, &err), err);
    for (int y = 1; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            struct vec3 point;
            const int face = seen_face(&view, &axes, x, y, &point);
            if (face != 2 && face != 6) continue;
            const unsigned char *c = pixel_of(&p, x, y);
            assert_true((c[0] == 120 || c[0] == 165) && c[0] == c[1] && c[1] == c[2]);
            without++;
        }
    picture_release(&p);
    assert_ok(picture_from_sources(&p, &s, COLOURS, counts, &err), err);
    assert_int_equal(counts[ATLAS_NONE], without);
    texture_sight_release(&s);
    picture_release(&p);
    atlas_page_release(&page);
    atlas_release(&a);
}

static void ids_of_another_view_are_refused(void **state)
{
    (void)state;
    const struct model_axes axes = turned_axes();
    struct view view = room_view(&axes);
    struct atlas a;
    struct sight s;
    struct err err = ERR_INIT;
    make_room(&a);
    write_ids("a.exr", &view, &axes);
    view.width++;
    assert_int_equal(texture_sight_make(&s, &a, &view, &axes, scratch_path("a.exr"), 1, 100, &err), ST_DATA);
    assert_err(err, ST_DATA, "a.exr has 60 x 40 pixels, but its view 61 x 40");
    assert_null(s.samples);
    atlas_release(&a);
}

static void pages_are_shrunk_over_their_texels_alone(void **state)
{
    (void)state;
    struct atlas_page page;
    struct picture p = {0};
    struct err err = ERR_INIT;
    assert_ok(atlas_page_init(&page, 8, 4, &err), err);
    for (int i = 0; i < 32; i++) {
        if (i % 8 >= 5 || i == 0) continue; /* column 5 and above are empty */
        page.source[i] = ATLAS_VIEWS;
        page.rgb[3 * i] = page.rgb[3 * i + 1] = 1;
    }
    assert_ok(picture_from_atlas_page(&p, &page, 2, &err), err);
    assert_int_equal(p.width, 4);
    assert_int_equal(p.height, 2);
    for (int x = 0; x < 3; x++) /* also where three quarters or a half of the texels exist */
        for (int y = 0; y < 2; y++) assert_memory_equal(pixel_of(&p, x, y), ((unsigned char[3]){255, 255, 0}), 3);
    assert_true(pixel_of(&p, 3, 0)[0] == 120 || pixel_of(&p, 3, 0)[0] == 165);
    picture_release(&p);
    atlas_page_release(&page);
}

static void category_colours_differ(void **state)
{
    (void)state;
    unsigned char rgb[24][3];
    for (int i = 0; i < 24; i++) {
        colour_of_category(i, rgb[i]);
        const int most = rgb[i][0] > rgb[i][1] ? rgb[i][0] : rgb[i][1], all = most > rgb[i][2] ? most : rgb[i][2];
        const int few = rgb[i][0] < rgb[i][1] ? rgb[i][0] : rgb[i][1], least = few < rgb[i][2] ? few : rgb[i][2];
        if (all - least < 60) fail_msg("colour %d is grey: %d %d %d", i, rgb[i][0], rgb[i][1], rgb[i][2]);
        for (int k = 0; k < i; k++) {
            int sum = 0;
            for (int c = 0; c < 3; c++) sum += abs(rgb[i][c] - rgb[k][c]);
            if (sum < (i - k < 8 ? 40 : 6)) fail_msg("colours %d and %d differ by %d only", k, i, sum);
        }
    }
}

/* -------------------------------------------------------------------------------------------------------- the page */

/* The page of the scratch folder; the caller frees it. */
static char *page_of(void) { return scratch_page("room", "report"); }

static int count_of(const char *page, const char *text)
{
    int count = 0;
    for (const char *at = page; (at = strstr(at, text)); at++) count++;
    return count;
}

/* Views p00, p01, ... of one camera, with pictures and ids. */
static void write_views(int count)
{
    static const float GREY[4 * WIDTH * HEIGHT];
    const struct model_axes axes = turned_axes();
    const struct view view = room_view(&axes);
    const struct quat q = quat_from_mat3(view.cam_from_world);
    struct err err = ERR_INIT;
    assert_ok(outfile_make_folders(scratch_path("views"), &err), err);
    assert_ok(outfile_make_folders(scratch_path("ids"), &err), err);
    assert_ok(model_axes_write(&axes, scratch_path("model/axes.txt"), NULL, &err), err);
    scratch_write("views/cameras.txt", "1 PINHOLE 60 40 20 20 30 20\n");
    scratch_write("views/points3D.txt", "");
    FILE *to = fopen(scratch_path("views/images.txt"), "w");
    FILE *lenses = fopen(scratch_path("views/lenses.txt"), "w");
    assert_true(to && lenses);
    fprintf(lenses, "remodel-lenses 1\n");
    for (int i = 0; i < count; i++) {
        char name[32];
        struct exr_image im = {0};
        fprintf(to, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g 1 p%02d.exr\n\n", i + 1, q.w, q.x, q.y, q.z,
                view.translation.x, view.translation.y, view.translation.z, i);
        fprintf(lenses, "p%02d p%02d PINHOLE 60 40 20 20 30 20 turn 1 0 0 0\n", i, i);
        snprintf(name, sizeof name, "ids/p%02d.exr", i);
        write_ids(name, &view, &axes);
        snprintf(name, sizeof name, "views/p%02d.exr", i);
        assert_ok(exr_init_rgba(&im, GREY, WIDTH, HEIGHT, &err), err);
        assert_ok(exr_write(&im, scratch_path(name), &prov, &err), err);
        exr_image_release(&im);
    }
    fclose(to);
    fclose(lenses);
}

/* Writes the room's atlas: of the photo, with these views; photo NULL: the VITA. Face 2 comes from p01. */
static void write_room(const char *photo, char **views, int view_count)
{
    static const uint32_t SOURCES[FACES] = {3, 4, 3, ATLAS_SYNTHESISED, 3, ATLAS_DEFAULT};
    char p0[] = "p00", p1[] = "p01", folder[64];
    char *sources[2] = {p0, p1};
    struct atlas a;
    struct atlas_page page;
    struct err err = ERR_INIT;
    make_room(&a);
    paint_room(&page, &a, SOURCES);
    struct atlas all = a;
    all.viewpoint = (char *)photo;
    all.views = views;
    all.view_count = view_count;
    all.sources = sources;
    all.source_count = 2;
    for (int i = 0; photo && i < FACES; i++) all.tiles[i].view = 0;
    snprintf(folder, sizeof folder, photo ? "vdta/%s" : "vita", photo);
    assert_ok(atlas_write(&all, &page, scratch_path(folder), &prov, &err), err);
    atlas_page_release(&page);
    atlas_release(&a);
}

static void the_page_shows_each_viewpoint_and_the_vita(void **state)
{
    (void)state;
    char p0[] = "p00", p1[] = "p01";
    char *one[1] = {p0}, *two[2] = {p0, p1};
    write_views(2);
    char *page = page_of();
    assert_lacks(page, "id=\"textures\"");
    assert_lacks(page, "atlas");
    free(page);

    write_room("p00", one, 1);
    write_room("two", two, 2);
    write_room(NULL, NULL, 0);
    page = page_of();
    assert_contains(page, "<a href=\"#textures\">Textures</a>");
    assert_int_equal(count_of(page, "alt=\"Texture in view p00\""), 4); /* of both, and twice in the VITA */
    assert_int_equal(count_of(page, "alt=\"Sources of the texture in view p01\""), 1);
    assert_int_equal(count_of(page, "style=\"--n:3\""), 2);
    assert_int_equal(count_of(page, "style=\"--n:2\""), 1); /* side by side */
    assert_contains(page, "<a href=\"../vdta/p00/page0.exr\"><img");
    assert_contains(page, "<a href=\"../vita/page0.exr\"><img");
    assert_contains(page, "warped from 1 view, ");
    assert_contains(page, "6 tiles on 1 page.");
    assert_lacks(page, "more viewpoint");
    assert_lacks(page, "is not shown");
    assert_lacks(page, "nan");
    free(page);
}

static void at_most_twelve_viewpoints_are_shown(void **state)
{
    (void)state;
    char p0[] = "p00";
    char *one[1] = {p0};
    write_views(1);
    for (int i = 0; i < 14; i++) {
        char photo[32];
        snprintf(photo, sizeof photo, "photo%02d", i);
        write_room(photo, one, 1);
    }
    char *page = page_of();
    assert_int_equal(count_of(page, "alt=\"Photograph of view p00\""), 12);
    assert_contains(page, "<h3>photo00</h3>");
    assert_contains(page, "2 more viewpoints have atlases that are not shown.");
    free(page);
}

static void an_atlas_that_cannot_be_read_is_named(void **state)
{
    (void)state;
    char p0[] = "p00", no[] = "nowhere";
    char *one[1] = {p0}, *other[1] = {no};
    struct err err = ERR_INIT;
    write_views(1);
    write_room("good", one, 1);
    write_room("no-view", other, 1);
    assert_ok(outfile_make_folders(scratch_path("vdta/bad"), &err), err);
    scratch_write("vdta/bad/atlas.txt", "remodel-atlas 1\ntile 1\n");
    char *page = page_of();
    assert_int_equal(count_of(page, "alt=\"Texture in view p00\""), 1);
    assert_contains(page, "vdta/bad is not shown.");
    assert_contains(page, "vdta/no-view is not shown. There is no view nowhere");
    free(page);
    assert_int_equal(remove(scratch_path("model/axes.txt")), 0);
    page = page_of();
    assert_lacks(page, "id=\"textures\"");
    assert_contains(page, "The texture atlases are not shown.");
    free(page);
}

static void an_edit_has_pictures_of_six_photographs(void **state)
{
    (void)state;
    static const unsigned char GREY[3];
    static const char *const FOLDERS[2] = {"model", "remodel/door"};
    struct err err = ERR_INIT;
    for (int i = 0; i < 2; i++) {
        char path[64];
        snprintf(path, sizeof path, "%s/overlay", FOLDERS[i]);
        assert_ok(outfile_make_folders(scratch_path(path), &err), err);
        snprintf(path, sizeof path, "%s/model.txt", FOLDERS[i]);
        scratch_write(path, "remodel-model 1\n");
        for (int k = 0; k < 13; k++) {
            snprintf(path, sizeof path, "%s/overlay/IMG_%02d.jpg", FOLDERS[i], k);
            assert_ok(jpeg_write(scratch_path(path), GREY, 1, 1, 90, &err), err);
        }
    }
    char *page = page_of();
    assert_int_equal(count_of(page, "alt=\"edges of the model"), 13 + 6);
    assert_int_equal(count_of(page, "alt=\"edges of the model IMG_00\""), 2);
    assert_int_equal(count_of(page, "alt=\"edges of the model IMG_10\""), 2);
    assert_int_equal(count_of(page, "alt=\"edges of the model IMG_12\""), 1);
    assert_contains(page, "7 more photographs are in the folder remodel/door/overlay.");
    free(page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(each_pixel_shows_the_texel_of_its_point, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(sources_have_their_colours_and_are_counted, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(faces_without_texels_or_tiles_are_hatched_and_counted, scratch_make,
                                        scratch_remove),
        cmocka_unit_test_setup_teardown(ids_of_another_view_are_refused, scratch_make, scratch_remove),
        cmocka_unit_test(pages_are_shrunk_over_their_texels_alone),
        cmocka_unit_test(category_colours_differ),
        cmocka_unit_test_setup_teardown(the_page_shows_each_viewpoint_and_the_vita, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(at_most_twelve_viewpoints_are_shown, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(an_atlas_that_cannot_be_read_is_named, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(an_edit_has_pictures_of_six_photographs, scratch_make, scratch_remove),
    };
    return cmocka_run_group_tests_name("textures", tests, NULL, NULL);
}
