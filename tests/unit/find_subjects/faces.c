/* faces.c - which faces become subjects, where those that look for them see bright squares.
 *
 * Squares on a wall at z = 10, white above and light grey below, so that one can be told from one upside down or lying;
 * views look along z, some of their pictures turned. The detector sees whole upright squares of the widths that it is
 * asked for. */
#include "stages/find_subjects/faces.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { W = 200, H = 160, MOST_VIEWS = 8, MOST_SQUARES = 4 };

struct square {
    double x, y, half; /* on the wall */
    unsigned seen;     /* bit i: view i's picture shows it */
};

struct world {
    struct view views[MOST_VIEWS];
    struct vec3 ups[MOST_VIEWS];
    struct camera_set set;
    struct square squares[MOST_SQUARES];
    int square_count;
    double score;  /* that the detector gives */
    double grow;   /* of what it sees to what it says: a face at the border sticks out */
    bool doubtful; /* it says everything twice, and a small face within */
    bool without_depth;
    int pictures_read;
};

static const char *const names[MOST_VIEWS] = {"v0", "v1", "v2", "v3", "v4", "v5", "v6", "v7"};

/* turn: the picture's upper side looks to 0: up, 1: right, 2: down, 3: left of the stored one. */
static void add_view(struct world *w, double x, double y, int turn)
{
    static const double c[4] = {1, 0, -1, 0}, s[4] = {0, 1, 0, -1};
    const int i = w->set.view_count++;
    struct view *v = &w->views[i];
    *v = (struct view){.name = names[i], .width = W, .height = H, .fx = W, .fy = W, .cx = W / 2.0, .cy = H / 2.0};
    v->center = vec3_make(x, y, 0);
    v->cam_from_world = (struct mat3){{{c[turn], -s[turn], 0}, {s[turn], c[turn], 0}, {0, 0, 1}}};
    v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
    w->ups[i] = vec3_make(s[turn], -c[turn], 0);
}

static struct world row_of_views(int count)
{
    struct world w = {.score = 60, .grow = 1};
    for (int i = 0; i < count; i++) add_view(&w, 0.5 * (i % 2 ? (i + 1) / 2 : -i / 2), 0, 0);
    return w;
}

static void add_square(struct world *w, double x, double y, double half, unsigned seen)
{
    w->squares[w->square_count++] = (struct square){x, y, half, seen};
}

static enum status draw(void *ctx, int view_idx, unsigned char **grey, struct err *err)
{
    struct world *w = ctx;
    (void)err;
    *grey = malloc(W * H);
    assert_non_null(*grey);
    w->pictures_read++;
    for (int p = 0; p < W * H; p++) {
        const struct vec3 at = view_unproject(&w->set.views[view_idx], p % W + 0.5, p / W + 0.5, 10);
        (*grey)[p] = 40;
        for (int i = 0; i < w->square_count; i++) {
            const struct square *s = &w->squares[i];
            if (s->seen >> view_idx & 1 && fabs(at.x - s->x) <= s->half && fabs(at.y - s->y) <= s->half)
                (*grey)[p] = at.y < s->y ? 255 : 180;
        }
    }
    return ST_OK;
}

static enum status wall(void *ctx, int view_idx, struct layered_depth *d, struct err *err)
{
    struct world *w = ctx;
    (void)view_idx;
    if (layered_depth_init(d, W, H, err)) return err->status;
    d->segments = calloc(1, sizeof *d->segments);
    assert_non_null(d->segments);
    d->segments[0] = (struct depth_segment){.id = 1, .confidence = 1};
    d->segment_count = 1;
    for (int p = 0; p < W * H && !w->without_depth; p++) {
        d->interior.id[p] = 1;
        d->interior.z[p] = 10;
        d->interior.rgba[4 * p + 3] = 1;
    }
    return ST_OK;
}

/* Squares do not touch: one begins at a bright pixel with dark ones to its left and above. */
static enum status see(void *ctx, const unsigned char *grey, int width, int height, double least, double most,
                       struct face **faces, int *count, struct err *err)
{
    const struct world *w = ctx;
    (void)err;
    *count = 0;
    *faces = malloc(64 * sizeof **faces);
    assert_non_null(*faces);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const unsigned char *p = grey + y * width + x;
            if (*p < 110 || (x && p[-1] >= 110) || (y && p[-width] >= 110)) continue;
            int x1 = x, y1 = y;
            while (x1 < width && grey[y * width + x1] >= 110) x1++;
            while (y1 < height && grey[y1 * width + x] >= 110) y1++;
            bool known = false; /* corners of a resampled square are round: it begins in several places */
            for (int i = 0; i < *count; i++)
                known =
                    known || (x1 > (*faces)[i].x0 && x < (*faces)[i].x1 && y1 > (*faces)[i].y0 && y < (*faces)[i].y1);
            const int middle = (x + x1) / 2, quarter = (y1 - y) / 4;
            const bool upright =
                grey[(y + quarter) * width + middle] > 220 && grey[(y1 - 1 - quarter) * width + middle] < 220;
            if (known || !upright || x1 - x < least || x1 - x > most || *count > 60) continue;
            const double more = (w->grow - 1) * (x1 - x) / 2;
            const struct face f = {x - more, y - more, x1 + more, y1 + more, w->score};
            (*faces)[(*count)++] = f;
            if (!w->doubtful) continue;
            (*faces)[(*count)++] = (struct face){f.x0 + 4, f.y0 - 4, f.x1 + 4, f.y1 - 4, w->score};
            (*faces)[(*count)++] = (struct face){f.x0 + 5, f.y0 + 5, f.x0 + 15, f.y0 + 15, w->score / 2};
        }
    return ST_OK;
}

