/* scene_rules.c - see scene_rules.h. */
#include "common/graph/scene_rules.h"

#include <stdio.h>
#include <string.h>

#include "common/base/textfile.h"

void rule_originals(struct graph *g, const char *option)
{
    if (*scene_setting("SPLIT"))
        rule_option(g, option, FOLDER(g, SPLIT_LIST));
    else if (path_is_file(PATH(g, CLIP_LIST)))
        rule_option(g, option, FOLDER(g, CLIP_LIST));
    else
        rule_variable(g, option, "PHOTOS");
}

void rule_photos(struct graph *g, const struct scene_facts *f, const char *option)
{
    if (f->bracketed)
        rule_option(g, option, FOLDER(g, HDR, .photo = ""));
    else
        rule_originals(g, option);
}

const char *scene_photo_source(struct graph *g, const struct scene_facts *f, const char *photo)
{
    return f->bracketed ? PATH(g, HDR, .photo = photo) : PATH(g, PHOTO, .photo = photo);
}

bool scene_matches_photos(struct graph *g, const struct scene_facts *f)
{
    char line[16] = "";
    if (f->photos.count == 1) return false;
    if (!*scene_setting("SFM")) return true;
    FILE *fp = fopen(graph_shared(g, "stamp/sfm_points.txt"), "re");
    const bool few = fp && fgets(line, sizeof line, fp) && !strncmp(line, "few", 3);
    if (fp) fclose(fp);
    return few;
}

void rule_masks(struct graph *g, const struct scene_facts *f)
{
    const char *masks = graph_text(g, "%s/masks", f->folder);
    if (path_is_folder(masks)) rule_option(g, "--masks", masks);
}

const char *scene_response(struct graph *g)
{
    const char *given = graph_scene_file(g, "response.txt");
    return given ? given : PATH(g, RESPONSE);
}

void rule_needs_response(struct graph *g)
{
    rule_needs(g, scene_response(g));
    if (!graph_scene_file(g, "response.txt")) rule_after(g, graph_shared(g, "stamp/response.txt"));
}

const char *scene_model_folder(struct graph *g, const struct name_list *edits, int i)
{
    return i < 0 ? "model" : graph_text(g, "remodel/%s", edits->names[i]);
}

bool scene_model_is_edited(const char *model) { return strchr(model, '/') != NULL; }

const char *scene_model_name(const char *model) { return path_file_name(model); }

bool rule_needs_references(struct graph *g, const struct scene_facts *f)
{
    bool any = false;
    for (int i = 0; i < f->references.count; i++) {
        const char *path = PATH(g, LRI, .photo = f->references.names[i]);
        if (!path_is_file(path)) continue;
        any = true;
        rule_needs(g, path);
    }
    return any;
}

bool scene_has_references(struct graph *g, const struct scene_facts *f)
{
    for (int i = 0; i < f->references.count; i++)
        if (path_is_file(PATH(g, LRI, .photo = f->references.names[i]))) return true;
    return false;
}

const char *scene_lights(struct graph *g, const struct scene_facts *f)
{
    return f->has_model && graph_scene_file(g, "lights.txt") ? PATH(g, LIGHTS) : NULL;
}

const char *scene_materials(struct graph *g, const struct scene_facts *f)
{
    return f->has_model && graph_scene_file(g, "materials.txt") ? PATH(g, MATERIALS) : NULL;
}

const char *scene_lux_scale(struct graph *g, const struct scene_facts *f)
{
    const char *scale = PATH(g, LUX_SCALE);
    return f->has_model && (graph_scene_file(g, "lux.txt") || path_is_file(scale)) ? scale : NULL;
}

bool scene_has_webs(struct graph *g, const struct scene_facts *f)
{
    struct name_list webs = {0};
    name_list_add_files(&webs, f->folder, "", ".ies", graph_err(g));
    const bool any = webs.count > 0;
    name_list_release(&webs);
    return any;
}

void rule_needs_webs(struct graph *g, const struct scene_facts *f)
{
    struct name_list webs = {0};
    name_list_add_files(&webs, f->folder, "", ".ies", graph_err(g));
    for (int i = 0; i < webs.count; i++) rule_needs(g, graph_text(g, "%s/%s.ies", f->folder, webs.names[i]));
    name_list_release(&webs);
}

