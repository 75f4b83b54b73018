/* lit_scene.c - from notes on photographs to lamps, openings and points in the model's frame.
 *
 * Overview. A person marks lamps and lit points by pixels [Colburn 2014, 5.3.3]. A pixel of a photo is a ray through
 * the photo's lens; the first surface of the model on it, seen from the front, is what the person meant.
 *
 * Lamps. The ray through the middle of a lamp finds the surface that it hangs on; the lamp's plane is parallel to
 * that surface at the stated distance. A disk has its centre there and one point of its rim, found on the plane
 * across the disk's own normal, which may be inclined. An area light has four corners; they are never quite those of
 * a parallelogram, so its half edges are the means of opposite sides, which is the least-squares parallelogram. x
 * and y are ordered so that their cross product points into the room.
 *
 * Openings come from the plan. Windows and skylights let daylight in unless a note says `shut`; doors and passages
 * do only if a note says so, and hatches never do. An opening in a wall along no axis is left out with a warning:
 * light through it is then found by rays that happen to leave, with more noise.
 *
 * Points. A rectangle becomes grid x grid points, those on the surface at its middle. A line becomes 161 points
 * between its two ends, which must lie on one surface, because a fit of a falloff needs one normal. A lamp whose
 * radiance is not given gets points itself: where rays from it, as many as places, meet the model, or, if somebody
 * marked points for it, those of its faces whose marks are of one material: this is that of the whole face, but for
 * pictures and doors, which the fit takes for outliers. Their density is that of a lamp's light. Those within a cube of
 * a face are one mark.
 *
 * Marks are evidence: one whose pixels mean nothing (a photo that was not registered, a ray that leaves the model) is
 * left out with a warning that names the file, the line and the pixel. Units: the model's, angles in radians after this
 * file. */
#include "stages/fit_lights/lit_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/log.h"
#include "common/capture/photo_camera.h"
#include "common/light/frame.h"
#include "common/math/numbers.h"
#include "stages/fit_lights/cone_edge.h"

#define SAME_PLANE 0.999 /* cosine between normals of one surface */
#define PLACE_SIDE 0.05  /* of the model's size: of the cube whose places are one mark */

void lit_model_release(struct lit_model *m)
{
    model_rays_release(&m->rays);
    scene_inputs_release(&m->in);
    *m = (struct lit_model){0};
}

void lit_scene_release(struct lit_scene *s)
{
    light_list_release(&s->lights);
    free(s->lamp_notes);
    free(s->points);
    free(s->marks);
    *s = (struct lit_scene){0};
}

struct resolver {
    struct lit_scene *scene;
    const struct annotation_list *notes;
    const struct lit_model *model;
    int grid, places;
};

/* ----------------------------------------------------------------------------------------------------------- pixels */

struct ray {
    struct vec3 from, direction; /* unit; model frame */
};

static enum status pixel_ray(struct ray *ray, const struct resolver *r, const struct annotation *a,
                             const double pixel[2], struct err *err)
{
    struct photo_camera camera;
    struct vec3 world;
    if (photo_camera_find(&camera, a->view, &r->model->in.set, &r->model->in.lenses, r->notes->path, a->line, err))
        return err->status;
    if (!photo_camera_ray(&camera, pixel[0], pixel[1], &world))
        return err_set(err, ST_DATA, "%s:%d: pixel %g %g is not inside the photo %s, which has %d x %d pixels.",
                       r->notes->path, a->line, pixel[0], pixel[1], a->view, camera.lens.width, camera.lens.height);
    ray->from = model_from_world_point(&r->model->in.axes, camera.center);
    ray->direction = model_from_world_direction(&r->model->in.axes, world);
    return ST_OK;
}

static enum status pixel_hit(struct ray_hit *hit, const struct resolver *r, const struct annotation *a,
                             const double pixel[2], struct err *err)
{
    struct ray ray;
    if (pixel_ray(&ray, r, a, pixel, err)) return err->status;
    if (ray_scene_hit(&r->model->rays.rays, ray.from, ray.direction, hit) && hit->front) return ST_OK;
    return err_set(err, ST_DATA, "%s:%d: the ray through pixel %g %g of %s hits no surface of the model.",
                   r->notes->path, a->line, pixel[0], pixel[1], a->view);
}

