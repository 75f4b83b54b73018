/* shell.c - see shell.h: scenes, and pictures of them.
 *
 * A picture is drawn in two parts: which face each pixel shows (visible.c), then the faces' colours in passes
 * (shade.c). The first pass looks into the atlases of the two viewpoints; pixels that these do not show wait for the
 * next one, and only the pages that the remaining faces need are read for it. */
#include "stages/render_model/shell.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "stages/render_model/shell_scene.h"

static const double PLANE = 1e-4; /* of the model's size, and of a normal: planes of the map and the model are equal */
enum { MAX_SAMPLES = 16 };

/* ---------------------------------------------------------------------------------------------------------- scenes */

/* The face of the map with the id and the plane of a face of the model; NULL: none. */
static const struct texture_face *find_in_map(const struct shell_scene *s, int face)
{
    const struct solid_face *f = &s->mesh.faces[face];
    const int id = solid_face_id(&s->mesh, face);
    const struct texture_face *found = NULL;
    double least = PLANE;
    for (int i = 0; i < s->map.face_count; i++) {
        const struct texture_face *t = &s->map.faces[i];
        if (t->id != id) continue;
        const double turned = vec3_length(vec3_sub(t->normal, f->normal));
        const double off = fmax(turned, fabs(t->offset - f->offset) / s->model.size);
        if (off >= least) continue;
        least = off;
        found = t;
    }
    return found;
}

static enum status add_rule(struct shell_scene *s, int face, const struct texture_rule *rule, struct err *err)
{
    if (array_append(&s->rules, (size_t)s->rule_count, sizeof *s->rules, "rules", err)) return err->status;
    s->rules[s->rule_count++] = (struct shell_rule){.rule = *rule};
    s->faces[face].count++;
    return ST_OK;
}

