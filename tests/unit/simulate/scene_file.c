/* Scene files: their contents, the faces built from them, and error messages. */
#include "tests/unit/simulate/worlds.h"

#include "common/base/param.h"

#define HEAD "remodel-scene 1\ntexture t rgb 0.5 0.5 0.5\nmaterial m lambert t\n"
#define SUN  "sun 0 45 1 5 5 5\n"

/* Reads an invalid scene; the error must contain these words. */
static void assert_invalid(const char *text, const char *words)
{
    struct scene s;
    struct err err = ERR_INIT;
    scratch_write("scene.txt", text);
    if (!scene_read(&s, scratch, "scene.txt", NULL, &err)) fail_msg("no error, expected: %s", words);
    assert_err(err, ST_DATA, words);
    assert_contains(err.text, "scene.txt");
    assert_true(!s.items && !s.textures);
}

static void errors_name_line_found_and_expected_word(void **state)
{
    (void)state;
    assert_invalid("", "is empty");
    assert_invalid("remodel-scene 3\n", ":1: found \"3\"");
    assert_invalid("scene\n", ":1: found \"scene\", wanted remodel-scene");
    assert_invalid(HEAD "wal a 0 0 1 0 0 1 0.1 m\n", ":4: found \"wal\", wanted a line of a scene: one of texture");
    assert_invalid(HEAD "texture t rgb 1 1 1\n", ":4: found \"t\", wanted a name that no other texture");
    assert_invalid(HEAD "texture u rgb 1 1 2\n", ":4: found \"2\", wanted a colour from 0 to 1");
    assert_invalid(HEAD "texture u wood 0 1 1 1 1 0 0 0\n", "wanted a scale");
    assert_invalid(HEAD "texture u plaster 0.1 2 1 1 1 1\n", "wanted an amount, a number from 0 to 1");
    assert_invalid(HEAD "texture u brick 0.2 0.1 0.3 1 1 1 1 0 0 0\n", "the width of the mortar");
    assert_invalid(HEAD "texture u print 1 0.5\n", ":4: found the end of the line, wanted a height");
    assert_invalid(HEAD "texture u rgb 1 1 1 1\n", "wanted the end of the line");
    assert_invalid(HEAD "texture a.b rgb 1 1 1\n", "letters, digits, _ and -");
    assert_invalid(HEAD "material n lambert tt\n", "did you mean t");
    assert_invalid(HEAD "material n phong t 1 10\n",
                   ":4: found \"albedo up to 0.5 and gloss of 0.571\", wanted no more than 1");
    assert_invalid(HEAD "material n ward t 0.6 0.2\n", "wanted no more than 1 together");
    assert_invalid(HEAD "material n ward t 0.1 0\n", "a roughness");
    assert_invalid(HEAD "box b 0 0 0 1 1 0 m\n", ":4: found \"0\", wanted Z1, larger than Z0");
    assert_invalid(HEAD "box b 0 0 0 1 1 1 m turn\n", "an angle in degrees");
    assert_invalid(HEAD "box b 0 0 0 1 1 1 mm\n", "wanted the name of a material above; did you mean m");
    assert_invalid(HEAD "quad q 0 0 0 1 0 0 2 0 0 m\n", "two edges that span");
    assert_invalid(HEAD "quad q 0 0 nan 1 0 0 0 1 0 m\n", "found \"nan\"");
    assert_invalid(HEAD "wall w 1 1 1 1 0 2 0.1 m\n", "a wall with a length");
    assert_invalid(HEAD "wall w 0 0 4 0 0 2 0.1 m\nopening o w 3 5 0 1\n", ":5: found \"3 to 5 m along");
    assert_invalid(HEAD "wall w 0 0 4 0 0 2 0.1 m\nopening o w 1 2 0 1\nwindow x w 1.5 3 0.5 1\n",
                   ":6: found \"x\", wanted an opening that does not overlap o");
    assert_invalid(HEAD "box w 0 0 0 1 1 1 m\nopening o w 0 1 0 1\n", ":5: found \"w\", wanted the name of a wall");
    assert_invalid(HEAD "opening o ww 0 1 0 1\n", "the name of a wall above");
    assert_invalid(HEAD "lamp l quad 0 0 0 1 0 0 1 1 0 1 1 1\n", "right angle");
    assert_invalid(HEAD "lamp l ball 0 0 0 1\n", "one of quad, disk");
    assert_invalid(HEAD "lamp l disk 0 0 0 0 0 0 1 1 1 1 30\n", "found \"0 0 0\", wanted a direction");
    assert_invalid(HEAD SUN SUN, ":5: found \"a second sun\"");
    assert_invalid(HEAD "mesh x ../a.obj m\n", "without a folder");
    assert_invalid(HEAD SUN, "has no surfaces");
    assert_invalid(HEAD "glow m 1 2\n", ":4: found the end of the line, wanted a radiance");
}

