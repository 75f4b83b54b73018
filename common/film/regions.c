/* regions.c - rectangles drawn on photographs, mapped to views.
 *
 * A grid of GRID x GRID points of the rectangle is projected through the photo's lens into each of its views; the view
 * that shows most of them is chosen, and the points' bounding box is the rectangle there. */
#include "common/film/regions.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"

enum { GRID = 33, MAX_REGIONS = 10000 };

void region_list_release(struct region_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) free(list->regions[i].view);
    free(list->regions);
    *list = (struct region_list){0};
}

static enum status coordinate_error(const struct textfile *t, double found, const char *wanted, double limit,
                                    struct err *err)
{
    char text[32];
    snprintf(text, sizeof text, "%.9g", found);
    return textfile_error(t, err, text, "%s (%.9g): X0 Y0 is the upper left corner, X1 Y1 the lower right one", wanted,
                          limit);
}

static enum status read_region(struct textfile *t, struct region *r, struct err *err)
{
    char *word, *view;
    if (textfile_word(t, "\"subject\"", &word, err)) return err->status;
    if (strcmp(word, "subject"))
        return textfile_error(t, err, word, "\"subject\", in a line \"subject VIEW X0 Y0 X1 Y1\"");
    if (textfile_word(t, "a photo or view", &view, err) || textfile_double(t, "x0", &r->x0, err) ||
        textfile_double(t, "y0", &r->y0, err) || textfile_double(t, "x1", &r->x1, err) ||
        textfile_double(t, "y1", &r->y1, err) || textfile_end(t, err))
        return err->status;
    if (!(r->x1 > r->x0)) return coordinate_error(t, r->x1, "an X1 above X0", r->x0, err);
    if (!(r->y1 > r->y0)) return coordinate_error(t, r->y1, "a Y1 above Y0", r->y0, err);
    r->line = t->line;
    r->view = strdup(view);
    return r->view ? ST_OK : err_nomem(err, "a view's name", strlen(view));
}

enum status region_list_read(struct region_list *list, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *list = (struct region_list){0};
    provenance_open(prov, "subjects.txt", &t, path, err);
    while (!err->status && textfile_next(&t)) {
        if (list->count == MAX_REGIONS) {
            err_set(err, ST_DATA, "%s:%d: found more than %d subjects.", path, t.line, MAX_REGIONS);
            break;
        }
        if (array_append(&list->regions, (size_t)list->count, sizeof *list->regions, "subjects", err)) break;
        struct region *r = &list->regions[list->count++];
        *r = (struct region){0};
        read_region(&t, r, err);
    }
    textfile_release(&t);
    if (err->status) region_list_release(list);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------ through the lens */

bool region_clip(struct subject *s, int width, int height)
{
    s->x0 = fmin(fmax(s->x0, 0), width);
    s->x1 = fmin(fmax(s->x1, 0), width);
    s->y0 = fmin(fmax(s->y0, 0), height);
    s->y1 = fmin(fmax(s->y1, 0), height);
    return s->x1 > s->x0 && s->y1 > s->y0;
}

/* The bounding box, in the view's pixels, of the region's part that lies inside the photo and in front of the view.
 * Returns the number of grid points inside the view's picture. */
static int project_region(struct subject *s, const struct region *r, const struct lens *lens, const struct view *view)
{
    const struct mat3 view_from_photo = mat3_from_quat(lens->view_from_photo);
    const double left = fmax(r->x0, 0), right = fmin(r->x1, lens->camera.width);
    const double top = fmax(r->y0, 0), bottom = fmin(r->y1, lens->camera.height);
    int shown = 0;
    s->x0 = s->y0 = HUGE_VAL;
    s->x1 = s->y1 = -HUGE_VAL;
    if (!(right > left && bottom > top)) return 0;
    for (int i = 0; i < GRID * GRID; i++) {
        struct vec3 ray;
        const double x = left + (right - left) * (i % GRID) / (GRID - 1);
        const double y = top + (bottom - top) * (i / GRID) / (GRID - 1);
        if (!camera_unproject(&lens->camera, x, y, &ray)) continue;
        ray = mat3_apply(view_from_photo, ray);
        if (!(ray.z > 0)) continue;
        const double u = view->fx * (ray.x / ray.z) + view->cx, v = view->fy * (ray.y / ray.z) + view->cy;
        s->x0 = fmin(s->x0, u);
        s->x1 = fmax(s->x1, u);
        s->y0 = fmin(s->y0, v);
        s->y1 = fmax(s->y1, v);
        shown += u >= 0 && u <= view->width && v >= 0 && v <= view->height;
    }
    return region_clip(s, view->width, view->height) ? shown : 0;
}

/* Names of photos and views, for suggestions. */
static const char *known_name(const void *ctx, int i)
{
    const struct lens_list *lenses = ctx;
    if (i >= 2 * lenses->count) return NULL;
    return i % 2 ? lenses->lenses[i / 2].view : lenses->lenses[i / 2].photo;
}

enum status region_in_view(struct subject *s, int *view_idx, double *part, const struct region *region,
                           const char *path, const struct camera_set *set, const struct lens_list *lenses,
                           struct err *err)
{
    const struct lens *known = NULL;
    int max_shown = 0;
    for (int i = 0; i < lenses->count; i++) {
        const struct lens *lens = &lenses->lenses[i];
        const int at = camera_set_find(set, lens->view);
        if ((strcmp(lens->view, region->view) && strcmp(lens->photo, region->view)) || at < 0) continue;
        known = lens;
        struct subject found = {.source = SUBJECT_USER};
        const int shown = project_region(&found, region, lens, &set->views[at]);
        if (shown <= max_shown) continue;
        const double width = fmin(region->x1, lens->camera.width) - fmax(region->x0, 0);
        const double height = fmin(region->y1, lens->camera.height) - fmax(region->y0, 0);
        *part =
            shown / (double)(GRID * GRID) * (width / (region->x1 - region->x0)) * (height / (region->y1 - region->y0));
        max_shown = shown;
        *s = found;
        *view_idx = at;
    }
    if (!known) {
        char shown[SCAN_QUOTED];
        const char *near = scan_nearest(region->view, known_name, lenses);
        const char *wanted = "wanted a photo's id or a view's name, as lenses.txt has them";
        scan_quote(shown, region->view);
        if (near)
            return err_set(err, ST_DATA, "%s:%d: found %s, %s; did you mean %s?", path, region->line, shown, wanted,
                           near);
        return err_set(err, ST_DATA, "%s:%d: found %s, %s.", path, region->line, shown, wanted);
    }
    if (!max_shown)
        return err_set(
            err, ST_DATA,
            "%s:%d: the rectangle from %.9g %.9g to %.9g %.9g lies outside the views of %s, a photo of %d x %d pixels; "
            "draw it in pixels of the stored photo.",
            path, region->line, region->x0, region->y0, region->x1, region->y1, region->view, known->camera.width,
            known->camera.height);
    s->view = strdup(set->views[*view_idx].name);
    return s->view ? ST_OK : err_nomem(err, "a view's name", strlen(region->view));
}