/* Sets a face's rules, and whether it is drawn: panes are looked through unless they have a texture. */
static enum status set_face(struct shell_scene *s, int face, bool *drawn, struct err *err)
{
    const struct texture_face *t = find_in_map(s, face);
    const struct texture_rule itself = {.kind = TEXTURE_PLACE,
                                        .from = solid_face_id(&s->mesh, face),
                                        .matrix = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    s->ids[face + 1] = (uint32_t)itself.from;
    s->faces[face].first = s->rule_count;
    *drawn = !solid_face_is_pane(&s->mesh, face) || (t && t->rule_count && t->rules[0].kind != TEXTURE_OUTDOORS);
    if (!t) return add_rule(s, face, &itself, err);
    for (int i = 0; i < t->rule_count; i++)
        if (add_rule(s, face, &t->rules[i], err)) return err->status;
    return ST_OK;
}

static enum status set_faces(struct shell_scene *s, struct err *err)
{
    const size_t faces = (size_t)s->mesh.face_count;
    bool *drawn = calloc(faces + 1, sizeof *drawn);
    s->faces = calloc(faces + 1, sizeof *s->faces);
    s->ids = calloc(faces + 1, sizeof *s->ids);
    s->steps = calloc(faces + 1, sizeof *s->steps);
    s->open = calloc(faces + 1, sizeof *s->open);
    if (!drawn || !s->faces || !s->ids || !s->steps || !s->open) err_nomem(err, "faces", faces * sizeof *s->steps);
    s->model.size = 1;
    for (int i = 0; i < s->mesh.vertex_count; i++) {
        const struct vec3 p = s->mesh.vertices[i].p;
        s->model.size = fmax(s->model.size, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
    }
    for (int i = 0; !err->status && i < s->mesh.face_count; i++) set_face(s, i, &drawn[i], err);
    if (!err->status) visible_model_make(&s->model, &s->mesh, drawn, err);
    free(drawn);
    return err->status;
}

enum status shell_make(struct shell_scene **scene, struct solid_mesh *mesh, struct texture_map *map, const char *vdta,
                       const char *vita, int memory, struct err *err)
{
    struct shell_scene *s = *scene = calloc(1, sizeof *s);
    if (!s) {
        solid_mesh_release(mesh);
        texture_map_release(map);
        return err_nomem(err, "a scene", sizeof *s);
    }
    s->mesh = *mesh;
    s->map = *map;
    *mesh = (struct solid_mesh){0};
    *map = (struct texture_map){0};
    s->samples = 1;
    if (set_faces(s, err) || page_cache_open(&s->pages, vdta, vita, memory, err)) {
        shell_close(s);
        *scene = NULL;
        return err->status;
    }
    return ST_OK;
}

enum status shell_open(struct shell_scene **scene, const struct shell_files *files, struct provenance *prov,
                       struct err *err)
{
    struct solid_mesh mesh = {0};
    struct texture_map map = {0};
    struct provenance inputs = {0};
    *scene = NULL;
    solid_mesh_read(&mesh, files->model, &inputs, err);
    if (!err->status && files->map) texture_map_read(&map, files->map, &inputs, err);
    if (err->status)
        solid_mesh_release(&mesh);
    else
        shell_make(scene, &mesh, &map, files->vdta, files->vita, files->memory, err);
    if (err->status) {
        provenance_release(&inputs);
        return err->status;
    }
    (*scene)->prov = prov;
    (*scene)->inputs = inputs;
    return ST_OK;
}

void shell_close(struct shell_scene *s)
{
    if (!s) return;
    page_cache_close(s->pages);
    visible_release(&s->seen);
    visible_model_release(&s->model);
    model_picture_release(&s->sample);
    texture_map_release(&s->map);
    solid_mesh_release(&s->mesh);
    provenance_release(&s->inputs);
    free(s->faces);
    free(s->rules);
    free(s->ids);
    free(s->steps);
    free(s->tiles);
    free((void *)s->open);
    free(s->done);
    free(s);
}

const struct texture_map *shell_map(const struct shell_scene *scene) { return &scene->map; }

void shell_set_samples(struct shell_scene *scene, int samples)
{
    scene->samples = samples < 1 ? 1 : samples > MAX_SAMPLES ? MAX_SAMPLES : samples;
}

/* -------------------------------------------------------------------------------------------------------- a picture */

/* A new picture begins: its inputs are recorded, and the atlases found. Equal viewpoints are one. */
static enum status begin_picture(struct shell_scene *s, struct shell_atlases *a, const char *const photos[2],
                                 struct err *err)
{
    const bool one = photos[0] && photos[1] && !strcmp(photos[0], photos[1]);
    *a = (struct shell_atlases){0};
    page_cache_next(s->pages, s->prov);
    if (s->prov && provenance_add_all(s->prov, &s->inputs, err)) return err->status;
    for (int i = 0; i < 2; i++)
        if (photos[i] && !(one && i) && page_cache_find(s->pages, photos[i], &a->pair[i], err)) return err->status;
    return page_cache_find(s->pages, NULL, &a->vita, err);
}

static enum status check(const struct view *camera, double t, struct err *err)
{
    if (camera->width < 1 || camera->height < 1 || !(camera->fx > 0) || !(camera->fy > 0) ||
        !isfinite(camera->center.x + camera->center.y + camera->center.z))
        return err_set(err, ST_DATA, "a camera of %d x %d px with focal lengths %g and %g cannot see the model.",
                       camera->width, camera->height, camera->fx, camera->fy);
    if (!(t >= 0 && t <= 1)) return err_set(err, ST_DATA, "the share of the second viewpoint is %g, wanted 0 to 1.", t);
    return ST_OK;
}

static int max_tiles(const struct shell_scene *s)
{
    int most = 1;
    for (int i = 0; i <= s->mesh.face_count; i++) {
        const int tiles = s->steps[i].a_count + s->steps[i].b_count;
        if (tiles > most) most = tiles;
    }
    return most;
}

/* The picture of one sample a pixel. `out` has the camera's size. */
static enum status draw_once(struct model_picture *out, struct shell_scene *s, const struct view *camera,
                             const struct shell_atlases *a, double t, const struct outdoors *outdoors, struct err *err)
{
    const size_t faces = (size_t)s->mesh.face_count;
    if (visible_draw(&s->seen, &s->model, camera, err)) return err->status;
    const size_t tiles = (size_t)s->seen.columns * (size_t)s->seen.rows;
    if (array_reserve(&s->done, &s->done_room, tiles, 1, "tiles", err)) return err->status;
    struct shade_pass pass = {.seen = &s->seen,
                              .camera = camera,
                              .outdoors = outdoors,
                              .steps = s->steps,
                              .ids = s->ids,
                              .t = (float)(a->pair[0] && a->pair[1] ? t : 0),
                              .open = s->open,
                              .done = s->done,
                              .out = out};
    memset((void *)s->open, 0, faces + 1);
    shade_mark_seen(&pass);
    for (int i = 0;; i++) {
        bool any;
        if (shell_steps_make(s, i, camera, a, outdoors, &any, err)) return err->status;
        if (!any && i) return ST_OK;
        pass.first = !i;
        pass.tiles = s->tiles;
        pass.max_tiles = max_tiles(s);
        memset((void *)s->open, 0, faces + 1);
        if (shade_pixels(&pass, err)) return err->status;
    }
}

/* Replaces the colours of `out` by the mean over places in each pixel, in a fixed order. */
static enum status average(struct model_picture *out, struct shell_scene *s, const struct view *camera,
                           const struct shell_atlases *a, double t, const struct outdoors *outdoors, struct err *err)
{
    const size_t values = 3 * (size_t)out->width * (size_t)out->height;
    const int n = s->samples;
    if (model_picture_resize(&s->sample, out->width, out->height, err)) return err->status;
    memset(out->rgb, 0, values * sizeof *out->rgb);
    for (int k = 0; k < n * n; k++) {
        struct view moved = *camera;
        moved.cx -= (k % n + 0.5) / n - 0.5;
        moved.cy -= (k / n + 0.5) / n - 0.5;
        if (draw_once(&s->sample, s, &moved, a, t, outdoors, err)) return err->status;
        for (size_t i = 0; i < values; i++) out->rgb[i] += s->sample.rgb[i];
    }
    const float share = 1.0f / (float)(n * n);
    for (size_t i = 0; i < values; i++) out->rgb[i] = out->made[i / 3] == MADE_NOTHING ? 0 : share * out->rgb[i];
    return ST_OK;
}

enum status shell_draw(struct model_picture *out, struct shell_scene *s, const struct view *camera,
                       const char *const photos[2], double t, const struct outdoors *outdoors, struct err *err)
{
    struct shell_atlases a;
    if (check(camera, t, err) || begin_picture(s, &a, photos, err)) return err->status;
    if ((out->width != camera->width || out->height != camera->height) &&
        model_picture_resize(out, camera->width, camera->height, err))
        return err->status;
    if (draw_once(out, s, camera, &a, t, outdoors, err)) return err->status;
    return s->samples > 1 ? average(out, s, camera, &a, t, outdoors, err) : ST_OK;
}

enum status shell_prepare(struct shell_scene *s, const char *const photos[2], struct err *err)
{
    struct shell_atlases a;
    if (begin_picture(s, &a, photos, err)) return err->status;
    for (int i = 0; i < 2; i++)
        for (int page = 0; a.pair[i] && page < a.pair[i]->atlas.page_count; page++)
            if (page_cache_load(s->pages, a.pair[i], page, err)) return err->status;
    return ST_OK;
}
