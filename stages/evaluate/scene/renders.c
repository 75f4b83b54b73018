/* renders.c - rendered pictures and the true pictures that they belong to.
 *
 * Overview. Before pictures can be compared pixel by pixel, each needs the map from its pixels to those of the true
 * picture. Both were taken from one place, but with different lenses and in different worlds.
 *
 * Own cameras. A picture's camera is in the frame of the scene; the similarity of the cameras (evaluate_cameras.c)
 * gives its centre and axes in the world of the truth:  true_from_picture = R_true R_similarity R_picture'.  The two
 * centres are never equal, because cameras are estimated. Parallax between them is no error of the picture, so
 * pictures that are farther than [evaluate] max_offset are left out, with a note.
 *
 * Views. A picture that is named like a view was rendered with that view's camera, and is compared with the true
 * picture of the view's photograph through the photograph's lens. No similarity is needed.
 *
 * In both cases the true picture is resampled to the rendered one, never the other way: what is measured are the
 * pixels that were made.
 *
 * Scale. Radiance in products has an unknown unit. It is known from the views of photos with a true radiance
 * (evaluate_radiance.c); without those it is the median of the ratios of luminance over the pictures themselves, and
 * a note says so. 8-bit pictures need the radiance that is white in them.
 *
 * renders_write_cameras() goes the opposite way: the true cameras in the frame of the scene, for programs that
 * render. */
#include "stages/evaluate/scene/renders.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/capture/sfm_model.h"
#include "stages/evaluate/measure/radiance_error.h"

/* The name without its extension, and with `photo` also without "@k", into to[256]. */
static void stem(char to[256], const char *name, bool photo)
{
    snprintf(to, 256, "%s", name);
    char *dot = strrchr(to, '.'), *at = photo ? strrchr(to, '@') : NULL;
    if (dot && dot != to) *dot = 0;
    if (at && at != to) *at = 0;
}

static enum status new_render(struct renders *list, const char *name, const char *path, const struct true_picture *of,
                              struct err *err)
{
    if (array_append(&list->list, (size_t)list->count, sizeof *list->list, "pictures", err)) return err->status;
    struct render *r = &list->list[list->count];
    *r = (struct render){.of = of};
    snprintf(r->name, sizeof r->name, "%s", name);
    snprintf(r->path, sizeof r->path, "%s", path);
    if (!true_set_file(r->truth, list->set, "hdr", of->name)) return ST_OK;
    list->count++;
    return ST_OK;
}

/* The true from the picture's axes, and the distance of the two centres. */
static struct mat3 true_from_found(const struct similarity *s, const struct pose *found, const struct pose *truth,
                                   double *offset)
{
    const struct vec3 at = vec3_add(vec3_scale(mat3_apply(s->rotation, pose_center(found)), s->scale), s->translation);
    *offset = vec3_length(vec3_sub(at, pose_center(truth)));
    const struct mat3 scene_from_picture = mat3_transpose(mat3_from_quat(found->rotation));
    return mat3_multiply(mat3_from_quat(truth->rotation), mat3_multiply(s->rotation, scene_from_picture));
}

/* Pictures with cameras of their own. */
static enum status find_own(struct renders *list, struct evaluation *e, const char *folder, struct err *err)
{
    struct sfm_model m = {0};
    char path[FILE_PATH], name[256], photo[256];
    int strange = 0, far = 0;
    double farthest = 0;
    char as[96];
    snprintf(as, sizeof as, "rendered/%.70s", list->where);
    if (!provenance_add_in(e->prov, as, folder, "cameras.txt", "", NULL, err) &&
        !provenance_add_in(e->prov, as, folder, "images.txt", "", NULL, err))
        sfm_model_read_cameras(&m, folder, NULL, err);
    for (int i = 0; !err->status && i < m.image_count; i++) {
        stem(name, m.images[i].name, false);
        stem(photo, m.images[i].name, true);
        const struct true_picture *of = true_set_find(list->set, name);
        if (!of) of = true_set_find(list->set, photo);
        if (!linear_picture_find(path, folder, name)) continue;
        strange += !of;
        if (!of) continue;
        const int before = list->count;
        if (new_render(list, name, path, of, err) || list->count == before) continue;
        struct render *r = &list->list[before];
        r->map.lens = m.cameras[m.images[i].camera_idx].camera;
        r->map.true_lens = of->lens;
        r->map.true_from_picture =
            true_from_found(&e->truth_from_scene, &m.images[i].cam_from_world, &of->pose, &r->offset);
        if (r->offset <= e->params->max_offset) continue;
        far++;
        farthest = fmax(farthest, r->offset);
        list->count--;
    }
    sfm_model_release(&m);
    if (!err->status && strange)
        metric_note(&e->table, err, "skipped %d pictures of %s: the truth has no picture of their names", strange,
                    list->set->prefix);
    if (!err->status && far)
        metric_note(&e->table, err,
                    "skipped %d pictures of %s: their cameras are up to %.3g m from the true ones, more than "
                    "[evaluate] max_offset = %g",
                    far, list->set->prefix, farthest, e->params->max_offset);
    return err->status;
}

