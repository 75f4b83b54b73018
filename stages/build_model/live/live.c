/* live.c - the model of a scene while somebody draws it; see live.h.
 *
 *  * It does what build_model does: it reads the same files, and its model has the same bytes. A model that cannot be
 * built leaves the last one in place, so that a page goes on showing it beside the reason. */
#include "stages/build_model/live/live.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/memory_text.h"
#include "common/base/textfile.h"
#include "common/base/version.h"
#include "common/model/scene_inputs.h"
#include "stages/build_model/building/building.h"
#include "stages/build_model/live/draft.h"
#include "stages/build_model/live/live_json.h"
#include "stages/build_model/picture/overlay_edges.h"
#include "stages/build_model/picture/plan_picture.h"

static struct {
    struct model_params params;
    struct scene_inputs in, no_held;
    struct placer placer;
    struct provenance prov;
    int inputs; /* of prov, without those of a model */
    struct building building;
    bool built;
    struct draft draft;          /* of `building` against the rooms as they were photographed */
    struct building_files files; /* of `building`; only `base` and `scene` stay */
    char base[FILE_PATH], scene[FILE_PATH];
    struct err err;
    char *model, *photos;
    double *numbers;
    size_t number_count;
    const char *picked;
} live;

void *live_alloc(size_t size) { return malloc(size); }
void live_free(void *memory) { free(memory); }
const char *live_error(void) { return live.err.text; }
const double *live_numbers(void) { return live.numbers; }
const char *live_picked(void) { return live.picked ? live.picked : ""; }
double live_ceiling(void) { return live.in.axes.ceiling; }
int live_is_metric(void) { return live.in.axes.metric; }

/* NULL in place of "" */
static const char *given(const char *text) { return text && *text ? text : NULL; }

void live_end(void)
{
    draft_release(&live.draft);
    building_release(&live.building);
    place_memory_free(live.placer.memory);
    place_release(&live.placer);
    scene_inputs_release(&live.in);
    provenance_release(&live.prov);
    free(live.model);
    free(live.photos);
    free(live.numbers);
    memset(&live, 0, sizeof live);
}

static enum status keep_params(struct err *err)
{
    struct memory_text m = {0};
    if (memory_text_open(&m, "the parameters", err)) return err->status;
    params_print(model_param_table, &live.params, "build_model", m.to);
    if (!memory_text_close(&m, "the parameters", err)) live.prov.params = m.text;
    return err->status;
}

/* Lines "key = value", as params_print() writes them, without the library that reads the files of people. */
static enum status read_params(const char *path, struct err *err)
{
    struct textfile t = {0};
    textfile_open(&t, path, err);
    while (!err->status && textfile_next(&t)) {
        char *key, *is, *value, assignment[2 * PARAM_TEXT_SIZE];
        if (textfile_word(&t, "a parameter", &key, err) || *key == '[') continue;
        if (textfile_word(&t, "=", &is, err) || textfile_word(&t, "a value", &value, err)) break;
        snprintf(assignment, sizeof assignment, "%s=%s", key, value);
        params_set(model_param_table, &live.params, assignment, err);
    }
    textfile_release(&t);
    return err->status;
}

int live_begin(const char *views, const char *axes, const char *points, const char *config)
{
    const struct scene_files files = {.views = views, .axes = axes};
    struct point_cloud cloud = {0};
    live_end();
    live.params = (struct model_params)MODEL_PARAMS_DEFAULT;
    live.prov = (struct provenance){.stage = "build_model", .version = REMODEL_VERSION};
    log_set_name("build_model");
    const struct placer_views placed[2] = {{&live.in.set, &live.in.lenses}, {&live.no_held.set, &live.no_held.lenses}};
    struct err *err = &live.err;
    if (given(config)) read_params(config, err);
    if (!err->status) keep_params(err);
    if (!err->status &&
        !scene_inputs_read(&live.in, SCENE_AXES | SCENE_POINTS | SCENE_LENSES, &files, &live.prov, err) &&
        given(points))
        point_cloud_read(&cloud, points, &live.prov, err);
    if (!err->status) place_init(&live.placer, placed, &live.in.axes, given(points) ? &cloud : NULL, &live.params, err);
    if (!err->status) live.placer.memory = place_memory_new();
    point_cloud_release(&cloud);
    live.inputs = live.prov.count;
    return err->status;
}

