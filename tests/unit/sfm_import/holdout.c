/* holdout.c - the choice of held-out views and the split of the model. */
#include "stages/sfm_import/holdout.h"

#include "common/capture/camera_set.h"
#include "tests/unit/scratch.h"

enum { VIEWS = 5 };

static const char *const VIEW[VIEWS] = {"a", "b@0", "b@1", "c", "d"};
static const char *const PHOTO[VIEWS] = {"a", "b", "b", "c", "d"};

/* Points: 1 seen by a, b@0, c; 2 by c, d; 3 by a, d; 4 by b@0, b@1, c. Observation k of view v is at (k, v). */
static void make(struct imported *in)
{
    static const int seen[4][3] = {{0, 1, 3}, {3, 4, -1}, {0, 4, -1}, {1, 2, 3}};
    struct sfm_model *m = &in->model;
    *in = (struct imported){0};
    m->cameras = calloc(VIEWS, sizeof *m->cameras);
    m->images = calloc(VIEWS, sizeof *m->images);
    m->points = calloc(4, sizeof *m->points);
    in->lenses.lenses = calloc(VIEWS, sizeof *in->lenses.lenses);
    m->camera_count = m->image_count = in->lenses.count = VIEWS;
    for (int i = 0; i < VIEWS; i++) {
        char name[16];
        snprintf(name, sizeof name, "%s.exr", VIEW[i]);
        m->cameras[i] = (struct sfm_camera){i + 1, {CAMERA_PINHOLE, 100 + i, 50, {90, 90, 50, 25}}};
        m->images[i] = (struct sfm_image){
            i + 1, {{1, 0, 0, 0}, {i, 0, 0}}, i, strdup(name), calloc(4, sizeof(struct sfm_observation)), 0};
        in->lenses.lenses[i] = (struct lens){strdup(VIEW[i]), strdup(PHOTO[i]), m->cameras[i].camera, {1, 0, 0, 0}};
    }
    for (int p = 0; p < 4; p++) {
        m->points[p] =
            (struct sfm_point){.id = p + 1, .position = {p, 0, 5}, .track = calloc(3, sizeof(struct sfm_track))};
        for (int k = 0; k < 3 && seen[p][k] >= 0; k++) {
            struct sfm_image *im = &m->images[seen[p][k]];
            m->points[p].track[m->points[p].track_count++] = (struct sfm_track){seen[p][k], im->observation_count};
            im->observations[im->observation_count] =
                (struct sfm_observation){im->observation_count, seen[p][k], p + 1};
            im->observation_count++;
        }
        m->point_count++;
    }
}

static void choose(const struct imported *in, int every, const char *names, const char *wanted)
{
    bool held[VIEWS];
    struct err err = ERR_INIT;
    assert_ok(holdout_choose(held, &in->lenses, every, names, &err), err);
    for (int i = 0; i < VIEWS; i++) assert_int_equal(held[i], wanted[i] == '1');
}

static void views_are_chosen_by_number_and_by_name(void **state)
{
    struct imported in;
    (void)state;
    make(&in);
    choose(&in, 2, NULL, "10010"); /* a, b, c, d: the 1st and the 3rd photo */
    choose(&in, 3, NULL, "10001");
    choose(&in, 4, NULL, "10000");
    choose(&in, 8, "", "10000");
    choose(&in, 0, "b", "01100"); /* a photo: all its views */
    choose(&in, 0, " b@1  d ", "00101");
    import_release(&in);
}

static void invalid_choices_are_rejected(void **state)
{
    static const struct {
        int every;
        const char *names, *message;
    } bad[] = {
        {1, NULL, "0 of 4"}, {0, "a b c", "1 of 4"}, {0, "a e", "\"e\""}, {0, "b@2", "\"b@2\""}, {0, " ", "no view"}};
    struct imported in;
    (void)state;
    make(&in);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        bool held[VIEWS];
        struct err err = ERR_INIT;
        assert_int_equal(holdout_choose(held, &in.lenses, bad[i].every, bad[i].names, &err), ST_USAGE);
        assert_err(err, ST_USAGE, bad[i].message);
    }
    import_release(&in);
}

/* Tracks and observations refer to each other, ids count from 1, names and lenses belong to the views. */
static void check(const struct imported *part, const char *const *names, int count)
{
    const struct sfm_model *m = &part->model;
    int observations = 0, tracks = 0;
    assert_int_equal(m->image_count, count);
    assert_int_equal(m->camera_count, count);
    assert_int_equal(part->lenses.count, count);
    for (int i = 0; i < count; i++) {
        int from = m->cameras[i].camera.width - 100;
        assert_string_equal(part->lenses.lenses[i].view, names[i]);
        assert_string_equal(VIEW[from], names[i]);
        assert_int_equal(m->images[i].id, i + 1);
        assert_int_equal(m->images[i].camera_idx, i);
        assert_true(m->images[i].cam_from_world.translation.x == from);
        observations += m->images[i].observation_count;
        for (int k = 0; k < m->images[i].observation_count; k++) assert_true(m->images[i].observations[k].v == from);
    }
    for (int p = 0; p < m->point_count; p++)
        for (int k = 0; k < m->points[p].track_count; k++, tracks++) {
            const struct sfm_track *t = &m->points[p].track[k];
            assert_int_equal(m->images[t->image_idx].observations[t->observation_idx].point_id, m->points[p].id);
        }
    assert_int_equal(tracks, observations);
}

static void points_go_to_the_part_that_sees_them(void **state)
{
    static const char *const KEPT[] = {"b@0", "b@1", "d"}, *const HELD[] = {"a", "c"};
    static const bool held[VIEWS] = {true, false, false, true, false};
    struct imported in, kept = {0}, out = {0};
    struct camera_set set = {0};
    struct err err = ERR_INIT;
    (void)state;
    make(&in);
    assert_ok(holdout_split(&kept, &out, &in, held, &err), err);
    check(&kept, KEPT, 3);
    check(&out, HELD, 2);
    assert_int_equal(kept.model.point_count, 0); /* 4 is seen by b only, the others by one kept view */
    assert_int_equal(out.model.point_count, 4);
    assert_int_equal(out.model.points[3].track_count, 1);
    assert_ok(import_write(&out, scratch_path("held"), NULL, &err), err);
    assert_ok(camera_set_read(&set, scratch_path("held"), NULL, &err), err);
    assert_file_text(scratch_path("held/views.mk"), "VIEWS := a c\n");
    camera_set_release(&set);
    import_release(&kept);
    import_release(&out);

    assert_ok(holdout_split(&kept, &out, &in, (bool[VIEWS]){true}, &err), err);
    check(&kept, VIEW + 1, 4);
    assert_int_equal(kept.model.point_count, 3); /* 1, 2 and 4; 3 is seen by d only */
    assert_int_equal(kept.model.points[2].track_count, 3);
    import_release(&kept);
    import_release(&out);
    import_release(&in);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_are_chosen_by_number_and_by_name),
        cmocka_unit_test(invalid_choices_are_rejected),
        cmocka_unit_test(points_go_to_the_part_that_sees_them),
    };
    return cmocka_run_group_tests_name("holdout", tests, scratch_make, scratch_remove);
}