/* Pictures that are views. */
static enum status find_views(struct renders *list, struct evaluation *e, const char *folder, struct err *err)
{
    const struct view_set *sets[2] = {&e->views, &e->held};
    for (int k = 0; k < 2; k++)
        for (int i = 0; !err->status && i < sets[k]->cameras.view_count; i++) {
            const struct view *view = &sets[k]->cameras.views[i];
            const struct true_picture *of =
                true_set_find(list->set, photo_lens_of_view(&sets[k]->cameras, &sets[k]->lenses, i)->photo);
            char path[FILE_PATH];
            if (!of || !linear_picture_find(path, folder, view->name)) continue;
            const int before = list->count;
            new_render(list, view->name, path, of, err);
            if (!err->status && list->count > before) list->list[before].map = evaluation_map_of_view(sets[k], i);
        }
    return err->status;
}

enum status renders_find_in(struct renders *list, struct evaluation *e, const struct true_set *set, const char *folder,
                            const char *where, struct err *err)
{
    struct metric_table *t = &e->table;
    char images[FILE_PATH], path[FILE_PATH];
    int with_truth = 0, rendered = 0;
    *list = (struct renders){.set = set};
    snprintf(list->where, sizeof list->where, "%s", where);
    for (int i = 0; i < set->count; i++) with_truth += true_set_file(path, set, "hdr", set->pictures[i].name);
    if (!with_truth)
        return metric_note(t, err, "skipped pictures of %s: the truth has none (hdr/NAME.exr)", set->prefix);
    if (file_path(images, folder, "images.txt", "", err)) return err->status;
    if (!path_is_folder(folder))
        return metric_note(t, err, "skipped pictures of %s: the folder %s of rendered pictures is missing", set->prefix,
                           where);
    list->own_cameras = path_is_file(images);
    if (list->own_cameras && !e->aligned)
        return metric_note(t, err, "skipped pictures of %s: the cameras do not tell where the truth is", set->prefix);
    if (list->own_cameras ? find_own(list, e, folder, err) : find_views(list, e, folder, err)) return err->status;
    for (int i = 0; i < set->count; i++) {
        bool found = false;
        for (int k = 0; k < list->count && !found; k++) found = list->list[k].of == &set->pictures[i];
        rendered += found && true_set_file(path, set, "hdr", set->pictures[i].name);
    }
    if (rendered == with_truth) return ST_OK;
    return metric_note(t, err, "skipped %d of %d true pictures of %s: no picture of them is there to be measured",
                       with_truth - rendered, with_truth, set->prefix);
}

enum status renders_find(struct renders *list, struct evaluation *e, const struct true_set *set, struct err *err)
{
    char folder[FILE_PATH];
    if (file_path(folder, e->rendered, set->where, "", err)) return err->status;
    return renders_find_in(list, e, set, folder, set->where, err);
}

static bool same_camera(const struct picture_map *a, const struct picture_map *b)
{
    bool same = a->lens.width == b->lens.width && a->lens.height == b->lens.height && a->lens.model == b->lens.model &&
                !memcmp(a->lens.params, b->lens.params, sizeof a->lens.params);
    for (int i = 0; i < 9; i++)
        same = same && fabs(a->true_from_picture.m[i / 3][i % 3] - b->true_from_picture.m[i / 3][i % 3]) < 1e-9;
    return same;
}

struct render *renders_partner(const struct renders *list, const struct render *r)
{
    for (int i = 0; i < list->count; i++)
        if (!strcmp(list->list[i].name, r->name))
            return same_camera(&list->list[i].map, &r->map) ? &list->list[i] : NULL;
    return NULL;
}

void renders_release(struct renders *list)
{
    free(list->list);
    *list = (struct renders){0};
}

