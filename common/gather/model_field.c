/* model_field.c - what a ray sees in a textured model.
 *
 * Overview. A ray is traced against the model without its panes. What it sees is the first of:
 *   - a declared lamp on its way, seen from the side that shines: S cos(t)^exponent, and 0 beyond the cone's angle;
 *   - the outside of a face: its texel in the VITA, photographed or synthesised; nothing where there is none; of a
 * glossy material, what the ray's origin sees of it (field_materials.c);
 *   - the inside of a face, from a point in a solid: nothing;
 *   - the outdoors, by direction, where it leaves the model: the reference images of the opening that it passes
 *     (field_openings.c), or outdoors.exr. Panes are clear: photographs through them have the light that they let
 * through.
 *
 * Lamps. A lamp is a place of a ceiling, and the two agree to some millimetres only; a lamp that is up to `reach`
 * behind the surface that a ray meets is still in front of it, unless that lies across the lamp's plane. Texels under a
 * lamp and around it are replaced when the field is read (field_atlas.c), so that no light counts twice.
 *
 * Emitters say where bright light is: every lamp; the openings of lights.txt; panes of the model that lights.txt does
 * not name, since the sky lights through those too; panes that an edit has moved or resized, whatever lights.txt says
 * of the window that was there; the suns of the outdoors (field_sky.c).
 *
 * Source: the light function L(x -> direction) of [Colburn 2014, 5.3.1 to 5.3.3]. Different here: beyond the
 * images that an opening names, the outdoors are one picture of all lighting reference images and photographs. */
#include "common/gather/model_field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/numbers.h"

static const double HANGING = 0.1;     /* of the model's size: lamps further from a face leave its texels alone */
static const double SAME_PANE = 0.01;  /* of its size: how far a pane may move and is still the same */
static const double ACROSS = 0.7;      /* cosine to a lamp's normal */
static const double PANE_REACH = 0.01; /* of the model's size: beyond that, a pane's surroundings are looked at */

/* ------------------------------------------------------------------------------------------------------------- look */

const struct lamp *model_field_lamp(const struct model_field *f, struct vec3 from, struct vec3 direction, double t,
                                    double *at)
{
    const struct lamp *found = NULL;
    for (int i = 0; i < f->lights.lamp_count; i++) {
        const struct field_lamp *l = &f->lamps[i];
        const double cosine = -vec3_dot(direction, l->lamp->normal);
        const struct vec3 to = vec3_sub(l->lamp->centre, from);
        if (l->off || !(cosine > 0)) continue;
        const double distance = -vec3_dot(to, l->lamp->normal) / cosine;
        if (!(distance > 0 && (distance - t) * cosine <= f->reach) || (found && distance >= *at)) continue;
        const struct vec3 q = vec3_sub(vec3_scale(direction, distance), to);
        const double a = vec3_dot(l->dual[0], q), b = vec3_dot(l->dual[1], q);
        if (l->lamp->shape == LAMP_DISK ? a * a + b * b > 1 : fmax(fabs(a), fabs(b)) > 1) continue;
        found = l->lamp;
        *at = distance;
    }
    return found;
}

bool model_field_hides_lamp(const struct lamp *lamp, double at, const struct ray_hit *hit)
{
    return hit->t < at && fabs(vec3_dot(hit->normal, lamp->normal)) < ACROSS;
}

static void see_face(struct light_look *seen, const struct model_field *f, const struct ray_hit *hit,
                     struct vec3 direction, bool glossy)
{
    *seen = (struct light_look){{0, 0, 0}, hit->t, LIGHT_NONE, -1};
    if (!hit->front) return;
    const struct field_texel texel =
        field_atlas_look(&f->atlas, solid_face_id(&f->model.mesh, (int)hit->id), hit->point);
    seen->radiance = texel.radiance;
    seen->source = texel.source;
    seen->face = (int)hit->id;
    if (texel.mark < 0 || !glossy) return;
    const struct surface_seen surface = {hit->point, hit->normal, vec3_scale(direction, -1)};
    if (field_materials_reflect(&seen->radiance, &f->materials, &f->plain, texel.mark, &surface))
        seen->source = LIGHT_MATERIAL;
}

