/* faces.c - selection of faces, with a detector of bright squares in place of cascades.
 *
 * The squares are on a wall at z = 10, white above and light grey below, which makes them distinct from rotated ones;
 * the views look along z, some with rotated pictures. The detector finds whole upright squares of the requested
 * widths. */
#include "stages/find_subjects/faces.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { W = 200, H = 160, MAX_VIEWS = 8, MAX_SQUARES = 4 };

struct square {
    double x, y, half; /* on the wall */
    unsigned seen;     /* bit i: view i's picture shows it */
};

struct world {
    struct view views[MAX_VIEWS];
    struct vec3 ups[MAX_VIEWS];
    struct camera_set set;
    struct square squares[MAX_SQUARES];
    int square_count;
    double score;  /* of the detections */
    double grow;   /* size of a detection relative to the square: near the border it extends outside */
    bool repeated; /* whether every square is detected twice, with a small face inside */
    bool without_depth;
    int pictures_read;
};

static const char *const names[MAX_VIEWS] = {"v0", "v1", "v2", "v3", "v4", "v5", "v6", "v7"};

/* turn: direction of the picture's upper side in the stored picture; 0: up, 1: right, 2: down, 3: left. */
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

/* Squares do not touch: each begins at a bright pixel with dark pixels to the left and above. */
static enum status see(void *ctx, const unsigned char *grey, int width, int height, double min_width, double max_width,
                       struct face_box **faces, int *count, struct err *err)
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
            bool known = false; /* the corners of a resampled square are round, so that it has several first pixels */
            for (int i = 0; i < *count; i++)
                known =
                    known || (x1 > (*faces)[i].x0 && x < (*faces)[i].x1 && y1 > (*faces)[i].y0 && y < (*faces)[i].y1);
            const int middle = (x + x1) / 2, quarter = (y1 - y) / 4;
            const bool upright =
                grey[(y + quarter) * width + middle] > 220 && grey[(y1 - 1 - quarter) * width + middle] < 220;
            if (known || !upright || x1 - x < min_width || x1 - x > max_width || *count > 60) continue;
            const double more = (w->grow - 1) * (x1 - x) / 2;
            const struct face_box f = {x - more, y - more, x1 + more, y1 + more, w->score};
            (*faces)[(*count)++] = f;
            if (!w->repeated) continue;
            (*faces)[(*count)++] = (struct face_box){f.x0 + 4, f.y0 - 4, f.x1 + 4, f.y1 - 4, w->score};
            (*faces)[(*count)++] = (struct face_box){f.x0 + 5, f.y0 + 5, f.x0 + 15, f.y0 + 15, w->score / 2};
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
    w->set.views = w->views; /* the world may be a copy */
    w->pictures_read = 0;
    if (faces_find(list, report, &w->set, w->ups, &source, &params, &err)) fail_msg("%s", err.text);
}

static void release(struct subject_list *list, struct face_report *report)
{
    subject_list_release(list);
    face_report_release(report);
    face_report_release(report);
}

/* To one and a half pixels of the picture. */
static void assert_near(struct vec3 p, double x, double y)
{
    if (hypot(p.x - x, p.y - y) > 1.5 * 10.0 / W || fabs(p.z - 10) > 1e-9)
        fail_msg("found %g %g %g, wanted %g %g 10", p.x, p.y, p.z, x, y);
}

static void a_face_confirmed_by_other_views_is_kept_at_its_place(void **state)
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

static void a_face_confirmed_by_few_views_is_left_out(void **state)
{
    (void)state;
    struct world w = row_of_views(5);
    struct subject_list list;
    struct face_report report;
    add_square(&w, 0.4, -0.6, 0.8, 1 | 2); /* one of four views confirms */
    search(&w, &list, &report);
    assert_int_equal(list.count, 0);
    assert_int_equal(report.views, 5);
    assert_int_equal(report.sightings[0].verdict, FACE_UNCONFIRMED);
    assert_true(report.sightings[0].subject.asked == 4 && report.sightings[0].subject.confirmed == 1);
    release(&list, &report);
}