enum status render_read(struct evaluation *e, const struct renders *list, struct render *r, struct image *truth,
                        struct err *err)
{
    struct linear_picture whole = {0};
    char name[FILE_PATH];
    const char *file = strrchr(r->path, '/');
    if (!file_path(name, "rendered", list->where, file, err)) provenance_add_file(e->prov, name, r->path, err);
    if (!err->status) {
        snprintf(name, sizeof name, "truth%s", r->truth + strlen(e->truth_folder));
        provenance_add_file(e->prov, name, r->truth, err);
    }
    if (!err->status) linear_picture_read(&r->picture, r->path, err);
    if (!err->status && (r->picture.rgb.width != r->map.lens.width || r->picture.rgb.height != r->map.lens.height))
        err_set(err, ST_DATA, "%s is %d x %d px, but its camera %d x %d; render it again.", r->path,
                r->picture.rgb.width, r->picture.rgb.height, r->map.lens.width, r->map.lens.height);
    if (!err->status && !linear_picture_read(&whole, r->truth, err) &&
        !picture_of_truth(truth, &whole.rgb, &r->map, err))
        r->scale = r->picture.encoded ? e->white : e->radiance_scale;
    linear_picture_release(&whole);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------- scale and cameras */

enum status renders_scale(struct evaluation *e, struct renders *list, struct err *err)
{
    struct quantiles ratios = {0};
    bool encoded = false;
    evaluation_set_white(e);
    if (e->radiance_scale > 0) return ST_OK;
    quantiles_init(&ratios, err);
    for (int i = 0; !err->status && i < list->count; i++) {
        struct render *r = &list->list[i];
        struct image truth = {0};
        render_read(e, list, r, &truth, err);
        const struct radiance_pixels p = {
            r->picture.rgb.data, truth.data, NULL, (size_t)truth.width * (size_t)truth.height, 1, 0};
        encoded = encoded || r->picture.encoded;
        if (!err->status && !r->picture.encoded) radiance_ratios_add(&ratios, &p);
        image_release(&truth);
        linear_picture_release(&r->picture);
    }
    if (!err->status && ratios.count) {
        e->radiance_scale = quantiles_get(&ratios, 0.5);
        metric_note(&e->table, err,
                    "note: the scale of rendered radiance is the median ratio %.5g of the pictures of %s, because "
                    "no view of a photo with a true radiance gives it",
                    e->radiance_scale, list->set->prefix);
        evaluation_set_white(e);
    } else if (!err->status && !(e->white > 0)) {
        metric_note(&e->table, err, "skipped pictures of %s: %s", list->set->prefix,
                    encoded ? "8-bit pictures need [evaluate] white, the true radiance that is white in them"
                            : "they are black");
    }
    quantiles_release(&ratios);
    return err->status;
}

static enum status copy_camera(const struct evaluation *e, const struct true_picture *p, struct sfm_model *m,
                               struct err *err)
{
    const struct similarity *s = &e->truth_from_scene;
    const struct mat3 turn = mat3_from_quat(p->pose.rotation);
    const struct vec3 t = vec3_scale(vec3_add(mat3_apply(turn, s->translation), p->pose.translation), 1 / s->scale);
    char *name = NULL;
    if (asprintf(&name, "%s.exr", p->name) < 0) return err_nomem(err, "a name", strlen(p->name));
    m->cameras[m->camera_count] = (struct sfm_camera){m->camera_count + 1, p->lens};
    m->images[m->image_count] = (struct sfm_image){
        m->image_count + 1, {quat_from_mat3(mat3_multiply(turn, s->rotation)), t}, m->camera_count, name, NULL, 0};
    m->camera_count++;
    m->image_count++;
    return ST_OK;
}

enum status renders_write_cameras(struct evaluation *e, const struct true_set *set, struct err *err)
{
    struct sfm_model m = {0};
    char parent[FILE_PATH], folder[FILE_PATH];
    if (!e->aligned || !set->own_cameras) return ST_OK;
    if (file_path(parent, e->folder, "evaluate/cameras", "", err) || file_path(folder, parent, set->where, "", err))
        return err->status;
    m.cameras = calloc((size_t)set->count, sizeof *m.cameras);
    m.images = calloc((size_t)set->count, sizeof *m.images);
    if (!m.cameras || !m.images) err_nomem(err, "cameras", (size_t)set->count * sizeof *m.images);
    for (int i = 0; !err->status && i < set->count; i++) copy_camera(e, &set->pictures[i], &m, err);
    struct provenance prov = *e->prov; /* shares its arrays with e->prov */
    prov.count = e->shared_inputs;
    if (!err->status) sfm_model_write_text(&m, folder, &prov, err);
    sfm_model_release(&m);
    return err->status;
}