static void a_scene_without_light_is_rejected(void **state)
{
    (void)state;
    assert_invalid(HEAD "box b 0 0 0 1 1 1 m\n", "has no light: every photo would be black; add a lamp");
    assert_invalid(HEAD "box b 0 0 0 1 1 1 m\nlamp l quad 0 0 0 1 0 0 0 1 0 0 0 0\nglow m 0 0 0\n", "has no light");
}

static void a_mesh_that_is_not_whole_is_rejected(void **state)
{
    (void)state;
    scratch_write("broken.obj", "v 0 0\n");
    assert_invalid(HEAD "mesh x broken.obj m\n", "scene.txt:4: ");
}

static int find_face(const struct scene_geometry *g, const char *name)
{
    for (int i = 0; i < g->face_count; i++)
        if (!strcmp(g->faces[i].name, name)) return i;
    fail_msg("no face %s", name);
    return -1;
}

static void check_face(const struct scene_geometry *g, const char *name, int id, double area, double x, double y,
                       double z)
{
    const int i = find_face(g, name);
    if (id) assert_int_equal(i + 1, id);
    assert_near(g->faces[i].area, area, 1e-9);
    const struct vec3 n = g->faces[i].normal;
    if (fabs(n.x - x) + fabs(n.y - y) + fabs(n.z - z) > 1e-9)
        fail_msg("the normal of %s is %g %g %g", name, n.x, n.y, n.z);
}

static void faces_have_their_areas_normals_and_ids(void **state)
{
    (void)state;
    scratch_write("tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    struct world w = world_from("texture t rgb 0.5 0.5 0.5\nmaterial m lambert t\n"
                                "room r 0 0 4 3 0 2 m m\nwall w 0 0 4 0 0 2 0.2 m\n"
                                "opening door w 1 2 0 1.5\nwindow win w 2.5 4 0.5 1.5\n"
                                "box b 1 1 0 2 1.5 0.9 m turn 90\nquad q 0 0 1 0 1 0 0 0 2 m\n"
                                "mesh tri tri.obj m at 1 1 1 scale 2\nlamp l disk 2 2 1.9 0 0 -1 0.1 1 1 1 30\n"
                                "lamp s quad 3 2 1.9 0 1 0 1 0 0 1 1 1\n");
    const struct scene_geometry *g = &w.geometry;
    check_face(g, "r.floor", 1, 12, 0, 0, 1);
    check_face(g, "r.ceiling", 2, 12, 0, 0, -1);
    check_face(g, "w.left", 3, 8 - 1.5 - 1.5, 0, 1, 0);
    check_face(g, "w.right", 4, 8 - 1.5 - 1.5, 0, -1, 0);
    check_face(g, "w.begin", 5, 0.4, -1, 0, 0);
    check_face(g, "w.end", 6, 0.4, 1, 0, 0);
    check_face(g, "w.top", 7, 0.8, 0, 0, 1);
    check_face(g, "w.bottom", 8, 0.8, 0, 0, -1);
    check_face(g, "door.begin", 9, 0.3, 1, 0, 0); /* the reveal faces the opening */
    check_face(g, "door.end", 10, 0.3, -1, 0, 0);
    check_face(g, "door.head", 11, 0.2, 0, 0, -1); /* no sill: the opening reaches the wall's lower edge */
    check_face(g, "win.begin", 12, 0.2, 1, 0, 0);
    check_face(g, "win.head", 13, 0.3, 0, 0, -1); /* no end: the window reaches the wall's end */
    check_face(g, "win.sill", 14, 0.3, 0, 0, 1);
    check_face(g, "b.left", 15, 0.45, 0, -1, 0); /* -x turned by 90 degrees */
    check_face(g, "b.top", 20, 0.5, 0, 0, 1);
    check_face(g, "q", 21, 2, 1, 0, 0);
    check_face(g, "tri", 22, 2, 0, 0, 1);
    check_face(g, "l", 23, PI * 0.01, 0, 0, -1);
    check_face(g, "s", 24, 1, 0, 0, -1);

    /* hits: floor, wall, nothing in the window, mesh, round lamp but not the corner of its square */
    const struct {
        struct vec3 from, direction;
        const char *face;
        double t;
    } rays[] = {
        {{0.5, 2.5, 1}, {0, 0, -1}, "r.floor", 1},    {{0.5, 1.2, 1}, {0, -1, 0}, "w.left", 1.1},
        {{3, 1.2, 1}, {0, -1, 0}, NULL, 0},           {{1.5, 1.2, 1.8}, {0, -1, 0}, "w.left", 1.1},
        {{1.1, 1.1, 1.8}, {0, 0, -1}, "tri", 0.8},    {{2.09, 2, 1}, {0, 0, 1}, "l", 0.9},
        {{2.09, 2.09, 1}, {0, 0, 1}, "r.ceiling", 1}, {{1.5, 1.25, 1.8}, {0, 0, -1}, "tri", 0.8},
        {{1.3, 0.5, 0.5}, {0, 1, 0}, "b.left", 0.25},
    };
    for (size_t i = 0; i < sizeof rays / sizeof *rays; i++) {
        struct ray_hit hit;
        const bool met = ray_scene_hit(&g->rays, rays[i].from, rays[i].direction, &hit);
        if (met != (rays[i].face != NULL)) fail_msg("ray %zu", i);
        if (!met) continue;
        assert_string_equal(g->faces[hit.id].name, rays[i].face);
        assert_near(hit.t, rays[i].t, 1e-9);
        assert_true(vec3_dot(hit.normal, rays[i].direction) < 0);
        assert_true(ray_scene_blocked(&g->rays, rays[i].from, rays[i].direction, 1.01 * rays[i].t));
        assert_false(ray_scene_blocked(&g->rays, rays[i].from, rays[i].direction, 0.99 * rays[i].t));
    }
    assert_int_equal(w.lights.count, 2); /* a window is a light only if there is a sky or a sun */
    path_world_release(&w);
    path_world_release(&w);
}