static void see_surface(struct light_look *seen, const struct model_field *f, const struct ray_hit *hit)
{
    const int k = (int)hit->id - f->model.mesh.face_count, back = !hit->front;
    *seen = (struct light_look){f->surfaces->radiance[k][back], hit->t, LIGHT_OBJECT,
                                f->model.mesh.face_count + 2 * k + back};
}

/* What is seen of the outdoors, but for openings with reference images. place: where outdoors.exr has it; not read if
 * there is none. */
static enum light_source see_sky(struct rgb *radiance, const struct model_field *f, const struct outdoors_place *place)
{
    float rgb[3];
    *radiance = rgb_grey(0);
    if (!f->outdoors.rgb) return LIGHT_NONE;
    const enum outdoors_source source = outdoors_look(rgb, &f->outdoors, place);
    *radiance = rgb_make((double)rgb[0], (double)rgb[1], (double)rgb[2]);
    return source == OUTDOORS_GUESSED ? LIGHT_SKY_GUESSED : LIGHT_SKY;
}

static bool see_opening(struct rgb *radiance, const struct model_field *f, struct vec3 from, struct vec3 direction)
{
    float rgb[3];
    if (!field_openings_look(rgb, &f->openings, from, direction)) return false;
    *radiance = rgb_make((double)rgb[0], (double)rgb[1], (double)rgb[2]);
    return true;
}

enum light_source model_field_outdoors(struct rgb *radiance, const struct model_field *f, struct vec3 from,
                                       struct vec3 direction)
{
    struct outdoors_place place;
    if (see_opening(radiance, f, from, direction)) return LIGHT_SKY;
    if (f->outdoors.rgb) place = outdoors_find(&f->outdoors, direction);
    return see_sky(radiance, f, &place);
}

/* glossy: whether materials count */
static void look_from(const struct model_field *f, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                      const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET],
                      bool glossy)
{
    const struct vec3 off = vec3_scale(normal, f->model.rays.epsilon);
    struct vec3 origin[RAY_PACKET];
    struct ray_hit hits[RAY_PACKET];
    struct outdoors_place places[RAY_PACKET];
    unsigned faces = 0, sky = 0;
    for (int k = 0; k < RAY_PACKET; k++)
        if (active >> k & 1) origin[k] = vec3_add(from[k], off);
    const unsigned hit = ray_scene_hit_packet(&f->model.rays, origin, direction, active, hits);
    for (int k = 0; k < RAY_PACKET; k++)
        if (hit >> k & 1 && (int)hits[k].id < f->model.mesh.face_count)
            field_atlas_prefetch(&f->atlas, solid_face_id(&f->model.mesh, (int)hits[k].id), hits[k].point);
    for (int k = 0; k < RAY_PACKET; k++) {
        double at;
        if (!(active >> k & 1)) continue;
        const double t = hit >> k & 1 ? hits[k].t : INFINITY;
        const struct lamp *lamp = model_field_lamp(f, origin[k], direction[k], t, &at);
        if (lamp && !(hit >> k & 1 && model_field_hides_lamp(lamp, at, &hits[k]))) {
            seen[k] = (struct light_look){lamp_radiance(lamp, vec3_scale(direction[k], -1)), at, LIGHT_LAMP, -1};
        } else if (hit >> k & 1) {
            faces |= 1u << k;
        } else {
            seen[k] = (struct light_look){{0, 0, 0}, INFINITY, LIGHT_SKY, -1};
            if (see_opening(&seen[k].radiance, f, origin[k], direction[k])) continue;
            if (f->outdoors.rgb) places[k] = outdoors_find(&f->outdoors, direction[k]);
            sky |= 1u << k;
        }
    }
    for (int k = 0; k < RAY_PACKET; k++) {
        if (sky >> k & 1) seen[k].source = see_sky(&seen[k].radiance, f, &places[k]);
        if (!(faces >> k & 1)) continue;
        if ((int)hits[k].id < f->model.mesh.face_count)
            see_face(&seen[k], f, &hits[k], direction[k], glossy);
        else
            see_surface(&seen[k], f, &hits[k]);
    }
}

static void look(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                 const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET])
{
    look_from(ctx, from, normal, direction, active, seen, true);
}

static void look_plain(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                       const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET])
{
    look_from(ctx, from, normal, direction, active, seen, false);
}

