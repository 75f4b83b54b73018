/* photo_camera.c - a stored photograph as a camera in the world. */
#include "common/capture/photo_camera.h"

#include <string.h>

#include "common/base/scan.h"

const struct lens *photo_lens_of_view(const struct camera_set *set, const struct lens_list *lenses, int view)
{
    const int at = lens_list_find(lenses, set->views[view].name);
    return at < 0 ? NULL : &lenses->lenses[at];
}

int photo_of_view(const struct camera_set *set, const struct lens_list *lenses, int view)
{
    const struct lens *lens = photo_lens_of_view(set, lenses, view), *before;
    while (lens && view > 0 && (before = photo_lens_of_view(set, lenses, view - 1)) &&
           !strcmp(before->photo, lens->photo))
        view--;
    return view;
}

/* All names of photos and views, to suggest a similar one. */
static const char *known_name(const void *ctx, int i)
{
    const struct lens_list *lenses = ctx;
    if (i >= 2 * lenses->count) return NULL;
    return i % 2 ? lenses->lenses[i / 2].view : lenses->lenses[i / 2].photo;
}

enum status photo_camera_find(struct photo_camera *camera, const char *name, const struct camera_set *set,
                              const struct lens_list *lenses, const char *path, int line, struct err *err)
{
    for (int i = 0; i < lenses->count; i++) {
        const struct lens *lens = &lenses->lenses[i];
        const int at = camera_set_find(set, lens->view);
        if ((strcmp(lens->view, name) && strcmp(lens->photo, name)) || at < 0) continue;
        const struct mat3 photo_from_view = mat3_transpose(mat3_from_quat(lens->view_from_photo));
        const struct view *view = &set->views[at];
        *camera = (struct photo_camera){lens->camera, mat3_multiply(photo_from_view, view->cam_from_world),
                                        mat3_apply(photo_from_view, view->translation), view->center, at};
        return ST_OK;
    }
    char shown[SCAN_QUOTED];
    const char *near = scan_nearest(name, known_name, lenses);
    return err_set(err, ST_DATA, "%s:%d: found %s, wanted a photo's id or a view's name from views/lenses.txt%s%s%s",
                   path, line, scan_quote(shown, name), near ? "; did you mean " : ".", near ? near : "",
                   near ? "?" : "");
}

bool photo_camera_ray(const struct photo_camera *camera, double u, double v, struct vec3 *ray)
{
    struct vec3 r;
    if (!(u >= 0 && v >= 0 && u <= camera->lens.width && v <= camera->lens.height)) return false;
    if (!camera_unproject(&camera->lens, u, v, &r)) return false;
    *ray = mat3_apply(mat3_transpose(camera->cam_from_world), r);
    return true;
}

bool photo_camera_project(const struct photo_camera *camera, struct vec3 world, double *u, double *v)
{
    return camera_project(&camera->lens, vec3_add(mat3_apply(camera->cam_from_world, world), camera->translation), u,
                          v);
}