void rule_needs_light_change(struct graph *g, const struct scene_facts *f, const char *edit)
{
    const char *edited = graph_text(g, "remodel/%s", edit);
    rule_needs(g, PATH(g, MODEL));
    rule_needs(g, PATH(g, MODEL, .model = edited));
    rule_needs(g, PATH(g, TEXTURE_MAP, .model = edited));
    rule_needs(g, PATH(g, OBJECTS, .model = edited));
    rule_needs(g, PATH(g, AXES));
    rule_needs(g, PATH(g, ATLAS));
    rule_needs(g, PATH(g, OUTDOORS));
    if (f->views.count) rule_needs(g, PATH(g, THINGS));
    if (f->views.count) rule_needs(g, PATH(g, THING_VOLUME));
    if (scene_has_webs(g, f)) { /* that the edit may hang lamps by */
        const char *scale = scene_lux_scale(g, f);
        rule_needs_webs(g, f);
        rule_needs(g, PATH(g, PLAN, .model = edited));
        if (scale) rule_needs(g, scale);
        rule_needs(g, graph_stamp(g, "lux_scale.txt", scale ? scale : "none"));
    }
    if (!scene_lights(g, f)) return;
    rule_needs(g, scene_lights(g, f));
    rule_needs_references(g, f);
}

void rule_light_change(struct graph *g, const struct scene_facts *f, const char *edit)
{
    const char *edited = graph_text(g, "remodel/%s", edit);
    rule_option(g, "--model", PATH(g, MODEL));
    rule_option(g, "--edited", PATH(g, MODEL, .model = edited));
    rule_option(g, "--map", PATH(g, TEXTURE_MAP, .model = edited));
    rule_option(g, "--axes", PATH(g, AXES));
    rule_option(g, "--vita", FOLDER(g, ATLAS));
    rule_option(g, "--outdoors", PATH(g, OUTDOORS));
    rule_option(g, "--lights", scene_lights(g, f));
    if (scene_lights(g, f) && scene_has_references(g, f)) rule_option(g, "--references", FOLDER(g, LRI, .photo = ""));
    rule_option(g, "--objects", PATH(g, OBJECTS, .model = edited));
    if (f->views.count) rule_option(g, "--things", FOLDER(g, THINGS));
    if (scene_has_webs(g, f)) {
        rule_option(g, "--edited-plan", PATH(g, PLAN, .model = edited));
        rule_option(g, "--lux-scale", scene_lux_scale(g, f));
    }
    rule_option(g, "--scene", f->folder);
}

void graph_list_if(struct graph *g, enum graph_list_kind list, const char *path, bool wanted)
{
    if (wanted || path_is_file(path)) graph_list(g, list, path);
}

bool scene_asks_for_any(const struct scene_facts *f, const char *words)
{
    for (int i = 0; i < f->products.count; i++) {
        const char *word = f->products.names[i], *at = strstr(words, word);
        const size_t n = strlen(word);
        if (at && (at == words || at[-1] == ' ') && (at[n] == ' ' || !at[n])) return true;
    }
    return false;
}

void rule_needs_path(struct graph *g, const char *film)
{
    rule_needs(g, PATH(g, PATH, .film = film));
    rule_needs(g, PATH(g, PATH_CAMERAS, .film = film));
    rule_needs(g, PATH(g, PATH_IMAGES, .film = film));
    rule_needs(g, PATH(g, PATH_POINTS, .film = film));
}

void rule_needs_tour(struct graph *g, const char *tour)
{
    rule_needs(g, PATH(g, PATH, .film = tour));
    rule_needs(g, PATH(g, TOUR_PAIRS, .film = tour));
    rule_needs(g, PATH(g, PATH_CAMERAS, .film = tour));
    rule_needs(g, PATH(g, PATH_IMAGES, .film = tour));
}

void rule_encodes(struct graph *g, const char *film, const struct name_list *frames, const char *planned)
{
    const char *video = PATH(g, VIDEO, .film = film);
    rule_by(g, "encode_video");
    rule_makes(g, video);
    for (int i = 0; i < frames->count; i++) rule_needs(g, PATH(g, FRAME, .film = film, .frame = frames->names[i]));
    rule_option(g, "--path", graph_own(g, planned));
    rule_option(g, "--frames", FOLDER(g, FRAME, .film = film, .frame = ""));
    rule_option(g, "--out", video);
}

bool scene_film_is_given(const char *film) { return scene_setting_is("GIVEN_FILM", film); }

bool scene_film_is_free(struct graph *g, const char *film)
{
    return scene_film_is_given(film) || graph_scene_file(g, graph_text(g, "keyframes/%s.txt", film));
}

const char *scene_item(struct graph *g, const char *eye)
{
    if (!*eye) return "";
    return scene_is_half_sphere(eye) ? graph_text(g, "-vr180-%s", strrchr(eye, '/') + 1)
                                     : graph_text(g, "-%s", strrchr(eye, '/') + 1);
}

bool scene_is_half_sphere(const char *eye) { return !strncmp(eye, "/vr180", 6); }