static struct find_params params_of_tests(void)
{
    struct find_params p = FIND_PARAMS_DEFAULT;
    return p;
}

static void search(struct world *w, struct subject_list *list, struct face_report *report)
{
    const struct face_source source = {w, draw, wall, see};
    const struct find_params params = params_of_tests();
    struct err err = ERR_INIT;
    *list = (struct subject_list){0};
    w->set.views = w->views; /* a world may have been copied */
    w->pictures_read = 0;
    if (find_faces(list, report, &w->set, w->ups, &source, &params, &err)) fail_msg("%s", err.text);
}

static void release(struct subject_list *list, struct face_report *report)
{
    subject_list_release(list);
    face_report_release(report);
    face_report_release(report);
}

/* To a pixel and a half of the picture. */
static void assert_near(struct vec3 p, double x, double y)
{
    if (hypot(p.x - x, p.y - y) > 1.5 * 10.0 / W || fabs(p.z - 10) > 1e-9)
        fail_msg("found %g %g %g, wanted %g %g 10", p.x, p.y, p.z, x, y);
}

static void a_face_that_other_views_see_is_kept_at_its_place(void **state)
{
    (void)state;
    struct world w = row_of_views(5);
    struct subject_list list;
    struct face_report report;
    add_square(&w, 0.4, -0.6, 0.8, ~0U);
    search(&w, &list, &report);
    assert_int_equal(list.count, 1);
    const struct subject *s = &list.subjects[0];
    assert_true(!strcmp(s->view, "v0") && s->source == SUBJECT_FACE && s->asked == 4 && s->confirmed == 4);
    assert_true(fabs(s->score - 60) < 1e-9 && s->depth == 10);
    assert_near(s->corner[0], -0.4, -1.4);
    assert_near(s->corner[1], 1.2, -1.4);
    assert_near(s->corner[2], 1.2, 0.2);
    assert_near(s->corner[3], -0.4, 0.2);
    assert_true(report.count == 1 && report.views == 1 && report.sightings[0].verdict == FACE_KEPT);
    release(&list, &report);
}

static void a_face_that_few_other_views_see_is_left_out(void **state)
{
    (void)state;
    struct world w = row_of_views(5);
    struct subject_list list;
    struct face_report report;
    add_square(&w, 0.4, -0.6, 0.8, 1 | 2); /* of the four that are asked one confirms */
    search(&w, &list, &report);
    assert_int_equal(list.count, 0);
    assert_int_equal(report.views, 5);
    assert_int_equal(report.sightings[0].verdict, FACE_UNCONFIRMED);
    assert_true(report.sightings[0].subject.asked == 4 && report.sightings[0].subject.confirmed == 1);
    release(&list, &report);
}

/* A thing that cascades take for a face from everywhere, but hardly. */
static void a_face_of_low_scores_is_left_out(void **state)
{
    (void)state;
    struct world w = row_of_views(5);
    struct subject_list list;
    struct face_report report;
    w.score = 20;
    add_square(&w, 0.4, -0.6, 0.8, ~0U);
    search(&w, &list, &report);
    assert_true(!list.count && report.sightings[0].verdict == FACE_UNSURE && !report.sightings[0].alone);
    release(&list, &report);
    w.score = 5; /* not worth to ask others */
    search(&w, &list, &report);
    assert_true(!list.count && !report.count);
    assert_int_equal(w.pictures_read, 5);
    release(&list, &report);
}

static void one_view_only_is_believed_by_its_score(void **state)
{
    (void)state;
    struct world w = row_of_views(1);
    struct subject_list list;
    struct face_report report;
    add_square(&w, 0.4, -0.6, 0.8, ~0U);
    search(&w, &list, &report);
    assert_true(list.count == 1 && report.sightings[0].alone && list.subjects[0].asked == 0);
    release(&list, &report);
    w.score = 45; /* would do where others confirm it */
    search(&w, &list, &report);
    assert_true(!list.count && report.sightings[0].verdict == FACE_UNSURE && report.sightings[0].alone);
    release(&list, &report);
}

static void views_from_the_same_place_are_not_asked(void **state)
{
    (void)state;
    struct world w = {.score = 45, .grow = 1};
    struct subject_list list;
    struct face_report report;
    for (int i = 0; i < 5; i++) add_view(&w, 1e-4 * i, 0, 0);
    add_square(&w, 0.4, -0.6, 0.8, ~0U);
    search(&w, &list, &report);
    assert_true(!list.count && report.sightings[0].alone && !report.sightings[0].subject.asked);
    release(&list, &report);
}