/* Where a pixel's ray meets the plane through a point. */
static enum status pixel_on_plane(struct vec3 *at, const struct resolver *r, const struct annotation *a,
                                  const double pixel[2], struct vec3 on, struct vec3 n, struct err *err)
{
    struct ray ray;
    if (pixel_ray(&ray, r, a, pixel, err)) return err->status;
    const double down = vec3_dot(n, ray.direction), t = vec3_dot(n, vec3_sub(on, ray.from)) / down;
    if (!(fabs(down) > 0.02 && t > 0 && isfinite(t)))
        return err_set(err, ST_DATA, "%s:%d: the ray through pixel %g %g of %s does not hit the lamp's plane.",
                       r->notes->path, a->line, pixel[0], pixel[1], a->view);
    *at = vec3_add(ray.from, vec3_scale(ray.direction, t));
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ lamps */

static enum status too_small(const struct resolver *r, const struct annotation *a, struct err *err)
{
    return err_set(err, ST_DATA, "%s:%d: the lamp %s has no area; mark it in a photo that shows it larger.",
                   r->notes->path, a->line, a->name);
}

static enum status place_disk(struct lamp *l, const struct resolver *r, const struct annotation *a, struct err *err)
{
    struct ray_hit hit;
    struct vec3 rim;
    if (pixel_hit(&hit, r, a, a->pixel, err)) return err->status;
    l->shape = LAMP_DISK;
    l->normal = a->has_normal ? a->normal : hit.normal;
    struct vec3 on = vec3_add(hit.point, vec3_scale(hit.normal, a->off));
    /* the lamp's plane is parallel to the surface: an inclined normal turns the disk about its centre */
    if (pixel_on_plane(&l->centre, r, a, a->pixel, on, hit.normal, err) ||
        pixel_on_plane(&rim, r, a, a->pixel + 2, l->centre, l->normal, err))
        return err->status;
    const struct vec3 arm = vec3_sub(rim, l->centre);
    l->radius = vec3_length(arm);
    if (!(l->radius > 1e-6)) return too_small(r, a, err);
    l->x = arm;
    l->y = vec3_cross(l->normal, arm);
    l->beta = a->has_beta == QUANTITY_GIVEN ? a->beta / 90 * (0.5 * PI) : 0.5 * PI;
    l->exponent = a->has_exponent == QUANTITY_GIVEN ? a->exponent : 0;
    return ST_OK;
}

/* A parallelogram that fits four corners best: half edges from the differences of opposite sides. */
static enum status place_area(struct lamp *l, const struct resolver *r, const struct annotation *a, struct err *err)
{
    struct ray_hit hit;
    struct vec3 c[4];
    if (pixel_hit(&hit, r, a, a->pixel, err)) return err->status;
    const struct vec3 on = vec3_add(hit.point, vec3_scale(hit.normal, a->off));
    for (int i = 0; i < 4; i++)
        if (pixel_on_plane(&c[i], r, a, a->pixel + 2 * i, on, hit.normal, err)) return err->status;
    l->shape = LAMP_QUAD;
    l->centre = vec3_scale(vec3_add(vec3_add(c[0], c[1]), vec3_add(c[2], c[3])), 0.25);
    l->x = vec3_scale(vec3_sub(vec3_add(c[1], c[2]), vec3_add(c[0], c[3])), 0.25);
    l->y = vec3_scale(vec3_sub(vec3_add(c[3], c[2]), vec3_add(c[0], c[1])), 0.25);
    struct vec3 n = vec3_cross(l->x, l->y);
    if (!(vec3_length(n) > 1e-9)) return too_small(r, a, err);
    if (vec3_dot(n, hit.normal) < 0) { /* U x V points towards the room */
        const struct vec3 x = l->x;
        l->x = l->y;
        l->y = x;
        n = vec3_scale(n, -1);
    }
    l->normal = vec3_normalize(n);
    l->beta = 0.5 * PI;
    return ST_OK;
}

/* Turns an error of a lamp or mark into a warning. False: it is another kind of error. */
static bool left_out(struct err *err, const char *what)
{
    if (err->status != ST_DATA) return false;
    log_warn("%s %s", err->text, what);
    *err = (struct err)ERR_INIT;
    return true;
}

static enum status add_lamp(struct resolver *r, int note, struct err *err)
{
    const struct annotation *a = &r->notes->items[note];
    struct light_list *list = &r->scene->lights;
    if (array_append(&list->lamps, (size_t)list->lamp_count, sizeof *list->lamps, "lamps", err) ||
        array_append(&r->scene->lamp_notes, (size_t)list->lamp_count, sizeof *r->scene->lamp_notes, "lamps", err))
        return err->status;
    r->scene->lamp_notes[list->lamp_count] = note;
    struct lamp *l = &list->lamps[list->lamp_count++];
    *l = (struct lamp){.name = strdup(a->name)};
    if (!l->name) return err_nomem(err, "a name", strlen(a->name) + 1);
    if (!(a->kind == NOTE_DISK ? place_disk(l, r, a, err) : place_area(l, r, a, err))) return ST_OK;
    if (left_out(err, "This lamp stays as photographed.")) free(list->lamps[--list->lamp_count].name);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- openings */

/* The rectangle between two corners on a wall, with its normal towards the inside. */
static void span_wall(struct daylight *o, const struct vec3 c[2], struct vec3 normal)
{
    o->centre = vec3_scale(vec3_add(c[0], c[1]), 0.5);
    o->normal = normal;
    o->y = vec3_make(0, 0, 0.5 * (c[1].z - c[0].z));
    const double half = 0.5 * hypot(c[1].x - c[0].x, c[1].y - c[0].y);
    o->x = vec3_scale(vec3_cross(vec3_make(0, 0, 1), normal), half); /* x cross y = normal */
}

static void span_slot(struct daylight *o, const struct model_plan *plan, const struct model_slot *s)
{
    const double x = 0.5 * (s->low[0] + s->high[0]), y = 0.5 * (s->low[1] + s->high[1]);
    o->centre = vec3_make(x, y, model_room_ceiling(&plan->rooms[s->room], x, y));
    o->x = vec3_make(0, 0.5 * (s->high[1] - s->low[1]), 0);
    o->y = vec3_make(0.5 * (s->high[0] - s->low[0]), 0, 0);
    o->normal = vec3_make(0, 0, -1);
}

static const struct annotation *note_of(const struct resolver *r, const char *opening)
{
    for (int i = 0; r->notes && i < r->notes->count; i++)
        if (r->notes->items[i].kind <= NOTE_SHUT && !strcmp(r->notes->items[i].name, opening))
            return &r->notes->items[i];
    return NULL;
}

static enum status add_opening(struct resolver *r, const char *name, const struct daylight *place,
                               const struct annotation *note, struct err *err)
{
    struct light_list *list = &r->scene->lights;
    if (array_append(&list->openings, (size_t)list->opening_count, sizeof *list->openings, "openings", err))
        return err->status;
    struct daylight *o = &list->openings[list->opening_count++];
    *o = *place;
    o->name = strdup(name);
    if (!o->name) return err_nomem(err, "a name", strlen(name) + 1);
    for (int k = 0; note && k < note->reference_count; k++) {
        if (array_append(&o->references, (size_t)o->reference_count, sizeof *o->references, "references", err))
            return err->status;
        o->references[o->reference_count] = strdup(note->references[k]);
        if (!o->references[o->reference_count]) return err_nomem(err, "a name", strlen(note->references[k]) + 1);
        o->reference_count++;
    }
    return ST_OK;
}

static enum status add_openings(struct resolver *r, struct err *err)
{
    const struct model_plan *plan = &r->model->in.plan;
    for (int i = 0; i < plan->opening_count; i++) {
        const struct model_opening *o = &plan->openings[i];
        const struct annotation *note = note_of(r, o->name);
        const struct model_wall *w = &plan->walls[o->wall];
        struct daylight place = {0};
        struct vec3 c[2];
        if (note ? note->kind == NOTE_SHUT : o->kind != MODEL_WINDOW) continue;
        if (!model_opening_corners(plan, i, c)) {
            log_warn(
                "the opening %s is in a wall along no axis, so it is left out of lights.txt; its light arrives, with "
                "more noise.",
                o->name);
            continue;
        }
        span_wall(&place, c, vec3_make(w->normal[0], w->normal[1], 0));
        if (add_opening(r, o->name, &place, note, err)) return err->status;
    }
    for (int i = 0; i < plan->slot_count; i++) {
        const struct model_slot *s = &plan->slots[i];
        const struct annotation *note = note_of(r, s->name);
        struct daylight place = {0};
        if (note ? note->kind == NOTE_SHUT || !s->skylight : !s->skylight) continue;
        span_slot(&place, plan, s);
        if (add_opening(r, s->name, &place, note, err)) return err->status;
    }
    return ST_OK;
}

static enum status check_openings(const struct resolver *r, struct err *err)
{
    const struct model_plan *plan = &r->model->in.plan;
    for (int i = 0; i < r->notes->count; i++) {
        const struct annotation *a = &r->notes->items[i];
        bool known = a->kind > NOTE_SHUT;
        for (int k = 0; k < plan->opening_count; k++) known |= !strcmp(plan->openings[k].name, a->name);
        for (int k = 0; k < plan->slot_count; k++) known |= !strcmp(plan->slots[k].name, a->name);
        if (!known)
            return err_set(err, ST_DATA,
                           "%s:%d: found %s, wanted the name of an opening of the model (model/plan.txt).",
                           r->notes->path, a->line, a->name);
    }
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------------- points */

static int lamp_of_note(const struct resolver *r, int note)
{
    for (int i = 0; i < r->scene->lights.lamp_count; i++)
        if (r->scene->lamp_notes[i] == note) return i;
    return -1;
}

static enum status add_mark(struct resolver *r, int note, int face, struct err *err)
{
    struct lit_scene *s = r->scene;
    if (array_append(&s->marks, (size_t)s->mark_count, sizeof *s->marks, "marks", err)) return err->status;
    s->marks[s->mark_count++] = (struct lit_mark){note, face, face, -1};
    return ST_OK;
}

/* Of the last mark. */
static enum status add_point(struct resolver *r, int note, struct vec3 at, struct vec3 normal, double along,
                             struct err *err)
{
    struct lit_scene *s = r->scene;
    const struct annotation *a = &r->notes->items[note];
    if (array_append(&s->points, (size_t)s->point_count, sizeof *s->points, "points", err)) return err->status;
    s->points[s->point_count++] =
        (struct lit_point){at, normal, lamp_of_note(r, a->lamp), note, s->mark_count - 1, a->kind, along};
    return ST_OK;
}

/* The points of a rectangle that lie on the surface at its middle. */
static enum status add_rectangle(struct resolver *r, int note, struct err *err)
{
    const struct annotation *a = &r->notes->items[note];
    const double *p = a->pixel, middle[2] = {0.5 * (p[0] + p[2]), 0.5 * (p[1] + p[3])};
    struct ray_hit centre, hit;
    if (pixel_hit(&centre, r, a, middle, err)) return err->status;
    r->scene->marks[r->scene->mark_count - 1].on = (int)centre.id;
    for (int i = 0; i < r->grid * r->grid; i++) {
        const double x = (i % r->grid + 0.5) / r->grid, y = (i / r->grid + 0.5) / r->grid;
        const double pixel[2] = {p[0] + x * (p[2] - p[0]), p[1] + y * (p[3] - p[1])};
        struct ray ray;
        if (pixel_ray(&ray, r, a, pixel, err)) return err->status;
        if (!ray_scene_hit(&r->model->rays.rays, ray.from, ray.direction, &hit) || !hit.front) continue;
        if (hit.id != centre.id) continue;
        if (add_point(r, note, hit.point, hit.normal, 0, err)) return err->status;
    }
    return ST_OK;
}

static enum status add_line(struct resolver *r, int note, struct err *err)
{
    const struct annotation *a = &r->notes->items[note];
    struct ray_hit ends[2];
    if (pixel_hit(&ends[0], r, a, a->pixel, err) || pixel_hit(&ends[1], r, a, a->pixel + 2, err)) return err->status;
    if (ends[0].id != ends[1].id || vec3_dot(ends[0].normal, ends[1].normal) < SAME_PLANE)
        return err_set(err, ST_DATA, "%s:%d: the line of %s begins on %s and ends on %s; draw it on one surface.",
                       r->notes->path, a->line, a->name, solid_face_name(&r->model->rays.mesh, (int)ends[0].id),
                       solid_face_name(&r->model->rays.mesh, (int)ends[1].id));
    for (int i = 0; i < LINE_POINTS; i++) {
        const double t = i / (double)(LINE_POINTS - 1);
        const struct vec3 at = vec3_add(vec3_scale(ends[0].point, 1 - t), vec3_scale(ends[1].point, t));
        if (add_point(r, note, at, ends[0].normal, t, err)) return err->status;
    }
    return ST_OK;
}

static enum status add_points(struct resolver *r, int note, struct err *err)
{
    const struct annotation *a = &r->notes->items[note];
    struct ray_hit hit;
    if (lamp_of_note(r, a->lamp) < 0) return ST_OK; /* its lamp was left out */
    if (add_mark(r, note, -1, err)) return err->status;
    if (a->kind == NOTE_LINE)
        add_line(r, note, err);
    else if (a->pixels == 2)
        add_rectangle(r, note, err);
    else if (!pixel_hit(&hit, r, a, a->pixel, err)) {
        r->scene->marks[r->scene->mark_count - 1].on = (int)hit.id;
        add_point(r, note, hit.point, hit.normal, 0, err);
    }
    left_out(err, "This mark does not count.");
    return err->status;
}

static bool is_marked(const struct resolver *r, int lamp)
{
    bool marked = false;
    for (int i = 0; i < r->scene->point_count; i++)
        marked |= r->scene->points[i].lamp == lamp && r->scene->points[i].kind != NOTE_LINE;
    return marked;
}

/* A mark on a face, if all marks there are of one material; -1: they are not, or there is none. */
static int mark_on_face(const struct resolver *r, int face)
{
    const char *material = NULL;
    int found = -1;
    for (int k = 0; k < r->scene->mark_count; k++) {
        const struct lit_mark *m = &r->scene->marks[k];
        const struct annotation *a = &r->notes->items[m->note];
        if (m->face >= 0 || m->on != face || a->kind == NOTE_LINE) continue;
        const char *own = a->material ? a->material : a->name;
        if (material && strcmp(material, own)) return -1;
        material = own;
        found = k;
    }
    return found;
}

/* The mark of a place, which is new if no other place of the lamp is in its cube. */
static enum status mark_of_place(int *mark, struct resolver *r, int from, int note, int face, const int cube[3],
                                 double side, struct err *err)
{
    const struct lit_scene *s = r->scene;
    for (int i = from; i < s->point_count; i++) {
        const double at[3] = {s->points[i].at.x, s->points[i].at.y, s->points[i].at.z};
        bool same = s->marks[s->points[i].mark].face == face;
        for (int k = 0; k < 3; k++) same &= (int)floor(at[k] / side) == cube[k];
        *mark = s->points[i].mark;
        if (same) return ST_OK;
    }
    *mark = s->mark_count;
    return add_mark(r, note, face, err);
}

static enum status add_places(struct resolver *r, int lamp, struct err *err)
{
    struct lit_scene *s = r->scene;
    const bool marked = is_marked(r, lamp);
    const struct lamp *l = &s->lights.lamps[lamp];
    const int note = s->lamp_notes[lamp], from = s->point_count;
    const double side = PLACE_SIDE * model_rays_size(&r->model->rays);
    for (int i = 0; !err->status && i < r->places; i++) {
        /* evenly over the projected hemisphere [Vogel 1979] */
        const double sin2 = (i + 0.5) / r->places, turns = i * 0.6180339887498949;
        const struct vec3 d = frame_direction(l->normal, sqrt(sin2), sqrt(1 - sin2), turns - floor(turns));
        struct curve_point p;
        unsigned face;
        int mark;
        if (!cone_edge_ray(&p, l, d, &r->model->rays, &face)) continue;
        const int cube[3] = {(int)floor(p.at.x / side), (int)floor(p.at.y / side), (int)floor(p.at.z / side)};
        const int like = marked ? mark_on_face(r, (int)face) : -1;
        if (marked && like < 0) continue;
        if (mark_of_place(&mark, r, from, note, (int)face, cube, side, err)) continue;
        s->marks[mark].like = like;
        if (!array_append(&s->points, (size_t)s->point_count, sizeof *s->points, "points", err))
            s->points[s->point_count++] = (struct lit_point){p.at, p.normal, lamp, note, mark, NOTE_LIT, 0};
    }
    return err->status;
}

enum status lit_scene_resolve(struct lit_scene *s, const struct annotation_list *notes, const struct lit_model *model,
                              int grid, int places, struct err *err)
{
    struct resolver r = {s, notes, model, grid, places};
    *s = (struct lit_scene){0};
    if (notes) check_openings(&r, err);
    for (int i = 0; !err->status && notes && i < notes->count; i++)
        if (notes->items[i].kind == NOTE_DISK || notes->items[i].kind == NOTE_AREA) add_lamp(&r, i, err);
    for (int i = 0; !err->status && notes && i < notes->count; i++)
        if (notes->items[i].kind >= NOTE_LIT) add_points(&r, i, err);
    for (int i = 0; !err->status && i < s->lights.lamp_count; i++)
        if (!notes->items[s->lamp_notes[i]].has_radiance) add_places(&r, i, err);
    if (!err->status) add_openings(&r, err);
    return err->status;
}
