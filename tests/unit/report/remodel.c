/* remodel.c - photographs before and after edits; the page of remodelled rooms with plans, films and exports; what is
 * missing, odd names, links. */
#include "stages/report/page_remodel.h"

#include "tests/unit/report/scratch_page.h"
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/outfile.h"
#include "common/capture/lens_list.h"
#include "common/texture/picture_record.h"

enum { SIDE = 8 };

static const struct provenance prov = {.stage = "test", .version = "0"};

/* Writes a file in the scratch folder, whose folders are made. */
static void put(const char *name, const char *text)
{
    char folder[PATH_MAX];
    struct err err = ERR_INIT;
    snprintf(folder, sizeof folder, "%s", scratch_path(name));
    *strrchr(folder, '/') = '\0';
    assert_ok(outfile_make_folders(folder, &err), err);
    scratch_write(name, text);
}

static const char *in_edit(const char *edit, const char *file, const char *ending)
{
    static char name[512];
    snprintf(name, sizeof name, "remodel/%s/%s%s", edit, file, ending);
    return name;
}

static void put_view(const char *view)
{
    struct exr_image im = {0};
    struct err err = ERR_INIT;
    char name[64];
    assert_ok(exr_image_init(&im, SIDE, SIDE, &err), err);
    for (int k = 0; k < 3; k++) {
        assert_ok(exr_add_plane(&im, (const char *const[]){"R", "G", "B"}[k], EXR_HALF, NULL, &err), err);
        for (int i = 0; i < SIDE * SIDE; i++) im.planes[k].f[i] = 0.25F;
    }
    snprintf(name, sizeof name, "views/%s.exr", view);
    assert_ok(exr_write(&im, scratch_path(name), &prov, &err), err);
    exr_image_release(&im);
}

/* Views a, b@0 and b@1 of one photo, c; a and c are of the photos of these names. */
static void put_views_of(const char *a, const char *c)
{
    const char *const views[][2] = {{"a", a}, {"b@0", "b"}, {"b@1", "b"}, {"c", c}};
    char text[512] = "remodel-lenses 1\n";
    for (int i = 0; i < 4; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s %s PINHOLE 8 8 8 8 4 4 turn 1 0 0 0\n",
                 views[i][0], views[i][1]);
    put("views/lenses.txt", text);
    put("views/cameras.txt", "1 PINHOLE 8 8 8 8 4 4\n");
    put("views/points3D.txt", "");
    text[0] = '\0';
    for (int i = 0; i < 4; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%d 1 0 0 0 %d 0 0 1 %s.exr\n\n", i + 1, 10 * i,
                 views[i][0]);
    put("views/images.txt", text);
    for (int i = 0; i < 4; i++) put_view(views[i][0]);
}

static void put_views(void) { put_views_of("a", "c"); }

/* The record of a view after an edit, and its pictures if the edit changes it. */
static void put_guess(const char *edit, const char *view, double changed, double nothing, double guessed)
{
    unsigned char grey[3 * SIDE * SIDE];
    struct picture_record record = {SIDE, SIDE, 1.5, changed, {0}};
    struct err err = ERR_INIT;
    char file[64];
    record.shares[MADE_NOTHING] = nothing;
    record.shares[MADE_PHOTO] = 60 - nothing;
    record.shares[MADE_WARPED] = 30;
    record.shares[MADE_SYNTHESISED] = guessed;
    memset(grey, 99, sizeof grey);
    snprintf(file, sizeof file, "pictures/%s", view);
    put(in_edit(edit, file, ".txt"), "");
    assert_ok(picture_record_write(&record, scratch_path(in_edit(edit, file, ".txt")), &prov, &err), err);
    if (changed <= 0) return;
    assert_ok(jpeg_write(scratch_path(in_edit(edit, file, ".jpg")), grey, SIDE, SIDE, 90, &err), err);
    assert_ok(png_write(scratch_path(in_edit(edit, file, "-sources.png")), grey, SIDE, SIDE, 3, &err), err);
}