int live_build(const char *script, const char *things, const char *edit, const char *scene, const char *base)
{
    const struct building_files files = {script, given(things), given(edit), given(base), given(scene)};
    struct building made = {0};
    live.err = (struct err)ERR_INIT;
    provenance_keep(&live.prov, live.inputs);
    if (building_make(&made, &files, &live.in.axes, &live.placer, &live.prov, &live.err)) {
        building_release(&made);
        return live.err.status;
    }
    draft_end(&live.draft);
    building_release(&live.building);
    live.building = made;
    live.built = true;
    live.picked = NULL;
    live.files = (struct building_files){0};
    if (files.base && snprintf(live.base, sizeof live.base, "%s", files.base) > 0) live.files.base = live.base;
    if (files.scene && snprintf(live.scene, sizeof live.scene, "%s", files.scene) > 0) live.files.scene = live.scene;
    return live.err.status;
}

/* There is a model. */
static bool is_built(void)
{
    live.err = (struct err)ERR_INIT;
    if (!live.built) err_set(&live.err, ST_USAGE, "nothing was built yet.");
    return live.built;
}

int live_write(const char *folder)
{
    if (!is_built()) return live.err.status;
    if (live.files.base) building_write_edit(&live.building, &live.files, folder, &live.prov, &live.err);
    if (!live.err.status) building_write(&live.building, folder, &live.prov, &live.err);
    return live.err.status;
}

int live_write_plan(const char *path)
{
    if (!is_built()) return live.err.status;
    return plan_picture_write(&live.building.plan, &live.placer, live.in.axes.metric, path, &live.err);
}

const char *live_model(void)
{
    free(live.model);
    live.model = NULL;
    if (is_built()) live_json_model(&live.model, &live.building, &live.err);
    return live.model;
}

const char *live_photos(void)
{
    free(live.photos);
    live.photos = NULL;
    live.err = (struct err)ERR_INIT;
    live_json_photos(&live.photos, &live.placer, &live.err);
    return live.photos;
}

/* ---------------------------------------------------------------------------------------------------------- numbers */

static enum status add_numbers(const double *v, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (array_append(&live.numbers, live.number_count, sizeof *live.numbers, "numbers", &live.err)) break;
        live.numbers[live.number_count++] = v[i];
    }
    return live.err.status;
}

static void begin_numbers(void)
{
    live.err = (struct err)ERR_INIT;
    free(live.numbers);
    live.numbers = NULL;
    live.number_count = 0;
}

int live_plan_place(void)
{
    double place[3];
    if (!is_built()) return live.err.status;
    plan_picture_place(&live.building.plan, &live.placer, place);
    begin_numbers();
    return add_numbers(place, 3);
}

static const struct photo_camera *camera_of(int photo)
{
    begin_numbers();
    if (photo >= 0 && photo < live.placer.photo_count) return &live.placer.photos[photo].camera;
    err_set(&live.err, ST_USAGE, "found photo %d, wanted 0 to %d.", photo, live.placer.photo_count - 1);
    return NULL;
}

struct dots {
    int last; /* half-edge */
};

static void add_dot(void *ctx, const struct overlay_dot *dot)
{
    struct dots *d = ctx;
    const double numbers[3] = {dot->u, dot->v,
                               (dot->seen ? 1 : 0) + (dot->glass ? 2 : 0) + (dot->half_edge != d->last ? 4 : 0)};
    d->last = dot->half_edge;
    add_numbers(numbers, 3);
}