void scene_tour_frames_read(struct graph *g, struct name_list *frames, const char *tour)
{
    struct textfile t = {0};
    struct err unread = ERR_INIT; /* it has not been planned, or the program that reads it says what is wrong */
    const char *path = PATH(g, PATH, .film = tour);
    char *word;
    if (!path_is_file(path) || textfile_open(&t, path, &unread)) return;
    while (!unread.status && textfile_next(&t))
        if (!textfile_word(&t, "a word", &word, &unread) && !strcmp(word, "frame") &&
            !textfile_word(&t, "a number", &word, &unread))
            name_list_add(frames, word, strlen(word), graph_err(g));
    textfile_release(&t);
}

void rule_draws_model(struct graph *g, const char *model)
{
    const char *file = PATH(g, MODEL, .model = model);
    const char *map = scene_model_is_edited(model) ? PATH(g, TEXTURE_MAP, .model = model) : NULL;
    rule_takes(g, "--model", file);
    rule_takes(g, "--map", map);
    rule_takes(g, "--base", map ? PATH(g, MODEL) : NULL);
    rule_takes(g, "--axes", PATH(g, AXES));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_takes_vita(g);
    rule_takes(g, "--outdoors", PATH(g, OUTDOORS));
    rule_takes(g, "--exposure", PATH(g, EXPOSURE));
    rule_after(g, graph_own(g, "stamp/exposure.txt"));
    rule_needs(g, PATH(g, THINGS));
    rule_needs(g, PATH(g, THING_VOLUME));
    rule_option(g, "--things", FOLDER(g, THINGS));
    rule_option(g, "--vdta", graph_own(g, "vdta"));
    rule_option(g, "--ids", FOLDER(g, FACE_INDEX));
    rule_option(g, "--depth", FOLDER(g, DEPTH, .depth = MODEL_DEPTH, .view = ""));
}

void rule_draws_photo(struct graph *g, const char *edit, const char *pictures, const struct photo_views *p,
                      const char *goal)
{
    rule_draws_model(g, graph_text(g, "remodel/%s", edit));
    rule_needs(g, PATH(g, ATLAS, .atlas = graph_text(g, "vdta/%s", p->photo)));
    for (int i = 0; i < p->count; i++) {
        const char *record = PATH(g, PICTURE_RECORD, .pictures = pictures, .name = p->views[i]);
        rule_makes(g, record);
        graph_goal(g, goal, record);
        rule_needs(g, PATH(g, VIEW, .view = p->views[i]));
        rule_needs(g, PATH(g, THING_MASK, .view = p->views[i]));
        rule_needs(g, PATH(g, IDS, .view = p->views[i]));
        rule_needs(g, PATH(g, DEPTH, .depth = MODEL_DEPTH, .view = p->views[i]));
        rule_option(g, "--view", p->views[i]);
    }
    rule_option(g, "--out", graph_own(g, pictures));
}

int scene_chunk_size(const struct scene_facts *f, const struct name_list *frames, int first)
{
    const int left = frames->count - first;
    return left < f->frames_per_job ? left : f->frames_per_job;
}

void rule_takes_cameras(struct graph *g)
{
    rule_needs_cameras(g);
    rule_option(g, "--views", FOLDER(g, CAMERAS));
}

void rule_takes_depth(struct graph *g)
{
    rule_needs_set(g, "depth");
    rule_option(g, "--depth", FOLDER(g, DEPTH, .view = ""));
}

void rule_takes_ids(struct graph *g)
{
    rule_needs_set(g, "ids");
    rule_option(g, "--ids", FOLDER(g, FACE_INDEX));
}

void rule_takes_vita(struct graph *g)
{
    rule_needs(g, PATH(g, ATLAS));
    rule_option(g, "--vita", FOLDER(g, ATLAS));
}

void rule_takes_things(struct graph *g, const struct scene_facts *f)
{
    if (!f->views.count) return;
    rule_needs(g, PATH(g, THINGS));
    rule_needs(g, PATH(g, THING_VOLUME));
    rule_option(g, "--things", FOLDER(g, THINGS));
}

void rule_takes_seen_model(struct graph *g)
{
    rule_takes(g, "--model", PATH(g, MODEL));
    rule_takes(g, "--axes", PATH(g, AXES));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_needs_set(g, "views");
    rule_takes_ids(g);
}

void rule_needs_held_cameras(struct graph *g)
{
    static const enum product_id files[] = {PRODUCT_CAMERAS, PRODUCT_IMAGES, PRODUCT_POINTS3D, PRODUCT_LENSES,
                                            PRODUCT_VIEWS_MK};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        rule_needs(g, graph_path(g, files[i], &(struct product_key){.views = HELD_VIEWS}));
}
