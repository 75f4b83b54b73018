/* still_matches.c - matches of what stands still in the picture, in made-up photos: points in a room seen by a camera
 * that moves, and marks at fixed pixels. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/image/photo.h"
#include "stages/sfm/still_matches.h"

enum { W = 640, H = 480, PHOTOS = 6, POINTS = 300, MARKS = 60, WRONG = 30, ALL = POINTS + MARKS + WRONG };

struct scene {
    int points, marks, wrong; /* features: of the scene, at fixed pixels, matched at random */
    double step;              /* px by which a point at depth 1 moves from one photo to the next */
    double turn;              /* the same for all depths */
    double far;               /* depth of the points on the left half; 0: like the others */
    int still_until;          /* photos before this one are taken from one place */
    int marked;               /* photos before this one have the marks; 0: all */
};

static char features[300], matches[300], ids[PHOTOS][8], files[PHOTOS][16];
static struct photo_record records[PHOTOS];
static const struct photo_list photos = {records, PHOTOS};

static double random_of(int key, int counter)
{
    uint32_t h = (uint32_t)key * 2654435761u + (uint32_t)counter * 2246822519u + 7;
    h = (h ^ h >> 15) * 2654435761u;
    h = (h ^ h >> 13) * 3266489917u;
    return (h >> 8) / 16777216.0;
}

/* Where feature k is in a photo. Marks are two lines of text at the lower edge. */
static struct feature place(const struct scene *s, int photo, int k)
{
    const double moved = photo < s->still_until ? 0 : photo;
    struct feature f = {.scale = 2};
    if (k < s->points) {
        const double x = random_of(1, k) * W, y = random_of(2, k) * H;
        const double depth = s->far > 0 && x < W / 2.0 ? s->far : 1 + 3 * random_of(3, k);
        f.x = (float)(x + moved * (s->step / depth + s->turn));
        f.y = (float)y;
    } else if (k < s->points + s->marks) {
        f.x = (float)(100 + 4.0 * (k - s->points) + 0.2 * random_of(4 + photo, k));
        f.y = (float)(k % 2 ? 440.3 : 455.1);
    } else {
        f.x = (float)(random_of(20 + photo, k) * W);
        f.y = (float)(random_of(40 + photo, k) * H);
    }
    return f;
}

static bool is_inside(const struct feature *f) { return f->x >= 0 && f->x < W && f->y >= 0 && f->y < H; }

static bool is_mark(const struct scene *s, int k) { return k >= s->points && k < s->points + s->marks; }

static void make(const struct scene *s)
{
    static int number;
    const struct provenance prov = {.stage = "test", .version = "0"};
    struct err err = ERR_INIT;
    char path[400];
    snprintf(features, sizeof features, "%s/%d-features", scratch, ++number);
    snprintf(matches, sizeof matches, "%s/%d-matches", scratch, number);
    assert_int_equal(mkdir(features, 0777) | mkdir(matches, 0777), 0);
    const int count = s->points + s->marks + s->wrong;
    for (int i = 0; i < PHOTOS; i++) {
        static struct feature list[ALL];
        snprintf(ids[i], sizeof ids[i], "p%d", i);
        snprintf(files[i], sizeof files[i], "p%d.jpg", i);
        records[i] = (struct photo_record){.id = ids[i], .file = files[i], .info = {.width = W, .height = H}};
        for (int k = 0; k < count; k++) list[k] = place(s, i, k);
        struct feature_list f = {list, count, ""};
        snprintf(path, sizeof path, "%s/%s.txt", features, ids[i]);
        assert_ok(feature_list_write(&f, path, &prov, &err), err);
    }
    for (int i = 0; i < PHOTOS; i++) {
        struct match_list list = {.max_ratio = 0.8, .max_angle = 0.7};
        memset(list.hash, '0', HASH_TEXT - 1);
        for (int other = i + 1; other < PHOTOS; other++) {
            struct matched_pair *pair = match_list_add(&list, ids[other], list.hash, &err);
            pair->matches = malloc(ALL * sizeof *pair->matches);
            for (int k = 0; k < count; k++) {
                const struct feature a = place(s, i, k), b = place(s, other, k);
                const bool marked = !s->marked || (i < s->marked && other < s->marked);
                if (is_inside(&a) && is_inside(&b) && (!is_mark(s, k) || marked))
                    pair->matches[pair->count++] = (struct index_match){k, k};
            }
        }
        snprintf(path, sizeof path, "%s/%s.txt", matches, ids[i]);
        assert_ok(match_list_write(&list, path, &prov, &err), err);
        match_list_release(&list);
    }
}

/* How many matches of points and of marks are left, over all pairs. */
static void count_left(struct still_places *places, const struct scene *s, int *points, int *lost, int *marks)
{
    struct err err = ERR_INIT;
    char path[400];
    *points = *lost = *marks = 0;
    assert_ok(still_places_find(places, &photos, features, matches, &err), err);
    for (int i = 0; i < PHOTOS; i++) {
        struct match_list list;
        snprintf(path, sizeof path, "%s/%s.txt", matches, ids[i]);
        assert_ok(match_list_read(&list, path, NULL, &err), err);
        for (int p = 0; p < list.count; p++) {
            int before = 0, after = 0;
            for (int k = 0; k < list.pairs[p].count; k++) before += list.pairs[p].matches[k].first < s->points;
            still_places_drop(places, &list.pairs[p], i, photo_list_find_id(&photos, list.pairs[p].other));
            for (int k = 0; k < list.pairs[p].count; k++) {
                after += list.pairs[p].matches[k].first < s->points;
                *marks += is_mark(s, list.pairs[p].matches[k].first);
            }
            *points += after;
            *lost += before - after;
        }
        match_list_release(&list);
    }
}

