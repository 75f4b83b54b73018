/* live_json.c - a model as JSON; see live_json.h. */
#include "stages/build_model/live/live_json.h"

#include <stdio.h>
#include <stdlib.h>

#include "stages/build_model/script/script_words.h"

/* A list of JSON in the making. */
struct json {
    FILE *to;
    bool more; /* the list has an item */
};

static void begin_list(struct json *j, const char *name)
{
    fprintf(j->to, ",\n\"%s\":[", name);
    j->more = false;
}

static void begin_item(struct json *j)
{
    fputs(j->more ? ",\n" : "\n", j->to);
    j->more = true;
}

static void print_text(FILE *to, const char *text)
{
    putc('"', to);
    for (const unsigned char *c = (const unsigned char *)text; *c; c++)
        if (*c < ' ')
            fprintf(to, "\\u%04x", *c);
        else
            fprintf(to, *c == '"' || *c == '\\' ? "\\%c" : "%c", *c);
    putc('"', to);
}

static void print_numbers(FILE *to, const char *name, const double *v, int count)
{
    fprintf(to, ",\"%s\":[", name);
    for (int i = 0; i < count; i++) fprintf(to, "%s%.17g", i ? "," : "", v[i]);
    putc(']', to);
}

static void print_walls(struct json *j, const struct plan *p)
{
    begin_list(j, "walls");
    for (int i = 0; i < p->wall_count; i++) {
        const struct plan_wall *w = &p->walls[i];
        const double n[2] = {w->d[1], -w->d[0]};
        double corners[4][2], span[2];
        if (w->removed) continue;
        plan_wall_corners(p, i, corners);
        plan_wall_span(p, i, span);
        begin_item(j);
        fprintf(j->to, "{\"name\":\"%s\",\"line\":%d,\"at\":%.17g,\"foot\":%.17g,\"top\":%.17g,\"thickness\":%.17g",
                w->name, w->line, w->c, w->foot, w->top, w->thickness);
        fprintf(j->to, ",\"sign\":%d,\"origin\":%.17g,\"angled\":%s", w->sign, w->origin, w->angled ? "true" : "false");
        print_numbers(j->to, "normal", n, 2);
        print_numbers(j->to, "direction", w->d, 2);
        print_numbers(j->to, "span", span, 2);
        print_numbers(j->to, "corners", corners[0], 8);
        fputs("}", j->to);
    }
    fputs("]", j->to);
}

static void print_openings(struct json *j, const struct plan *p)
{
    begin_list(j, "openings");
    for (int i = 0; i < p->opening_count; i++) {
        const struct plan_opening *o = &p->openings[i];
        if (o->removed || p->walls[o->wall].removed) continue;
        begin_item(j);
        fprintf(j->to, "{\"name\":\"%s\",\"line\":%d,\"kind\":\"%s\",\"wall\":\"%s\",\"fill\":\"%s\"", o->name, o->line,
                plan_opening_word(o->kind), p->walls[o->wall].name, script_filling_name(o->fill));
        print_numbers(j->to, "s", o->s, 2);
        print_numbers(j->to, "z", o->z, 2);
        fputs("}", j->to);
    }
    fputs("]", j->to);
    begin_list(j, "slots");
    for (int i = 0; i < p->slot_count; i++) {
        const struct plan_slot *s = &p->slots[i];
        if (s->removed || p->rooms[s->room].removed) continue;
        begin_item(j);
        fprintf(j->to, "{\"name\":\"%s\",\"line\":%d,\"kind\":\"%s\",\"room\":\"%s\"", s->name, s->line,
                plan_opening_word(s->kind), p->rooms[s->room].name);
        print_numbers(j->to, "low", s->low, 2);
        print_numbers(j->to, "high", s->high, 2);
        fputs("}", j->to);
    }
    fputs("]", j->to);
}