bool model_field_lift(const struct model_field *f, struct gather_point *p, double most)
{
    const double epsilon = f->model.rays.epsilon;
    struct ray_hit hit;
    const struct vec3 from = vec3_add(p->at, vec3_scale(p->normal, epsilon));
    if (!ray_scene_hit(&f->model.rays, from, p->normal, &hit) || hit.front || hit.t > most) return false;
    p->at = vec3_add(p->at, vec3_scale(p->normal, hit.t + 2 * epsilon));
    return true;
}

int model_field_material(const struct model_field *f, int face_id, struct vec3 p)
{
    const int mark = field_atlas_look(&f->atlas, face_id, p).mark;
    return mark < 0 ? -1 : f->materials.marks[mark].material;
}

void model_field_viewpoint(const struct model_field *f, int face_id, struct vec3 p, struct vec3 *viewpoint)
{
    const int mark = field_atlas_look(&f->atlas, face_id, p).mark;
    if (mark >= 0) *viewpoint = f->materials.marks[mark].viewpoint;
}

/* --------------------------------------------------------------------------------------------------------- emitters */

static void prepare_lamps(struct model_field *f)
{
    for (int i = 0; i < f->lights.lamp_count; i++) {
        f->lamps[i].lamp = &f->lights.lamps[i];
        field_dual(f->lamps[i].dual, f->lights.lamps[i].x, f->lights.lamps[i].y);
    }
}

static void add_lamps(struct model_field *f)
{
    for (int i = 0; i < f->lights.lamp_count; i++) {
        const struct lamp *l = &f->lights.lamps[i];
        if (f->lamps[i].off) continue;
        f->emitters[f->field.emitter_count++] =
            (struct emitter){.kind = l->shape == LAMP_DISK ? EMITTER_DISK : EMITTER_QUAD,
                             .centre = l->centre,
                             .x = l->x,
                             .y = l->y,
                             .normal = l->normal,
                             .luminance = rgb_luminance(l->radiance),
                             .beta = l->beta,
                             .exponent = l->exponent};
    }
}

static void add_opening(struct model_field *f, struct vec3 centre, struct vec3 x, struct vec3 y, struct vec3 normal)
{
    f->emitters[f->field.emitter_count++] = (struct emitter){.kind = EMITTER_QUAD,
                                                             .centre = centre,
                                                             .x = x,
                                                             .y = y,
                                                             .normal = normal,
                                                             .luminance = field_sky_mean(&f->sky, &f->outdoors, normal),
                                                             .beta = 0.5 * PI};
}

/* The name of a body's pane, "glass/NAME"; NULL: it is none. */
static const char *pane_name(const struct solid_body *body)
{
    return strncmp(body->name, "glass/", 6) ? NULL : body->name + 6;
}

static bool is_listed(const struct light_list *l, const char *name)
{
    for (int i = 0; i < l->opening_count; i++)
        if (!strcmp(l->openings[i].name, name)) return true;
    return false;
}

static int largest_face(const struct solid_mesh *mesh, const struct solid_body *body)
{
    int best = body->face;
    for (int i = body->face + 1; i < body->face + body->faces; i++)
        if (solid_mesh_area(mesh, i) > solid_mesh_area(mesh, best)) best = i;
    return best;
}

/* The rectangle around a face, its sides level and upright. */
static void span_face(const struct solid_mesh *mesh, int index, struct vec3 *centre, struct vec3 *x, struct vec3 *y)
{
    const struct solid_face *face = &mesh->faces[index];
    const struct vec3 up = fabs(face->normal.z) > 0.9 ? vec3_make(0, 1, 0) : vec3_make(0, 0, 1);
    const struct vec3 u = vec3_normalize(vec3_cross(up, face->normal)), v = vec3_cross(face->normal, u);
    double low[2], high[2];
    solid_face_box(mesh, index, u, v, low, high);
    *centre = vec3_add(vec3_add(vec3_scale(u, (low[0] + high[0]) / 2), vec3_scale(v, (low[1] + high[1]) / 2)),
                       vec3_scale(face->normal, face->offset));
    *x = vec3_scale(u, (high[0] - low[0]) / 2);
    *y = vec3_scale(v, (high[1] - low[1]) / 2);
}