static void expect(const struct scene *s, bool found)
{
    struct still_places places;
    int points, lost, marks;
    make(s);
    count_left(&places, s, &points, &lost, &marks);
    if (found && (marks || lost > points / 8 || !places.groups[0].places))
        fail_msg("%d matches of marks are left, %d of %d others lost", marks, lost, points + lost);
    if (!found && (lost || places.groups[0].places)) fail_msg("%d matches of %d lost", lost, points + lost);
    still_places_release(&places);
}

static void a_watermark_is_found(void **state)
{
    (void)state;
    expect(&(struct scene){POINTS, MARKS, WRONG, 60, 3, 0, 0, 0}, true);
}

static void a_watermark_with_most_of_the_matches_is_found(void **state)
{
    (void)state;
    expect(&(struct scene){40, MARKS, 10, 60, 3, 0, 0, 0}, true);
}

static void a_watermark_in_half_of_the_photos_is_found(void **state)
{
    (void)state;
    expect(&(struct scene){POINTS, MARKS, WRONG, 60, 3, 0, 0, 3}, true);
}

static void scenes_without_marks_keep_their_matches(void **state)
{
    (void)state;
    expect(&(struct scene){POINTS, 0, WRONG, 60, 3, 0, 0, 0}, false);
    expect(&(struct scene){POINTS, 0, WRONG, 2, 0, 0, 0, 0}, false); /* hardly moves */
}

static void photos_from_a_tripod_keep_their_matches(void **state)
{
    (void)state;
    expect(&(struct scene){POINTS, 0, WRONG, 0, 0, 0, 0, 0}, false);
    expect(&(struct scene){POINTS, MARKS, WRONG, 0, 0, 0, 0, 0}, false);
    expect(&(struct scene){POINTS, 0, WRONG, 60, 3, 0, 4, 0}, false); /* some of them */
}

/* A camera on rails does not turn: half of the picture is so far away that it stands still. */
static void a_far_background_keeps_its_matches(void **state)
{
    (void)state;
    expect(&(struct scene){POINTS, 0, WRONG, 60, 0, 1000, 0, 0}, false);
}

static void what_is_found_is_described_and_masked(void **state)
{
    const struct scene s = {POINTS, MARKS, WRONG, 60, 3, 0, 0, 0};
    struct still_places places;
    struct photo mask = {0};
    struct err err = ERR_INIT;
    char text[200];
    int points, lost, marks, left, right, top, low;
    (void)state;
    make(&s);
    count_left(&places, &s, &points, &lost, &marks);
    const struct still_group *g = &places.groups[0];
    assert_int_equal(g->photos, PHOTOS);
    assert_true(g->matches >= MARKS * PHOTOS * (PHOTOS - 1) / 2 * 9 / 10);
    still_places_describe(text, sizeof text, g);
    assert_int_equal(sscanf(text, "x %d to %d, y %d to %d px", &left, &right, &top, &low), 4);
    assert_true(left <= 100 && left >= 70 && right >= 336 && right <= 370 && top <= 440 && top >= 410 && low >= 455 &&
                low <= 480);
    assert_ok(still_places_write_mask(g, scratch_path("mask.png"), &err), err);
    assert_ok(photo_read(&mask, scratch_path("mask.png"), &err), err);
    assert_true(mask.info.width == W && mask.info.height == H);
    assert_int_equal(mask.samples[3 * (447 * W + 200)], 0);
    assert_int_equal(mask.samples[3 * (200 * W + 200)], 255);
    photo_release(&mask);
    still_places_release(&places);
}

/* The second photo is taken from the place of the first one, or is the first one again at half its size. */
static void copies_are_named(void **state)
{
    const struct scene s = {POINTS, 0, 10, 60, 3, 0, 2, 0}, moves = {POINTS, MARKS, WRONG, 60, 3, 0, 0, 0};
    (void)state;
    for (int way = 0; way < 3; way++) {
        struct still_places places;
        struct err err = ERR_INIT;
        make(way < 2 ? &s : &moves);
        if (way == 1) { /* as if each pixel of the first photo were four */
            struct feature_list f;
            char path[400];
            snprintf(path, sizeof path, "%s/%s.txt", features, ids[0]);
            assert_ok(feature_list_read(&f, path, NULL, &err), err);
            for (int k = 0; k < f.count; k++) f.features[k].x *= 2, f.features[k].y *= 2;
            assert_ok(feature_list_write(&f, path, &(struct provenance){.stage = "test", .version = "0"}, &err), err);
            feature_list_release(&f);
            records[0].info.width *= 2;
            records[0].info.height *= 2;
        }
        assert_ok(still_places_find(&places, &photos, features, matches, &err), err);
        for (int i = 0; i < PHOTOS; i++) assert_int_equal(places.copy_of[i], way < 2 && i == 1 ? 0 : -1);
        still_places_release(&places);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_watermark_is_found),
        cmocka_unit_test(a_watermark_with_most_of_the_matches_is_found),
        cmocka_unit_test(a_watermark_in_half_of_the_photos_is_found),
        cmocka_unit_test(scenes_without_marks_keep_their_matches),
        cmocka_unit_test(photos_from_a_tripod_keep_their_matches),
        cmocka_unit_test(a_far_background_keeps_its_matches),
        cmocka_unit_test(what_is_found_is_described_and_masked),
        cmocka_unit_test(copies_are_named),
    };
    return cmocka_run_group_tests_name("still_matches", tests, scratch_make, scratch_remove);
}
