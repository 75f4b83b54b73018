/* scene_text.c - see scene_text.h. */
#include "stages/walk/scene_text.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/version.h"
#include "common/math/lanes.h"
#include "common/texture/picture_made.h"
#include "common/texture/radiance_median.h"
#include "stages/walk/data_file.h"

static void count_tiles(struct radiance_median *r, const struct texture_rule *rule, const struct atlas *vita,
                        const struct atlas_page *pages, bool seen)
{
    for (int i = 0; i < vita->tile_count; i++) {
        const struct atlas_tile *t = &vita->tiles[i];
        if (!radiance_median_wants(rule, t->face)) continue;
        for (int y = t->y; y < t->y + t->height; y++)
            for (int x = t->x; x < t->x + t->width; x++) {
                const size_t at = (size_t)y * (size_t)pages[t->page].width + (size_t)x;
                const uint32_t source = pages[t->page].source[at];
                uint16_t halves[3];
                if (source == ATLAS_NONE || (seen && source < ATLAS_VIEWS)) continue;
                for (size_t c = 0; c < 3; c++) halves[c] = half_from_float(pages[t->page].rgb[3 * at + c]);
                radiance_median_add(r, halves);
            }
    }
}

enum status scene_text_colour(float colour[3], const struct texture_rule *rule, const struct atlas *vita,
                              const struct atlas_page *pages, struct err *err)
{
    struct radiance_median r;
    if (radiance_median_init(&r, err)) return err->status;
    count_tiles(&r, rule, vita, pages, true);
    if (!r.total) count_tiles(&r, rule, vita, pages, false);
    radiance_median_colour(colour, &r, rule->albedo);
    radiance_median_release(&r);
    return ST_OK;
}

static void write_matrix(FILE *to, const double m[3][4]) { data_write_numbers(to, m[0], 12); }

void scene_text_atlas(FILE *to, const struct atlas *a)
{
    fputs("{\"pages\":[", to);
    for (int i = 0; i < a->page_count; i++)
        fprintf(to, "%s[%d,%d]", i ? "," : "", a->page_sizes[i][0], a->page_sizes[i][1]);
    fputs("],\"tiles\":[", to);
    for (int i = 0; i < a->tile_count; i++) {
        const struct atlas_tile *t = &a->tiles[i];
        fprintf(to, "%s\n[%d,%d,%d,%d,%d,%d,", i ? "," : "", t->face, t->page, t->x, t->y, t->width, t->height);
        write_matrix(to, t->matrix);
        putc(']', to);
    }
    fputs("]}", to);
}

/* ------------------------------------------------------------------------------------------------------------ faces */

struct face_writer {
    FILE *to;
    const struct walk_scene *scene;
    const struct walk_model *model;
    const struct atlas_page *vita_pages;
    struct solid_triangles triangles;
};

/* The colour of a new surface under the light of the rooms, times the exposure. */
static enum status write_colour(FILE *to, const struct walk_scene *s, const struct texture_rule *rule,
                                const struct atlas_page *vita_pages, struct err *err)
{
    float colour[3];
    double shown[3];
    if (scene_text_colour(colour, rule, &s->vita, vita_pages, err)) return err->status;
    for (int c = 0; c < 3; c++) shown[c] = (double)colour[c] * s->exposure;
    fputs(",\"rgb\":", to);
    data_write_numbers(to, shown, 3);
    return ST_OK;
}

static enum status write_rule(const struct face_writer *w, const struct texture_rule *rule, struct err *err)
{
    static const char *const kinds[] = {"place", "edge", "outdoors", "colour"};
    fprintf(w->to, "{\"kind\":\"%s\"", kinds[rule->kind]);
    if (rule->kind == TEXTURE_PLACE || rule->kind == TEXTURE_EDGE) {
        fprintf(w->to, ",\"from\":%d,\"m\":", rule->from);
        write_matrix(w->to, rule->matrix);
    }
    if (rule->kind == TEXTURE_COLOUR) {
        if (write_colour(w->to, w->scene, rule, w->vita_pages, err)) return err->status;
    }
    if (rule->limited) {
        fputs(",\"within\":", w->to);
        data_write_numbers(w->to, &rule->within[0].x, 12);
    }
    putc('}', w->to);
    return ST_OK;
}