/* An object that is detected as a face from everywhere, with a low score. */
static void a_face_of_low_scores_is_left_out(void **state)
{
    (void)state;
    struct world w = row_of_views(5);
    struct subject_list list;
    struct face_report report;
    w.score = 20;
    add_square(&w, 0.4, -0.6, 0.8, ~0U);
    search(&w, &list, &report);
    assert_true(!list.count && report.sightings[0].verdict == FACE_LOW_SCORE && !report.sightings[0].unchecked);
    release(&list, &report);
    w.score = 5; /* too low for a check in other views */
    search(&w, &list, &report);
    assert_true(!list.count && !report.count);
    assert_int_equal(w.pictures_read, 5);
    release(&list, &report);
}

static void a_face_that_no_other_view_can_check_needs_a_higher_score(void **state)
{
    (void)state;
    struct world w = row_of_views(1);
    struct subject_list list;
    struct face_report report;
    add_square(&w, 0.4, -0.6, 0.8, ~0U);
    search(&w, &list, &report);
    assert_true(list.count == 1 && report.sightings[0].unchecked && list.subjects[0].asked == 0);
    release(&list, &report);
    w.score = 45; /* enough with confirmation */
    search(&w, &list, &report);
    assert_true(!list.count && report.sightings[0].verdict == FACE_LOW_SCORE && report.sightings[0].unchecked);
    release(&list, &report);
}

static void views_from_the_same_position_do_not_check_faces(void **state)
{
    (void)state;
    struct world w = {.score = 45, .grow = 1};
    struct subject_list list;
    struct face_report report;
    for (int i = 0; i < 5; i++) add_view(&w, 1e-4 * i, 0, 0);
    add_square(&w, 0.4, -0.6, 0.8, ~0U);
    search(&w, &list, &report);
    assert_true(!list.count && report.sightings[0].unchecked && !report.sightings[0].subject.asked);
    release(&list, &report);
}

static void a_face_at_the_border_is_clipped_to_it(void **state)
{
    (void)state;
    struct world w = row_of_views(5);
    struct subject_list list;
    struct face_report report;
    add_square(&w, -4.1, -3.1, 0.8, ~0U); /* 2 px from the left, 2 px from the top of the most central view */
    w.grow = 1.4;
    w.score = 80;
    search(&w, &list, &report);
    assert_int_equal(list.count, 1);
    const struct subject *s = &list.subjects[0];
    assert_true(s->x0 == 0 && s->y0 == 0 && s->x1 > 36 && s->x1 < 44 && s->y1 > 36 && s->y1 < 44);
    assert_near(s->corner[0], -5, -4);
    release(&list, &report);
}

static void a_face_without_depth_is_left_out(void **state)
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

static void rotated_pictures_are_searched_upright(void **state)
{
    (void)state;
    for (int turn = 1; turn < 4; turn++) {
        struct world w = {.score = 60, .grow = 1};
        struct subject_list list;
        struct face_report report;
        for (int i = 0; i < 5; i++) add_view(&w, 0.5 * (i - 2), 0.1, (turn + i) % 4); /* with different rotations */
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

static void the_next_view_is_searched_if_the_most_central_has_no_face(void **state)
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

static void the_two_largest_faces_are_kept(void **state)
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
    assert_true(report.count == 3 && report.sightings[2].verdict == FACE_SURPLUS);
    release(&list, &report);
}

static void overlapping_detections_are_one_face(void **state)
{
    (void)state;
    struct world w = row_of_views(5);
    struct subject_list list;
    struct face_report report;
    add_square(&w, 0.4, -0.6, 1.6, ~0U);
    w.repeated = true;
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
        cmocka_unit_test(a_face_confirmed_by_other_views_is_kept_at_its_place),
        cmocka_unit_test(a_face_confirmed_by_few_views_is_left_out),
        cmocka_unit_test(a_face_of_low_scores_is_left_out),
        cmocka_unit_test(a_face_that_no_other_view_can_check_needs_a_higher_score),
        cmocka_unit_test(views_from_the_same_position_do_not_check_faces),
        cmocka_unit_test(a_face_at_the_border_is_clipped_to_it),
        cmocka_unit_test(a_face_without_depth_is_left_out),
        cmocka_unit_test(rotated_pictures_are_searched_upright),
        cmocka_unit_test(the_next_view_is_searched_if_the_most_central_has_no_face),
        cmocka_unit_test(the_two_largest_faces_are_kept),
        cmocka_unit_test(overlapping_detections_are_one_face),
        cmocka_unit_test(a_scene_without_views_has_no_face),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