int live_edges(int photo, double apart)
{
    const struct photo_camera *camera = camera_of(photo);
    struct dots dots = {-1};
    if (!camera || !live.built) return camera ? 0 : -1;
    const struct overlay_edges how = {camera, 1, camera->lens.width, camera->lens.height, apart, .steps = 512};
    overlay_edges_trace(&live.building.mesh, &how, add_dot, &dots, &live.err);
    return live.err.status ? -1 : (int)(live.number_count / 3);
}

int live_points(int photo, int most)
{
    const struct photo_camera *camera = camera_of(photo);
    if (!camera) return -1;
    const size_t step = most > 0 && live.placer.count > (size_t)most ? live.placer.count / (size_t)most : 1;
    for (size_t i = 0; i < live.placer.count && !live.err.status; i += step) {
        const struct placed_point *p = &live.placer.points[i];
        const struct vec3 at = vec3_make(p->position[0], p->position[1], p->position[2]);
        const struct vec3 normal = vec3_make(p->normal[0], p->normal[1], p->normal[2]);
        double u, v;
        if (!(vec3_dot(normal, vec3_sub(at, camera->center)) < 0) || !photo_camera_project(camera, at, &u, &v) ||
            !(u >= 0 && v >= 0 && u < camera->lens.width && v < camera->lens.height))
            continue;
        const double near = 0.9;
        const double numbers[3] = {u, v,
                                   fabs(normal.x) > near   ? 0
                                   : fabs(normal.y) > near ? 1
                                   : fabs(normal.z) > near ? 2
                                                           : 3};
        add_numbers(numbers, 3);
    }
    return live.err.status ? -1 : (int)(live.number_count / 3);
}

int live_ray(int photo, double u, double v)
{
    const struct photo_camera *camera = camera_of(photo);
    struct vec3 ray;
    if (!camera) return live.err.status;
    if (!photo_camera_ray(camera, u, v, &ray))
        return err_set(&live.err, ST_DATA, "the lens has no ray at pixel %.9g %.9g; choose another pixel.", u, v);
    const double numbers[6] = {camera->center.x, camera->center.y, camera->center.z, ray.x, ray.y, ray.z};
    return add_numbers(numbers, 6);
}

int live_project(int photo, double x, double y, double z)
{
    const struct photo_camera *camera = camera_of(photo);
    double at[2];
    if (!camera) return live.err.status;
    if (!photo_camera_project(camera, vec3_make(x, y, z), &at[0], &at[1]))
        return err_set(&live.err, ST_DATA, "the lens does not show this place.");
    return add_numbers(at, 2);
}