static void textures_stay_below_their_bounds(void **state)
{
    (void)state;
    struct world w = world_from(
        "texture a checker 0.2 0.9 0.9 0.9 0 0 0\ntexture b wood 0.1 3 0.6 0.5 0.4 0.2 0.1 0\n"
        "texture c brick 0.2 0.07 0.01 4 0.7 0.3 0.2 0.6 0.6 0.6\ntexture d plaster 0.3 0.5 5 0.8 0.7 0.6\n"
        "texture e print 6 0.7 0.5\ntexture f books 7 1.5 0.3\nmaterial m lambert a\nbox b 0 0 0 1 1 1 m\n" SUN);
    for (int i = 0; i < w.scene.texture_count; i++) {
        const struct texture *t = &w.scene.textures[i].texture;
        const double bound = texture_bound(t);
        double sum = 0, square = 0;
        for (int k = 0; k < 40000; k++) {
            const struct rgb c = texture_at(t, 5, k % 200 * 0.0137 - 0.7, k / 200 * 0.0091 - 0.9);
            assert_true(c.r >= 0 && c.g >= 0 && c.b >= 0 && rgb_max(c) <= bound + 1e-9);
            sum += c.g / 40000;
            square += c.g * c.g / 40000;
        }
        assert_true(sum > 0.02 && square - sum * sum > 0.003); /* not black, not uniform */
        const struct rgb far = texture_at(t, 5, 1e12, -1e12);
        assert_true(isfinite(far.r) && far.r >= 0);
    }
    /* a checker has its two colours in the middles of squares, and their mean on an edge */
    const struct texture *t = &w.scene.textures[0].texture;
    assert_near(texture_at(t, 5, 0.1, 0.1).r + texture_at(t, 5, 0.3, 0.1).r, 0.9, 1e-9);
    assert_near(texture_at(t, 5, 0.2, 0.1).r, 0.45, 1e-6);
    path_world_release(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_name_line_found_and_expected_word),
        cmocka_unit_test(a_scene_without_light_is_rejected),
        cmocka_unit_test(a_mesh_that_is_not_whole_is_rejected),
        cmocka_unit_test(faces_have_their_areas_normals_and_ids),
        cmocka_unit_test(textures_stay_below_their_bounds),
    };
    return cmocka_run_group_tests_name("simulate scene", tests, scratch_make, scratch_remove);
}