static void print_rooms(struct json *j, const struct plan *p)
{
    begin_list(j, "boxes");
    for (int i = 0; i < p->box_count; i++) {
        const struct plan_box *b = &p->boxes[i];
        if (b->removed) continue;
        begin_item(j);
        fprintf(j->to, "{\"name\":\"%s\",\"line\":%d,\"turn\":%.17g", b->name, b->line, b->turn);
        print_numbers(j->to, "low", b->low, 3);
        print_numbers(j->to, "high", b->high, 3);
        fputs("}", j->to);
    }
    fputs("]", j->to);
    begin_list(j, "rooms");
    for (int i = 0; i < p->room_count; i++) {
        const struct plan_room *r = &p->rooms[i];
        double middle[2] = {0, 0};
        if (r->removed) continue;
        for (int k = 0; k < r->edge_count; k++)
            for (int c = 0; c < 2; c++) middle[c] += r->edges[k].corner[c] / r->edge_count;
        begin_item(j);
        fprintf(j->to, "{\"name\":\"%s\",\"line\":%d,\"floor\":%.17g,\"ceiling\":%.17g,\"walls\":[", r->name, r->line,
                r->floor, r->ceiling);
        for (int k = 0; k < r->wall_count; k++) fprintf(j->to, "%s\"%s\"", k ? "," : "", p->walls[r->walls[k]].name);
        fputs("]", j->to);
        print_numbers(j->to, "middle", middle, 2);
        fputs("}", j->to);
    }
    fputs("]", j->to);
    begin_list(j, "things");
    for (int i = 0; i < p->thing_count; i++) {
        begin_item(j);
        fprintf(j->to, "{\"name\":\"%s\"}", p->things[i].name);
    }
    fputs("]", j->to);
}

static void print_faces(struct json *j, const struct solid_mesh *m)
{
    begin_list(j, "faces");
    for (int f = 0; f < m->face_count; f++) {
        const struct solid_face *face = &m->faces[f];
        const double n[3] = {face->normal.x, face->normal.y, face->normal.z};
        begin_item(j);
        fprintf(j->to, "{\"name\":\"%s\",\"id\":%d,\"glass\":%s", solid_face_name(m, f), solid_face_id(m, f),
                solid_face_is_pane(m, f) ? "true" : "false");
        print_numbers(j->to, "normal", n, 3);
        fputs(",\"loops\":[", j->to);
        for (int l = face->loop; l < face->loop + face->loops; l++) {
            int h = m->loops[l].half_edge;
            const char *before = l > face->loop ? ",[" : "[";
            do {
                fprintf(j->to, "%s%d", before, m->half_edges[h].origin);
                before = ",";
                h = m->half_edges[h].next;
            } while (h != m->loops[l].half_edge);
            fputs("]", j->to);
        }
        fputs("]}", j->to);
    }
    fputs("]", j->to);
    begin_list(j, "vertices");
    for (int v = 0; v < m->vertex_count; v++) {
        const struct vec3 p = m->vertices[v].p;
        begin_item(j);
        fprintf(j->to, "[%.9g,%.9g,%.9g]", p.x, p.y, p.z);
    }
    fputs("]", j->to);
}

static enum status end_text(FILE *to, char **text, struct err *err)
{
    const bool failed = ferror(to);
    if (!fclose(to) && !failed) return ST_OK;
    free(*text);
    *text = NULL;
    return err_nomem(err, "a text", 0);
}

enum status live_json_model(char **text, const struct building *b, struct err *err)
{
    size_t size = 0;
    struct json j = {.to = open_memstream(text, &size)};
    if (!j.to) return err_nomem(err, "a model's text", 0);
    fprintf(j.to, "{\"volume\":%.9g,\"bodies\":%d", b->report.volume, b->mesh.body_count);
    print_walls(&j, &b->plan);
    print_openings(&j, &b->plan);
    print_rooms(&j, &b->plan);
    print_faces(&j, &b->mesh);
    fputs("}", j.to);
    return end_text(j.to, text, err);
}

enum status live_json_photos(char **text, const struct placer *placer, struct err *err)
{
    size_t size = 0;
    FILE *to = open_memstream(text, &size);
    if (!to) return err_nomem(err, "the photos' names", 0);
    putc('[', to);
    for (int i = 0; i < placer->photo_count; i++) {
        const struct photo_camera *c = &placer->photos[i].camera;
        const double centre[3] = {c->center.x, c->center.y, c->center.z};
        const struct vec3 axis = mat3_apply(mat3_transpose(c->cam_from_world), vec3_make(0, 0, 1));
        const double looks[3] = {axis.x, axis.y, axis.z};
        fputs(i ? ",\n{\"id\":" : "{\"id\":", to);
        print_text(to, placer->photos[i].id);
        fprintf(to, ",\"width\":%d,\"height\":%d", c->lens.width, c->lens.height);
        print_numbers(to, "centre", centre, 3);
        print_numbers(to, "looks", looks, 3);
        putc('}', to);
    }
    putc(']', to);
    return end_text(to, text, err);
}