/* A pane lets the sky in if a ray from its middle meets the model on one side only: that is indoors. */
bool model_field_pane(struct emitter *pane, const struct model_field *f, int body)
{
    const struct solid_body *b = &f->model.mesh.bodies[body];
    if (!pane_name(b) || !b->faces) return false;
    const int largest = largest_face(&f->model.mesh, b);
    const struct solid_face *face = &f->model.mesh.faces[largest];
    struct ray_hit hit;
    *pane = (struct emitter){.kind = EMITTER_QUAD, .luminance = 1, .beta = 0.5 * PI};
    span_face(&f->model.mesh, largest, &pane->centre, &pane->x, &pane->y);
    const struct vec3 off = vec3_scale(face->normal, PANE_REACH * model_rays_size(&f->model));
    const bool front = ray_scene_hit(&f->model.rays, vec3_add(pane->centre, off), face->normal, &hit);
    const bool back = ray_scene_hit(&f->model.rays, vec3_sub(pane->centre, off), vec3_scale(face->normal, -1), &hit);
    pane->normal = vec3_scale(face->normal, front ? 1 : -1);
    return front != back;
}

static void add_pane(struct model_field *f, const struct solid_body *body)
{
    struct emitter e;
    if (model_field_pane(&e, f, (int)(body - f->model.mesh.bodies))) add_opening(f, e.centre, e.x, e.y, e.normal);
}

static void add_openings(struct model_field *f)
{
    for (int i = 0; i < f->lights.opening_count; i++) {
        const struct daylight *o = &f->lights.openings[i];
        add_opening(f, o->centre, o->x, o->y, o->normal);
    }
    for (int i = 0; i < f->model.mesh.body_count; i++) {
        const struct solid_body *body = &f->model.mesh.bodies[i];
        const char *name = pane_name(body);
        if (name && body->faces && !is_listed(&f->lights, name)) add_pane(f, body);
    }
}

/* The pane of a name; NULL: none. */
static const struct solid_body *find_pane(const struct solid_mesh *mesh, const char *name)
{
    for (int i = 0; i < mesh->body_count; i++) {
        const char *other = pane_name(&mesh->bodies[i]);
        if (other && mesh->bodies[i].faces && !strcmp(other, name)) return &mesh->bodies[i];
    }
    return NULL;
}

/* Whether two panes let light in at one place. */
static bool is_same_pane(const struct solid_mesh *a, const struct solid_body *pane_a, const struct solid_mesh *b,
                         const struct solid_body *pane_b)
{
    struct vec3 centre[2], x[2], y[2];
    span_face(a, largest_face(a, pane_a), &centre[0], &x[0], &y[0]);
    span_face(b, largest_face(b, pane_b), &centre[1], &x[1], &y[1]);
    const double most = SAME_PANE * (vec3_length(x[0]) + vec3_length(y[0]));
    const double wider = fabs(vec3_length(x[1]) - vec3_length(x[0])),
                 higher = fabs(vec3_length(y[1]) - vec3_length(y[0]));
    return vec3_length(vec3_sub(centre[1], centre[0])) <= most && wider <= most && higher <= most;
}

static void set_plain(struct model_field *f)
{
    f->plain = f->field;
    f->plain.look = look_plain;
}

static void list_emitters(struct model_field *f)
{
    f->field.emitter_count = 0;
    add_lamps(f);
    if (f->outdoors.rgb) add_openings(f);
    for (int i = 0; i < f->sky.sun_count; i++) f->emitters[f->field.emitter_count++] = f->sky.suns[i];
}

void model_field_switch_lamp(struct model_field *f, int lamp, bool on)
{
    for (int i = 0; i < f->lights.lamp_count; i++)
        if (lamp < 0 || i == lamp) f->lamps[i].off = !on;
    list_emitters(f);
    set_plain(f);
}

void model_field_scale_lamp(struct model_field *f, const char *name, const double scale[3])
{
    for (int i = 0; i < f->lights.lamp_count; i++) {
        struct lamp *l = &f->lights.lamps[i];
        if (strcmp(l->name, name) != 0) continue;
        l->radiance = rgb_multiply(l->radiance, rgb_make(scale[0], scale[1], scale[2]));
        f->lamps[i].off = !(rgb_max(l->radiance) > 0);
    }
    list_emitters(f);
    set_plain(f);
}