static void a_face_at_the_border_is_clipped_to_it(void **state)
{
    (void)state;
    struct world w = row_of_views(5);
    struct subject_list list;
    struct face_report report;
    add_square(&w, -4.1, -3.1, 0.8, ~0U); /* 2 px from the left, 2 px from the top of the centremost view */
    w.grow = 1.4;
    w.score = 80;
    search(&w, &list, &report);
    assert_int_equal(list.count, 1);
    const struct subject *s = &list.subjects[0];
    assert_true(s->x0 == 0 && s->y0 == 0 && s->x1 > 36 && s->x1 < 44 && s->y1 > 36 && s->y1 < 44);
    assert_near(s->corner[0], -5, -4);
    release(&list, &report);
}

static void a_subject_without_depth_is_left_out(void **state)
{
    (void)state;
    struct world w = row_of_views(5);
    struct subject_list list;
    struct face_report report;
    add_square(&w, 0.4, -0.6, 0.8, ~0U);
    w.without_depth = true;
    search(&w, &list, &report);
    assert_int_equal(list.count, 0);
    assert_true(report.count == 5 && report.sightings[0].verdict == FACE_NO_DEPTH);
    assert_true(report.sightings[0].subject.depth == 0);
    release(&list, &report);
}

static void pictures_that_are_stored_turned_are_looked_at_upright(void **state)
{
    (void)state;
    for (int turn = 1; turn < 4; turn++) {
        struct world w = {.score = 60, .grow = 1};
        struct subject_list list;
        struct face_report report;
        for (int i = 0; i < 5; i++) add_view(&w, 0.5 * (i - 2), 0.1, (turn + i) % 4); /* not all alike */
        add_square(&w, 0.4, -0.6, 0.8, ~0U);
        search(&w, &list, &report);
        assert_int_equal(list.count, 1);
        assert_true(!strcmp(list.subjects[0].view, "v2") && list.subjects[0].confirmed == 4);
        assert_near(list.subjects[0].corner[0], -0.4, -1.4);
        assert_near(list.subjects[0].corner[2], 1.2, 0.2);
        assert_near(subject_lower_center(&list.subjects[0]), 0.4, -0.2);
        release(&list, &report);
    }
}

static void the_next_view_is_tried_where_the_centremost_has_no_face(void **state)
{
    (void)state;
    struct world w = row_of_views(5);
    struct subject_list list;
    struct face_report report;
    add_square(&w, 0.4, -0.6, 0.8, ~1U);
    search(&w, &list, &report);
    assert_true(list.count == 1 && report.views == 2 && strcmp(list.subjects[0].view, "v0"));
    assert_true(list.subjects[0].confirmed == 3 && list.subjects[0].asked == 4);
    release(&list, &report);
}

static void of_several_the_two_largest_are_kept(void **state)
{
    (void)state;
    struct world w = row_of_views(5);
    struct subject_list list;
    struct face_report report;
    add_square(&w, 2, -1, 0.5, ~0U);
    add_square(&w, -2, -1, 0.9, ~0U);
    add_square(&w, 0, 1.5, 0.7, ~0U);
    search(&w, &list, &report);
    assert_int_equal(list.count, 2);
    assert_near(subject_center(&list.subjects[0]), -2, -1);
    assert_near(subject_center(&list.subjects[1]), 0, 1.5);
    assert_true(report.count == 3 && report.sightings[2].verdict == FACE_BEYOND);
    release(&list, &report);
}

static void what_is_seen_several_times_is_one_face(void **state)
{
    (void)state;
    struct world w = row_of_views(5);
    struct subject_list list;
    struct face_report report;
    add_square(&w, 0.4, -0.6, 1.6, ~0U);
    w.doubtful = true;
    search(&w, &list, &report);
    assert_int_equal(list.count, 1);
    assert_int_equal(report.count, 1);
    assert_near(subject_center(&list.subjects[0]), 0.4 + 2 * 10.0 / W, -0.6 - 2 * 10.0 / W);
    release(&list, &report);
}

static void a_scene_without_views_has_no_face(void **state)
{
    (void)state;
    struct world w = row_of_views(0);
    struct subject_list list;
    struct face_report report;
    search(&w, &list, &report);
    assert_true(!list.count && !report.count && !report.views);
    release(&list, &report);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_face_that_other_views_see_is_kept_at_its_place),
        cmocka_unit_test(a_face_that_few_other_views_see_is_left_out),
        cmocka_unit_test(a_face_of_low_scores_is_left_out),
        cmocka_unit_test(one_view_only_is_believed_by_its_score),
        cmocka_unit_test(views_from_the_same_place_are_not_asked),
        cmocka_unit_test(a_face_at_the_border_is_clipped_to_it),
        cmocka_unit_test(a_subject_without_depth_is_left_out),
        cmocka_unit_test(pictures_that_are_stored_turned_are_looked_at_upright),
        cmocka_unit_test(the_next_view_is_tried_where_the_centremost_has_no_face),
        cmocka_unit_test(of_several_the_two_largest_are_kept),
        cmocka_unit_test(what_is_seen_several_times_is_one_face),
        cmocka_unit_test(a_scene_without_views_has_no_face),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