static enum status write_face(const struct face_writer *w, int at, struct err *err)
{
    const struct solid_mesh *mesh = &w->model->rays.mesh;
    const struct solid_face *f = &mesh->faces[at];
    const int id = solid_face_id(mesh, at);
    const struct vec3 p = mesh->vertices[mesh->half_edges[mesh->loops[f->loop].half_edge].origin].p;
    const struct texture_face *t = texture_map_find(&w->model->map, id, p);
    if (t && vec3_dot(t->normal, f->normal) < 0.999) t = NULL;
    const struct texture_rule itself = {
        .kind = TEXTURE_PLACE, .from = id, .matrix = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    const bool pane = solid_face_is_pane(mesh, at);
    const bool shown = !pane || (t && t->rule_count && t->rules[0].kind != TEXTURE_OUTDOORS);
    fprintf(w->to, "\n{\"id\":%d,\"name\":", id);
    data_write_text(w->to, solid_face_name(mesh, at));
    fprintf(w->to, ",\"pane\":%d,\"shown\":%d,\"area\":", pane, shown);
    data_write_number(w->to, solid_mesh_area(mesh, at));
    fputs(",\"n\":", w->to);
    data_write_point(w->to, f->normal);
    fputs(",\"d\":", w->to);
    data_write_number(w->to, f->offset);
    fputs(",\"tris\":[", w->to);
    for (int k = w->triangles.first[at]; k < w->triangles.first[at + 1]; k++) {
        const int *v = w->triangles.triangles[k].v;
        fprintf(w->to, "%s%d,%d,%d", k > w->triangles.first[at] ? "," : "", v[0], v[1], v[2]);
    }
    fputs("],\"rules\":[", w->to);
    if (!t) write_rule(w, &itself, err);
    for (int k = 0; !err->status && t && k < t->rule_count; k++) {
        if (k) putc(',', w->to);
        write_rule(w, &t->rules[k], err);
    }
    fputs("]}", w->to);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- models */

static void write_plan(FILE *to, const struct model_plan *plan)
{
    fputs("\"rooms\":[", to);
    for (int i = 0; i < plan->room_count; i++) {
        const struct model_room *room = &plan->rooms[i];
        fprintf(to, "%s{\"name\":", i ? "," : "");
        data_write_text(to, room->name);
        fputs(",\"floor\":", to);
        data_write_number(to, room->floor);
        fputs(",\"corners\":[", to);
        for (int k = 0; k < room->corner_count; k++) {
            if (k) putc(',', to);
            data_write_numbers(to, (const double[]){room->corners[k].x, room->corners[k].y}, 2);
        }
        fputs("]}", to);
    }
    putc(']', to);
}

static void write_things(FILE *to, const struct walk_model *m)
{
    static const char *const fates[] = {"stays", "kept", "gone"};
    const struct placed_things *t = &m->things;
    fputs(",\n\"things\":[", to);
    for (int i = 0; i < t->list.count; i++)
        fprintf(to, "%s\"%s\"", i ? "," : "", t->fate ? fates[t->fate[i + 1]] : fates[0]);
    fputs("],\"placed\":[", to);
    for (int i = 0; i < t->placed_count; i++) {
        const struct placed_thing *p = &t->placed[i];
        fprintf(to, "%s{\"id\":%u,\"turn\":", i ? "," : "", p->id);
        data_write_numbers(to, p->turn.m[0], 9);
        fputs(",\"shift\":", to);
        data_write_point(to, p->shift);
        putc('}', to);
    }
    fputs("],\"zones\":[", to);
    for (int i = 0; i < m->map.zone_count; i++) {
        const struct texture_zone *z = &m->map.zones[i];
        fprintf(to, "%s{\"keep\":%d,\"low\":", i ? "," : "", z->keep);
        data_write_number(to, z->low);
        fputs(",\"high\":", to);
        data_write_number(to, z->high);
        fputs(",\"corners\":", to);
        data_write_numbers(to, z->corners[0], 2 * z->corner_count);
        putc('}', to);
    }
    putc(']', to);
}

static enum status write_objects(FILE *to, const struct walk_scene *s, const struct walk_model *m,
                                 const struct atlas_page *vita_pages, struct err *err)
{
    fputs(",\n\"objects\":[", to);
    for (int i = 0; !err->status && i < m->objects.count; i++) {
        const struct object *o = &m->objects.items[i];
        const struct texture_rule rule = {
            .kind = TEXTURE_COLOUR,
            .albedo = {(float)o->brdf.albedo.r, (float)o->brdf.albedo.g, (float)o->brdf.albedo.b}};
        fprintf(to, "%s{\"name\":", i ? "," : "");
        data_write_text(to, o->name);
        write_colour(to, s, &rule, vita_pages, err);
        fputs(",\"corners\":[", to);
        for (int k = 0; k < m->meshes[i].count; k++)
            for (int c = 0; c < 3; c++) {
                if (k || c) putc(',', to);
                const struct vec3 p = m->meshes[i].triangles[k][c], n = m->meshes[i].normals[k][c];
                fprintf(to, "%.5g,%.5g,%.5g,%.3g,%.3g,%.3g", p.x, p.y, p.z, n.x, n.y, n.z);
            }
        fputs("]}", to);
    }
    putc(']', to);
    return err->status;
}

static int place_of(const struct walk_scene *s, const char *photo)
{
    for (int i = 0; i < s->place_count; i++)
        if (!strcmp(s->places[i].photo, photo)) return i;
    return -1;
}

/* Frames as [time, centre, the axis of view, pair, share]. */
static void write_tour(FILE *to, const struct walk_scene *s, const struct walk_model *m)
{
    fputs(",\n\"tour\":[", to);
    for (int i = 0; i < m->tour.frame_count; i += s->params->tour_step) {
        const struct path_frame *f = &m->tour.frames[i];
        const struct view v = model_from_world_view(&s->in.axes, &f->camera);
        const struct viewpoint_pair *pair = viewpoint_pairs_find(&m->pairs, f->camera.name);
        const struct vec3 axis = mat3_row(v.cam_from_world, 2);
        fprintf(to, "%s[", i ? "," : "");
        data_write_number(to, f->time);
        fprintf(to, ",%.5g,%.5g,%.5g,%.5g,%.5g,%.5g", v.center.x, v.center.y, v.center.z, axis.x, axis.y, axis.z);
        fprintf(to, ",%d,%d,%.4g]", pair ? place_of(s, pair->photos[0]) : -1, pair ? place_of(s, pair->photos[1]) : -1,
                pair ? pair->t : 0);
    }
    putc(']', to);
}

static enum status write_model(FILE *to, const struct walk_scene *s, const struct walk_model *m,
                               const struct atlas_page *vita_pages, struct err *err)
{
    const struct solid_mesh *mesh = &m->rays.mesh;
    struct face_writer w = {.to = to, .scene = s, .model = m, .vita_pages = vita_pages};
    fputs("{\"edit\":", to);
    data_write_text(to, m->edit);
    fputs(",\"about\":", to);
    data_write_text(to, m->about && *m->about ? m->about : NULL);
    fputs(",\"vertices\":[", to);
    for (int i = 0; i < mesh->vertex_count; i++)
        fprintf(to, "%s%.8g,%.8g,%.8g", i ? "," : "", mesh->vertices[i].p.x, mesh->vertices[i].p.y,
                mesh->vertices[i].p.z);
    fputs("],\"faces\":[", to);
    if (!solid_mesh_triangulate(&w.triangles, mesh, err))
        for (int i = 0; !err->status && i < mesh->face_count; i++) {
            if (i) putc(',', to);
            write_face(&w, i, err);
        }
    solid_triangles_release(&w.triangles);
    fputs("],\n", to);
    write_plan(to, &m->plan);
    write_things(to, m);
    if (!err->status) write_objects(to, s, m, vita_pages, err);
    write_tour(to, s, m);
    fprintf(to, ",\n\"light\":%s}", m->relit ? "true" : "false");
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- cameras */

static void write_view(FILE *to, const struct view *v)
{
    fputs("\n{\"name\":", to);
    data_write_text(to, v->name);
    fprintf(to, ",\"width\":%d,\"height\":%d,\"lens\":", v->width, v->height);
    data_write_numbers(to, (const double[]){v->fx, v->fy, v->cx, v->cy}, 4);
    fputs(",\"turn\":", to);
    data_write_numbers(to, v->cam_from_world.m[0], 9);
    fputs(",\"centre\":", to);
    data_write_point(to, v->center);
    putc('}', to);
}

static void write_kinds(FILE *to)
{
    fputs("\"made\":[", to);
    for (int k = 0; k < MADE_COUNT; k++) {
        const struct picture_made_kind *kind = picture_made_kind((enum picture_made)k);
        fprintf(to, "%s{\"word\":\"%s\",\"text\":\"%s\",\"rgb\":[%d,%d,%d]}", k ? "," : "", kind->word, kind->label,
                kind->rgb[0], kind->rgb[1], kind->rgb[2]);
    }
    fputs("],\n", to);
}

enum status scene_text_write(FILE *to, const struct walk_scene *s, const struct atlas_page *vita_pages, struct err *err)
{
    fputs("{\"name\":", to);
    data_write_text(to, s->files->name);
    fprintf(to, ",\"version\":\"%s\",\"unit\":\"%s\",\"grid\":%d,\"clutter\":%d,\"outdoors\":%d,\n", REMODEL_VERSION,
            s->in.axes.metric ? "m" : "", s->params->grid, s->files->depth != NULL, s->files->outdoors != NULL);
    write_kinds(to);
    fputs("\"views\":[", to);
    for (int i = 0; i < s->in.set.view_count; i++) {
        if (i) putc(',', to);
        write_view(to, &s->cameras[i]);
    }
    fputs("],\"places\":[", to);
    for (int i = 0; i < s->place_count; i++) {
        const struct walk_viewpoint *p = &s->places[i];
        fprintf(to, "%s\n{\"photo\":", i ? "," : "");
        data_write_text(to, p->photo);
        fprintf(to, ",\"first\":%d,\"count\":%d,\"centre\":", p->first, p->count);
        data_write_point(to, s->cameras[p->first].center);
        fputs(",\"atlas\":", to);
        scene_text_atlas(to, &p->atlas);
        putc('}', to);
    }
    fputs("],\n\"vita\":", to);
    scene_text_atlas(to, &s->vita);
    fputs(",\n\"models\":[", to);
    for (int i = 0; !err->status && i < s->model_count; i++) {
        if (i) fputs(",\n", to);
        write_model(to, s, &s->models[i], vita_pages, err);
    }
    fputs("]}", to);
    return err->status;
}
