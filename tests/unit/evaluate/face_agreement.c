/* face_agreement.c - ids of a model against true ids: pictures of known shares. */
#include "stages/evaluate/model/face_agreement.h"

#include <math.h>

#include "tests/unit/scratch.h"

enum { W = 40, H = 20, PIXELS = W * H };

static uint32_t truth[PIXELS], model[PIXELS];
static float distance[PIXELS];

/* Left of `edge` id `left`, right of it id `right`. */
static void halves(uint32_t *ids, int edge, uint32_t left, uint32_t right)
{
    for (int i = 0; i < PIXELS; i++) ids[i] = i % W < edge ? left : right;
}

static struct face_agreement agreement_of(int true_faces, int model_faces)
{
    struct face_agreement a;
    struct err err = ERR_INIT;
    assert_ok(face_agreement_init(&a, true_faces, model_faces, &err), err);
    for (int i = 0; i < true_faces; i++) a.counted[i] = true;
    return a;
}

static void add(struct face_agreement *a)
{
    const struct face_pixels p = {truth, model, distance, W, H};
    struct err err = ERR_INIT;
    assert_ok(face_agreement_add(a, &p, &err), err);
}

static void equal_pictures_agree_but_for_edges(void **state)
{
    (void)state;
    struct face_agreement a = agreement_of(3, 6);
    halves(truth, 20, 1, 2);
    halves(model, 20, 5, 3);
    memset(distance, 0, sizeof distance);
    add(&a);
    const struct face_shares s = face_shares_of(&a, -1);
    /* pixels 19 and 20 are beside the edge; those within 3 px of them are not used: 16 .. 23 */
    assert_int_equal(s.all, (W - 8) * H);
    assert_int_equal(s.counted, s.all);
    assert_int_equal(s.agreeing, s.all);
    assert_int_equal(s.worst, -1);
    assert_true(faces_match(&a, 1, 5) && faces_match(&a, 2, 3) && !faces_match(&a, 1, 3));
    face_agreement_release(&a);
}

static void a_strip_that_shows_another_plane_does_not_agree(void **state)
{
    (void)state;
    struct face_agreement a = agreement_of(3, 3);
    halves(truth, 10, 1, 2);
    halves(model, 25, 1, 2); /* between 10 and 25 the model shows face 1, 0.7 m from the true points */
    for (int i = 0; i < PIXELS; i++) distance[i] = i % W >= 10 && i % W < 25 ? 0.7f : 0.01f;
    add(&a);
    const struct face_shares s = face_shares_of(&a, 0);
    assert_int_equal(s.counted, (6 + 7 + 11) * H);
    assert_int_equal(s.agreeing, (6 + 11) * H);
    assert_int_equal(s.worst, 2);
    face_agreement_release(&a);
}

static void planes_must_be_parallel_and_near(void **state)
{
    (void)state;
    for (int k = 0; k < 5; k++) {
        struct face_agreement a = agreement_of(2, 2);
        const double angle = (k == 0 ? 9 : k == 1 ? 11 : 0) * M_PI / 180;
        halves(truth, 20, 1, 1);
        halves(model, 20, 1, 1);
        a.true_normals[1] = vec3_make(0, 0, k == 4 ? -1 : 1); /* 4: a two-sided face */
        a.model_normals[1] = k == 3 ? vec3_make(0, 0, 0) : vec3_make(sin(angle), 0, cos(angle));
        for (int i = 0; i < PIXELS; i++) distance[i] = k == 2 ? 0.11f : 0.09f;
        add(&a);
        assert_int_equal(faces_match(&a, 1, 1), k == 0 || k >= 3);
        face_agreement_release(&a);
    }
}

static void several_faces_may_belong_to_one_and_furniture_does_not_count(void **state)
{
    (void)state;
    struct face_agreement a = agreement_of(4, 2);
    halves(truth, 20, 1, 2); /* two floors that the model has as one */
    halves(model, 20, 1, 1);
    for (int i = 0; i < PIXELS; i++) {
        distance[i] = 0;
        if (i / W >= 10) truth[i] = 3; /* a table before them */
        if (i / W >= 10) distance[i] = 0.8f;
    }
    a.counted[3] = false;
    add(&a);
    const struct face_shares s = face_shares_of(&a, -1);
    assert_true(faces_match(&a, 1, 1) && faces_match(&a, 2, 1) && !faces_match(&a, 3, 1));
    assert_true(s.counted > 0 && s.counted == s.agreeing && s.all > s.counted);
    face_agreement_release(&a);
}

static void the_outdoors_belongs_to_nothing_else(void **state)
{
    (void)state;
    struct face_agreement a = agreement_of(2, 2);
    halves(truth, 20, 0, 0); /* a window that the model lacks on the right */
    halves(model, 20, 0, 1);
    memset(distance, 0, sizeof distance);
    add(&a);
    const struct face_shares s = face_shares_of(&a, -1);
    assert_int_equal(s.counted, 2 * s.agreeing);
    assert_int_equal(s.worst, 0);
    face_agreement_release(&a);
}

static void an_unknown_id_is_refused(void **state)
{
    (void)state;
    struct face_agreement a = agreement_of(2, 2);
    const struct face_pixels p = {truth, model, distance, W, H};
    struct err err = ERR_INIT;
    halves(truth, 20, 1, 2);
    halves(model, 20, 1, 1);
    assert_int_equal(face_agreement_add(&a, &p, &err), ST_DATA);
    assert_err(err, ST_DATA, "found id 2, wanted one of faces.txt, at most 1");
    assert_int_equal(a.picture_count, 0);
    face_agreement_release(&a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_pictures_agree_but_for_edges),
        cmocka_unit_test(a_strip_that_shows_another_plane_does_not_agree),
        cmocka_unit_test(planes_must_be_parallel_and_near),
        cmocka_unit_test(several_faces_may_belong_to_one_and_furniture_does_not_count),
        cmocka_unit_test(the_outdoors_belongs_to_nothing_else),
        cmocka_unit_test(an_unknown_id_is_refused),
    };
    return cmocka_run_group_tests_name("face_agreement", tests, scratch_make, scratch_remove);
}