static void put_sight(const char *edit, const char *view, double changed, double nothing)
{
    put_guess(edit, view, changed, nothing, 10);
}

static void put_edit(const char *edit)
{
    put(in_edit(edit, "model", ".txt"), "remodel-model 1\n");
    put_sight(edit, "a", 10, 0);
    put_sight(edit, "b@0", 30, 0);
    put_sight(edit, "b@1", 25, 0);
    put_sight(edit, "c", 0, 0);
}

/* A view of an edit in the light that it makes. */
static void put_relit(const char *edit, const char *view, double changed)
{
    unsigned char grey[3 * SIDE * SIDE];
    struct picture_record record = {SIDE, SIDE, 1.5, 10, {0}};
    struct err err = ERR_INIT;
    char name[256], file[64], text[256];
    memset(grey, 128, sizeof grey);
    snprintf(name, sizeof name, "relight/%s/unlit/%s.txt", edit, view);
    put(name, "");
    assert_ok(picture_record_write(&record, scratch_path(name), &prov, &err), err);
    snprintf(name, sizeof name, "relight/%s/%s.txt", edit, view);
    snprintf(text, sizeof text, "remodel-relit 1\nsize 8 8\nexposure 2\nchanged %g\nbounded 7\nkept 3\nrecords 5\n",
             changed);
    put(name, text);
    for (int k = 0; k < 3; k++) {
        snprintf(file, sizeof file, "%s%s%s", k ? "" : "unlit/", view, k < 2 ? ".jpg" : "-ratio.png");
        snprintf(name, sizeof name, "relight/%s/%s", edit, file);
        assert_ok(k < 2 ? jpeg_write(scratch_path(name), grey, SIDE, SIDE, 90, &err)
                        : png_write(scratch_path(name), grey, SIDE, SIDE, 3, &err),
                  err);
    }
}

static int empty_scratch(void **state) { return scratch_remove(state) || scratch_make(state); }

static const char *page_quality; /* of the pages that are made */

static void read_all(struct remodel_contents *c)
{
    char scripts[PATH_MAX];
    struct err err = ERR_INIT;
    snprintf(scripts, sizeof scripts, "%s", scratch_path("edits"));
    const struct remodel_sources from = {{scratch, scratch, NULL, scripts}, page_quality};
    *c = (struct remodel_contents){0};
    assert_ok(remodel_contents_read(c, &from, &err), err);
}

/* The page of the scratch folder; the caller frees it. */
static char *page_of(const char *scene, const char *back)
{
    struct remodel_contents c;
    struct page page;
    struct err err = ERR_INIT;
    char *text = NULL, folder[PATH_MAX];
    size_t size;
    read_all(&c);
    scratch_page_begin(&page, &text, &size, folder, "../page/", "../");
    assert_ok(remodel_page_write(&page, scene, back, &c, &err), err);
    scratch_page_end(&page);
    remodel_contents_release(&c);
    return text;
}

static void expect_words(const char *page, const char *words)
{
    if (!strstr(page, words)) fail_msg("the page does not say \"%s\"", words);
}

static int count_words(const char *page, const char *words)
{
    int n = 0;
    for (const char *at = page; (at = strstr(at, words)); at += strlen(words)) n++;
    return n;
}

/* ------------------------------------------------------------------------------------------------------------ links */

/* A link to a picture of the page; returns whether it is one. */
static bool is_picture(const char *link) { return !strncmp(link, "../page/", 8); }