/* Distance along the ray to a triangle that it meets from outside; HUGE_VAL: it meets none. */
static double meet(const struct solid_mesh *m, const struct solid_triangle *t, struct vec3 from, struct vec3 ray)
{
    const struct vec3 a = m->vertices[t->v[0]].p, ab = vec3_sub(m->vertices[t->v[1]].p, a),
                      ac = vec3_sub(m->vertices[t->v[2]].p, a), to = vec3_sub(from, a);
    const struct vec3 p = vec3_cross(ray, ac), q = vec3_cross(to, ab);
    const double det = vec3_dot(ab, p);
    if (!(det > 1e-12)) return HUGE_VAL;
    const double u = vec3_dot(to, p) / det, v = vec3_dot(ray, q) / det, at = vec3_dot(ac, q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && at > 0 ? at : HUGE_VAL;
}

int live_pick(int photo, double u, double v)
{
    struct solid_triangles tris = {0};
    live.picked = NULL;
    if (!is_built() || live_ray(photo, u, v)) return live.err.status;
    const struct vec3 from = vec3_make(live.numbers[0], live.numbers[1], live.numbers[2]),
                      ray = vec3_make(live.numbers[3], live.numbers[4], live.numbers[5]);
    const struct solid_mesh *m = &live.building.mesh;
    double nearest = HUGE_VAL;
    if (!solid_mesh_triangulate(&tris, m, &live.err))
        for (int i = 0; i < tris.count; i++) {
            const double at = meet(m, &tris.triangles[i], from, ray);
            if (!(at < nearest)) continue;
            nearest = at;
            live.picked = solid_face_name(m, tris.triangles[i].face);
        }
    solid_triangles_release(&tris);
    begin_numbers();
    if (!live.picked) return err_set(&live.err, ST_DATA, "this pixel shows no face of the model.");
    const struct vec3 at = vec3_add(from, vec3_scale(ray, nearest));
    const double numbers[3] = {at.x, at.y, at.z};
    return add_numbers(numbers, 3);
}

/* ------------------------------------------------------------------------------------------------------------ draft */

int live_thing(const char *name, double x, double y, double z, double radius, int hangs)
{
    live.err = (struct err)ERR_INIT;
    return draft_things_add(&live.draft.things, name, vec3_make(x, y, z), radius, hangs != 0, &live.err);
}

float *live_thing_corners(int thing, int triangles)
{
    live.err = (struct err)ERR_INIT;
    return draft_things_corners(&live.draft.things, thing, triangles, &live.err);
}

unsigned char *live_mask(int photo, int columns, int rows)
{
    if (!camera_of(photo)) return NULL;
    return draft_things_mask(&live.draft.things, photo, columns, rows, &live.err);
}

int live_draft(const char *script, const char *things)
{
    const struct building_files files = {.script = script, .things = given(things)};
    if (!is_built()) return live.err.status;
    draft_end(&live.draft);
    provenance_keep(&live.prov, live.inputs);
    if (building_make(&live.draft.before, &files, &live.in.axes, &live.placer, &live.prov, &live.err) ||
        draft_begin(&live.draft, &live.building, live.files.scene, &live.err))
        draft_end(&live.draft);
    return live.err.status;
}

int live_draft_rows(int photo, int columns, int rows, int first, int count)
{
    const struct photo_camera *c = camera_of(photo);
    if (!c) return -1;
    if (!draft_is_begun(&live.draft) || columns < 1 || rows < 1) {
        err_set(&live.err, ST_USAGE, "the draft of an edit was not begun.");
        return -1;
    }
    for (int y = first; y < first + count && y < rows; y++)
        for (int x = 0; x < columns && !live.err.status; x++) {
            const double u = (x + 0.5) * c->lens.width / columns, v = (y + 0.5) * c->lens.height / rows;
            const struct draft_pixel p = draft_pixel_of(&live.draft, &live.placer, photo, u, v);
            add_numbers((const double[]){p.kind, p.photo, p.at[0], p.at[1], p.at[2]}, 5);
        }
    return live.err.status ? -1 : (int)(live.number_count / 5);
}

int live_shared(int photo, int other, int columns, int rows)
{
    const struct photo_camera *c = camera_of(other) ? camera_of(photo) : NULL;
    for (int y = 0; c && draft_is_begun(&live.draft) && y < rows; y++)
        for (int x = 0; x < columns && !live.err.status; x++) {
            double at[4] = {(x + 0.5) * c->lens.width / columns, (y + 0.5) * c->lens.height / rows};
            if (draft_other_pixel(&live.draft, &live.placer, photo, at[0], at[1], other, at + 2)) add_numbers(at, 4);
        }
    return live.err.status ? -1 : (int)(live.number_count / 4);
}

int live_draft_gone(void)
{
    begin_numbers();
    const struct draft_things *t = &live.draft.things;
    for (int i = 0; i < t->thing_count; i++) add_numbers(&(double){t->things[i].is_gone}, 1);
    return live.err.status ? -1 : t->thing_count;
}

int live_draft_placed(void)
{
    begin_numbers();
    const struct draft_things *t = &live.draft.things;
    for (int i = 0; i < t->placed_count; i++) {
        const struct vec3 at = draft_things_middle(t, i);
        add_numbers((const double[]){t->placed[i].thing, at.x, at.y, at.z}, 4);
    }
    return live.err.status ? -1 : t->placed_count;
}