void model_field_add_changed_panes(struct model_field *f, const struct model_field *was)
{
    const struct solid_mesh *mesh = &f->model.mesh, *old = &was->model.mesh;
    for (int i = 0; f->outdoors.rgb && i < mesh->body_count; i++) {
        const char *name = pane_name(&mesh->bodies[i]);
        if (!name || !mesh->bodies[i].faces || !is_listed(&f->lights, name)) continue;
        const struct solid_body *pane = find_pane(old, name);
        if (pane && !is_same_pane(old, pane, mesh, &mesh->bodies[i])) add_pane(f, &mesh->bodies[i]);
    }
    set_plain(f);
}

static enum status find_emitters(struct model_field *f, struct err *err)
{
    const size_t most =
        (size_t)f->lights.lamp_count + (size_t)f->lights.opening_count + (size_t)f->model.mesh.body_count + MAX_SUNS;
    f->lamps = calloc((size_t)f->lights.lamp_count + 1, sizeof *f->lamps);
    f->emitters = calloc(most, sizeof *f->emitters);
    if (!f->lamps || !f->emitters) return err_nomem(err, "emitters", most * sizeof *f->emitters);
    prepare_lamps(f);
    list_emitters(f);
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status find_planes(struct model_field *f, struct err *err)
{
    f->planes = calloc((size_t)f->model.ids, sizeof *f->planes);
    if (!f->planes) return err_nomem(err, "faces", (size_t)f->model.ids * sizeof *f->planes);
    for (int i = 0; i < f->model.mesh.face_count; i++) {
        const struct solid_face *face = &f->model.mesh.faces[i];
        f->planes[solid_face_id(&f->model.mesh, i)] = (struct face_plane){face->normal, face->offset};
    }
    return ST_OK;
}

static enum status cover_lamps(struct model_field *f, struct err *err)
{
    const double reach = HANGING * model_rays_size(&f->model);
    for (int i = 0; i < f->lights.lamp_count; i++)
        for (int id = 1; id < f->model.ids; id++)
            if (field_atlas_cover_lamp(&f->atlas, &f->covered_texels, id, f->planes[id], &f->lights.lamps[i], reach,
                                       err))
                return err->status;
    return ST_OK;
}

static enum status read_files(struct model_field *f, const struct model_field_files *files, struct provenance *prov,
                              struct err *err)
{
    f->surfaces = files->surfaces;
    const struct model_extra *extra = files->surfaces ? &files->surfaces->triangles : NULL;
    if (!model_rays_read_with(&f->model, files->model, MODEL_WITHOUT_GLASS, extra, prov, err))
        field_atlas_read(&f->atlas, files->vita, f->model.ids, prov, err);
    if (!err->status && files->outdoors) outdoors_read(&f->outdoors, files->outdoors, prov, err);
    if (!err->status && files->lights) light_list_read(&f->lights, files->lights, prov, err);
    return err->status;
}

enum status model_field_read(struct model_field *f, const struct model_field_files *files, struct provenance *prov,
                             struct err *err)
{
    *f = (struct model_field){0};
    read_files(f, files, prov, err);
    f->reach = LAMP_REACH * model_rays_size(&f->model);
    if (!err->status && !find_planes(f, err) && !cover_lamps(f, err) && !field_sky_find(&f->sky, &f->outdoors, err))
        find_emitters(f, err);
    f->field.ctx = f;
    f->field.look = look;
    f->field.emitters = f->emitters;
    set_plain(f);
    return err->status;
}

enum status model_field_read_references(struct model_field *f, const char *folder, const struct model_axes *axes,
                                        struct provenance *prov, struct err *err)
{
    return field_openings_read(&f->openings, &f->lights, &f->model, folder, axes, prov, err);
}

enum status model_field_read_materials(struct model_field *f, const char *path, const char *views,
                                       const struct model_axes *axes, struct provenance *prov, struct err *err)
{
    const struct field_surface on = {&f->atlas, &f->model, f->planes};
    return field_materials_read(&f->materials, &on, path, views, axes, prov, err);
}

void model_field_release(struct model_field *f)
{
    if (!f) return;
    model_rays_release(&f->model);
    field_atlas_release(&f->atlas);
    outdoors_release(&f->outdoors);
    light_list_release(&f->lights);
    field_openings_release(&f->openings);
    field_materials_release(&f->materials);
    free(f->lamps);
    free(f->emitters);
    free(f->planes);
    *f = (struct model_field){0};
}
