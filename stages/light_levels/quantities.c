/* quantities.c - see quantities.h. */
#include "stages/light_levels/quantities.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/outfile.h"
#include "common/base/scan.h"

struct face_sum {
    double area, reflected; /* reflected: luminance of the reflectance times area */
};

/* Half of the area of a pane's two large sides. */
static double pane_area(const struct solid_mesh *m, const struct solid_body *body)
{
    double most = 0;
    for (int i = body->face; i < body->face + body->faces; i++) most = fmax(most, solid_mesh_area(m, i));
    return most;
}

static const char *kind_of(const char *name)
{
    static const char *const kinds[] = {"wall", "floor", "ceiling", "window", "door", "passage"};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const size_t n = strlen(kinds[i]);
        if (!strncmp(name, kinds[i], n) && name[n] == '/') return i < 3 ? kinds[i] : "reveal";
    }
    return "other";
}

static void put_quoted(FILE *to, const char *text)
{
    fputc('"', to);
    for (; *text; text++) fprintf(to, *text == '"' ? "\"\"" : "%c", *text);
    fputc('"', to);
}

static void put_faces(FILE *to, const struct level_light *l, const struct face_sum *sums)
{
    const struct solid_mesh *m = &l->patches.field->model.mesh;
    for (int i = 0; i < m->name_count; i++) {
        if (!(sums[i].area > 0)) continue;
        put_quoted(to, m->names[i].name);
        fprintf(to, ",%s,%.3f,%.2f\n", kind_of(m->names[i].name), sums[i].area, sums[i].reflected / sums[i].area);
    }
    for (int i = 0; i < m->body_count; i++) {
        const char *pane = strncmp(m->bodies[i].name, "glass/", 6) ? NULL : m->bodies[i].name;
        if (!pane) continue;
        put_quoted(to, pane);
        fprintf(to, ",glass,%.3f,\n", pane_area(m, &m->bodies[i]));
    }
}

enum status quantities_write(const struct level_light *light, bool metric, const char *path, struct err *err)
{
    const struct light_patches *p = &light->patches;
    const struct solid_mesh *m = &p->field->model.mesh;
    struct outfile f = {0};
    struct face_sum *sums = calloc((size_t)m->name_count + 1, sizeof *sums);
    if (!sums) return err_nomem(err, "faces", (size_t)m->name_count * sizeof *sums);
    for (int i = 0; i < p->face_patches; i++) {
        struct face_sum *s = &sums[m->faces[p->list[i].face].name];
        s->area += p->list[i].area;
        s->reflected += p->list[i].area * rgb_luminance(light->colours[i].reflectance);
    }
    if (!outfile_open(&f, path, err)) {
        const locale_t was = uselocale(scan_c_locale());
        fprintf(f.fp, "face,kind,area%s,reflectance\n", metric ? "_m2" : "");
        put_faces(f.fp, light, sums);
        uselocale(was);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    free(sums);
    return err->status;
}

static void put_opening(FILE *to, const struct model_plan *plan, const struct model_opening *o)
{
    static const char *const kinds[] = {[MODEL_DOOR] = "door", [MODEL_PASSAGE] = "passage", [MODEL_WINDOW] = "window"};
    const double width = o->s[1] - o->s[0], height = o->z[1] - o->z[0];
    put_quoted(to, o->name);
    fprintf(to, ",%s,", kinds[o->kind]);
    put_quoted(to, plan->walls[o->wall].name);
    fprintf(to, ",%.3f,%.3f,%.3f,%.3f,%s\n", width, height, o->z[0], width * height, o->closed ? "closed" : "open");
}

static void put_slot(FILE *to, const struct model_plan *plan, const struct model_slot *s)
{
    const double width = s->high[0] - s->low[0], depth = s->high[1] - s->low[1];
    put_quoted(to, s->name);
    fprintf(to, ",%s,", s->skylight ? "skylight" : "hatch");
    put_quoted(to, plan->rooms[s->room].name);
    fprintf(to, ",%.3f,%.3f,,%.3f,%s\n", width, depth, width * depth, s->closed ? "closed" : "open");
}

enum status quantities_write_openings(const struct model_plan *plan, bool metric, const char *path, struct err *err)
{
    struct outfile f = {0};
    if (outfile_open(&f, path, err)) return err->status;
    const locale_t was = uselocale(scan_c_locale());
    fputs(metric ? "name,kind,of,width_m,height_m,sill_m,area_m2,state\n"
                 : "name,kind,of,width,height,sill,area,state\n",
          f.fp);
    for (int i = 0; i < plan->opening_count; i++) put_opening(f.fp, plan, &plan->openings[i]);
    for (int i = 0; i < plan->slot_count; i++) put_slot(f.fp, plan, &plan->slots[i]);
    uselocale(was);
    outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