static void expect_target(const char *page, const char *link, size_t length)
{
    char path[512] = "remodel/", id[64];
    size_t at = strlen(path);
    if (link[0] == '#') {
        snprintf(id, sizeof id, " id=\"%.*s\"", (int)length - 1, link + 1);
        expect_words(page, id);
        return;
    }
    for (size_t i = 0; i < length; i++, at++) {
        unsigned code;
        assert_null(strchr(" \"'<>&#?", link[i]));
        path[at] = link[i];
        if (link[i] != '%') continue;
        assert_int_equal(sscanf(link + i + 1, "%2x", &code), 1);
        path[at] = (char)code;
        i += 2;
    }
    path[at] = '\0';
    if (access(scratch_path(path), F_OK)) fail_msg("a link leads to %s, which is not there", path);
}

/* Each link leads to a place on the page, or to a file beside it. Returns how many lead to files that are no pictures
 * of the page. */
static int expect_links(const char *page)
{
    static const char *const begins[] = {" href=\"", " src=\""};
    int files = 0;
    for (int k = 0; k < 2; k++)
        for (const char *at = page; (at = strstr(at, begins[k]));) {
            at += strlen(begins[k]);
            const size_t length = strcspn(at, "\"");
            if (!strncmp(at, "data:", 5)) continue;
            expect_target(page, at, length);
            files += *at != '#' && !is_picture(at);
        }
    return files;
}

/* ------------------------------------------------------------------------------------------------------------ tests */

static void each_photo_has_one_picture_and_all_changes_that_it_shows(void **state)
{
    struct remodel_contents c;
    (void)state;
    put_views();
    put_edit("no-wall");
    put_guess("door", "c", 5, 0, 0);
    put(in_edit("door", "model", ".txt"), "");
    read_all(&c);
    const struct rooms *rooms = &c.rooms;
    assert_int_equal(rooms->change_count, 2);
    assert_string_equal(rooms->changes[0].name, "door");
    assert_int_equal(rooms->changes[0].photos, 1);
    assert_int_equal(rooms->changes[1].photos, 2); /* a and b: c does not change */
    assert_int_equal(rooms->photo_count, 3);
    for (int i = 0; i < 3; i++) {
        const struct room_photo *p = &rooms->photos[i];
        assert_int_equal(p->look_count, 1);
        assert_true(p->before.width == SIDE && p->before.height == SIDE);
        assert_true(p->looks[0].after.width == SIDE && !p->looks[0].relit.rgb);
        /* 0.25 times the exposure of 1.5, and the grey of the edit's picture */
        assert_int_equal(p->before.rgb[0], 165);
        assert_in_range(p->looks[0].after.rgb[0], 98, 100);
    }
    assert_string_equal(rooms->photos[0].photo, "b");
    assert_true(fabs(rooms->photos[0].looks[0].changed - 27.5) < 1e-9); /* of b@0 and b@1 */
    remodel_contents_release(&c);
    remodel_contents_release(&c);
}

/* Faces of one panorama stand together, under its name, behind the one that tells most. */
static void faces_of_a_panorama_are_one_place(void **state)
{
    struct remodel_contents c;
    (void)state;
    put_views_of("hall_yaw060", "hall_yaw300");
    put(in_edit("no-wall", "model", ".txt"), "");
    put_sight("no-wall", "a", 40, 0);
    put_sight("no-wall", "b@0", 30, 0);
    put_sight("no-wall", "b@1", 30, 0);
    put_sight("no-wall", "c", 20, 0);
    read_all(&c);
    assert_int_equal(c.rooms.photo_count, 3);
    assert_string_equal(c.rooms.photos[0].photo, "hall_yaw060");
    assert_string_equal(c.rooms.photos[1].photo, "hall_yaw300");
    assert_string_equal(c.rooms.photos[2].photo, "b");
    remodel_contents_release(&c);
    char *page = page_of("loft", NULL);
    assert_int_equal(count_words(page, "<section class=\"place\" aria-label=\"Panorama hall\">"), 1);
    expect_words(page, "<h3>Panorama hall</h3>");
    expect_words(page, "data-photo=\"Panorama hall, 60 degrees to the right\"");
    expect_words(page, "data-photo=\"Panorama hall, 60 degrees to the left\"");
    expect_words(page, "data-photo=\"Photograph b\"");
    free(page);
}

static void what_is_known_comes_before_what_is_guessed(void **state)
{
    struct remodel_contents c;
    (void)state;
    put_views();
    put(in_edit("no-wall", "model", ".txt"), "");
    put_guess("no-wall", "a", 40, 0, 40); /* most changes, and all is guessed */
    put_guess("no-wall", "b@0", 12, 0, 1);
    put_guess("no-wall", "b@1", 12, 0, 1);
    put_guess("no-wall", "c", 97, 0, 0); /* hardly anything of the photo is left */
    put_guess("open", "a", 20, 0, 0);    /* of the changes in a photo the one that tells most is shown first */
    put(in_edit("open", "model", ".txt"), "");
    read_all(&c);
    assert_int_equal(c.rooms.photo_count, 3);
    assert_string_equal(c.rooms.photos[0].photo, "a");
    assert_int_equal(c.rooms.photos[0].look_count, 2);
    assert_string_equal(c.rooms.changes[c.rooms.photos[0].looks[0].change].name, "open");
    assert_string_equal(c.rooms.photos[1].photo, "c");
    assert_string_equal(c.rooms.photos[2].photo, "b");
    remodel_contents_release(&c);
}

static void the_page_has_pictures_plans_films_and_exports(void **state)
{
    (void)state;
    put_views();
    put_edit("no-wall");
    put("edits/no-wall.txt",
        "remodel-script 1\n# The wall <goes>,\n# and the light comes in.\nremove wall\n# no more\n");
    put("model/plan.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"/>");
    put("model/tour/video.mp4", "film");
    put(in_edit("no-wall", "plan", ".svg"), "<svg xmlns=\"http://www.w3.org/2000/svg\"> </svg>");
    put(in_edit("no-wall", "tour/video", ".mp4"), "film");
    put(in_edit("no-wall", "export/model", ".obj"), "o");
    put(in_edit("no-wall", "export/model", ".glb"), "g");
    put(in_edit("no-wall", "export/model", ".ifc"), "i");
    char *page = page_of("loft", NULL);
    expect_words(page, "<h1>loft, remodelled</h1>");
    expect_words(page, "<h2>no wall</h2>");
    expect_words(page, "<p>The wall &lt;goes&gt;, and the light comes in.</p>");
    expect_words(page, "<p>2 photographs show it.</p>");
    expect_words(page, "data-photo=\"Photograph b\"");
    expect_words(page, "60 % of this picture is the photograph, 30 % comes from other photographs, 10 % is guessed");
    assert_int_equal(count_words(page, "<figure class=\"room\""), 2);
    assert_int_equal(count_words(page, "data-made=\"../page/"), 2);
    assert_int_equal(count_words(page, ".svg\"><figcaption>Plan "), 2);
    assert_int_equal(count_words(page, "<video "), 2);
    assert_int_equal(expect_links(page), 5);
    assert_null(strstr(page, "base64"));
    assert_null(strstr(page, "There "));
    free(page);
}

static void new_light_is_in_the_same_picture_as_the_change(void **state)
{
    struct remodel_contents c;
    (void)state;
    put_views();
    put_edit("no-wall");
    char *page = page_of("loft", NULL);
    expect_words(page, "a new window does not brighten the room yet");
    assert_null(strstr(page, "class=\"new\""));
    free(page);
    put_relit("no-wall", "a", 40);
    put_relit("no-wall", "b@0", 20);
    put_relit("no-wall", "b@1", 30);
    put_relit("no-wall", "c", 0);
    put("relight/no-wall/rounds.txt",
        "remodel-light-rounds 1\nsamples 9\nbounded 1\nsettled yes\nround 1 change 0.5 left "
        "unknown\nround 2 change 0.1 left 0.025\n");
    put("relight/no-wall/objects.txt", "remodel-object-light 1\n");
    read_all(&c);
    assert_int_equal(c.rooms.photo_count, 2);
    for (int i = 0; i < 2; i++) {
        const struct room_look *look = &c.rooms.photos[i].looks[0];
        assert_true(look->after.rgb && look->relit.rgb && look->made.rgb && look->ratio.rgb);
        /* 128 of exposure 2, shown at the exposure of 1.5 */
        assert_in_range(look->relit.rgb[0], 111, 113);
        assert_in_range(look->ratio.rgb[0], 127, 129);
    }
    remodel_contents_release(&c);
    page = page_of("loft", NULL);
    assert_int_equal(count_words(page, "<a class=\"new\""), 2);
    expect_words(page, "The light changes on 40 % of this picture. On 7 % the change is a cautious guess (striped)");
    expect_words(page, "The light changes on 25 % of this picture."); /* of b@0 and b@1 */
    expect_words(page, " 3 % keeps its light");
    expect_words(page,
                 "Light was followed from wall to wall 2 times; by that a place may miss up to 2.5 % of its light.");
    assert_null(strstr(page, "does not brighten the room yet"));
    free(page);
    put("relight/no-wall/rounds.txt", "remodel-light-rounds 1\nsettled no\nround 1 change 0.5 left unknown\n");
    put("relight/no-wall/a.txt", "remodel-relit 1\nsize 8 8\nexposure 2\nchanged 140\n");
    put("relight/no-wall/b@1.jpg", "no JPEG");
    page = page_of("loft", NULL);
    expect_words(page, "1 time; how much of it is still missing is unknown, more than was asked for.");
    expect_words(page, "a.txt:4: found &quot;140&quot;");
    expect_words(page, "b@1.jpg");
    assert_int_equal(count_words(page, "<a class=\"new\""), 0); /* b cannot be read, a has no new light */
    assert_int_equal(count_words(page, "<figure class=\"room\""), 1);
    free(page);
}

static void a_lamp_that_is_switched_changes_the_light_alone(void **state)
{
    struct remodel_contents c;
    (void)state;
    put_views();
    put(in_edit("lamp", "model", ".txt"), "");
    put_relit("lamp", "a", 60);
    struct picture_record same = {SIDE, SIDE, 1.5, 0, {0}};
    struct err err = ERR_INIT;
    same.shares[MADE_PHOTO] = 100;
    assert_ok(picture_record_write(&same, scratch_path("relight/lamp/unlit/a.txt"), &prov, &err), err);
    read_all(&c);
    assert_int_equal(c.rooms.photo_count, 1);
    assert_null(c.rooms.photos[0].looks[0].after.rgb);
    assert_non_null(c.rooms.photos[0].looks[0].relit.rgb);
    remodel_contents_release(&c);
    char *page = page_of("loft", NULL);
    expect_words(page, "In the old light this change alters nothing here.");
    assert_null(strstr(page, "not made yet: <code>make remodel"));
    free(page);
}

static void what_was_not_made_is_said_and_not_linked(void **state)
{
    (void)state;
    put_views();
    char *page = page_of("loft", NULL);
    expect_words(page, "There are no changes yet");
    assert_int_equal(expect_links(page), 0);
    free(page);
    put(in_edit("bare", "model", ".txt"), "");
    put(in_edit("removed-long-ago", "plan", ".svg"), ""); /* a folder without a model is none of an edit */
    page = page_of("loft", NULL);
    expect_words(page, "<h2>bare</h2>");
    expect_words(page, "The pictures of this change are not made yet: <code>make remodel SCENE=loft</code>");
    expect_words(page, "The plan of the rooms before is not made yet: <code>make model SCENE=loft</code>");
    expect_words(page, "The film of a walk through these rooms is not made yet: <code>make tour SCENE=loft</code>");
    expect_words(page, "The model for other programs is not made yet: <code>make exports SCENE=loft</code>");
    page_quality = "draft";
    char *draft = page_of("loft", NULL);
    page_quality = NULL;
    expect_words(
        draft,
        "The film of a walk through these rooms is not made yet: <code>make tour SCENE=loft QUALITY=draft</code>");
    free(draft);
    assert_null(strstr(page, "No photograph shows this change"));
    assert_null(strstr(page, "long ago"));
    assert_int_equal(expect_links(page), 0);
    free(page);
    put_sight("bare", "a", 0, 0);
    page = page_of("loft", NULL);
    expect_words(page, "No photograph shows this change.");
    assert_null(strstr(page, "The pictures of this change are not made"));
    free(page);
}

static void a_picture_that_cannot_be_read_is_left_out_with_the_reason(void **state)
{
    (void)state;
    put_views();
    put_edit("no-wall");
    put(in_edit("no-wall", "pictures/b@0", ".txt"), "remodel-picture 1\nsize 8 8\nexposure nan\n");
    put(in_edit("no-wall", "pictures/b@1", ".jpg"), "no JPEG");
    char *page = page_of("loft", NULL);
    expect_words(page, "b@0.txt:3: found &quot;nan&quot;");
    expect_words(page, "b@1.jpg");
    assert_int_equal(count_words(page, "<figure class=\"room\""), 1);
    expect_words(page, "data-photo=\"Photograph a\"");
    free(page);
    put(in_edit("no-wall", "pictures/a", ".jpg"), "");
    page = page_of("loft", NULL);
    expect_words(page, "The pictures of this change cannot be read");
    expect_links(page);
    free(page);
}

static void odd_names_are_escaped_and_their_links_lead_to_the_files(void **state)
{
    static const char edit[] = "a&b <c>\"d' #1 50% caf\xc3\xa9?";
    (void)state;
    put_views();
    put_edit(edit);
    put(in_edit(edit, "tour/video", ".mp4"), "film");
    put(in_edit(edit, "export/model", ".glb"), "g");
    char *page = page_of("<i>\"loft\"", NULL);
    expect_words(page, "<h1>&lt;i&gt;&quot;loft&quot;, remodelled</h1>");
    expect_words(page, "<h2>a&amp;b &lt;c&gt;&quot;d&#39; #1 50% caf\xc3\xa9?</h2>");
    expect_words(page, "make model SCENE=&lt;i&gt;&quot;loft&quot;");
    assert_null(strstr(page, "<c>"));
    assert_null(strstr(page, "<i>\""));
    assert_int_equal(expect_links(page), 2);
    free(page);
}

static void the_page_links_back_to_that_of_the_scene(void **state)
{
    (void)state;
    put_views();
    put("remodel/index.html", "");
    put("index.html", "");
    char *page = page_of("loft", "../index.html");
    expect_words(page, "<a href=\"../index.html\">The page of the scene</a>");
    assert_int_equal(expect_links(page), 1);
    free(page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(each_photo_has_one_picture_and_all_changes_that_it_shows, empty_scratch),
        cmocka_unit_test_setup(faces_of_a_panorama_are_one_place, empty_scratch),
        cmocka_unit_test_setup(what_is_known_comes_before_what_is_guessed, empty_scratch),
        cmocka_unit_test_setup(the_page_has_pictures_plans_films_and_exports, empty_scratch),
        cmocka_unit_test_setup(new_light_is_in_the_same_picture_as_the_change, empty_scratch),
        cmocka_unit_test_setup(a_lamp_that_is_switched_changes_the_light_alone, empty_scratch),
        cmocka_unit_test_setup(what_was_not_made_is_said_and_not_linked, empty_scratch),
        cmocka_unit_test_setup(a_picture_that_cannot_be_read_is_left_out_with_the_reason, empty_scratch),
        cmocka_unit_test_setup(odd_names_are_escaped_and_their_links_lead_to_the_files, empty_scratch),
        cmocka_unit_test_setup(the_page_links_back_to_that_of_the_scene, empty_scratch),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
