/* ifc_lines.c - lines of a STEP file (ISO 10303-21); see ifc.h. */
#include <stdarg.h>
#include <string.h>

#include "common/base/array.h"
#include "stages/export_model/ifc.h"

int ifc_next(struct ifc *f) { return ++f->last; }

int ifc_points(struct ifc *f, const struct vec3 *points, int count)
{
    char x[40], y[40], z[40];
    const int list = ifc_next(f);
    fprintf(f->to, "#%d=IFCCARTESIANPOINTLIST3D((", list);
    for (int i = 0; i < count; i++)
        fprintf(f->to, "%s(%s,%s,%s)", i ? "," : "", ifc_real(x, points[i].x), ifc_real(y, points[i].y),
                ifc_real(z, points[i].z));
    fputs("));\n", f->to);
    return list;
}

int ifc_put(struct ifc *f, const char *fmt, ...)
{
    va_list args;
    const int id = ifc_next(f);
    fprintf(f->to, "#%d=", id);
    va_start(args, fmt);
    vfprintf(f->to, fmt, args);
    va_end(args);
    fputs(";\n", f->to);
    return id;
}

int ifc_begin_of(struct ifc *f, const char *kind, const char *key, const char *name)
{
    char guid[23], text[1200];
    const int id = ifc_next(f);
    snprintf(text, sizeof text, "%s/%s/%s", f->s->name, kind, key);
    ifc_guid(guid, text);
    fprintf(f->to, "#%d=%s('%s',$,", id, kind, guid);
    ifc_text(f->to, name);
    return id;
}

int ifc_begin(struct ifc *f, const char *kind, const char *name) { return ifc_begin_of(f, kind, name, name); }

enum status ifc_keep(struct ifc *f, struct ifc_ids *ids, int id)
{
    if (array_append(&ids->list, (size_t)ids->count, sizeof *ids->list, "elements", f->err)) return f->err->status;
    ids->list[ids->count++] = id;
    return ST_OK;
}

void ifc_put_ids(struct ifc *f, const struct ifc_ids *ids)
{
    fputc('(', f->to);
    for (int i = 0; i < ids->count; i++) fprintf(f->to, "%s#%d", i ? "," : "", ids->list[i]);
    fputc(')', f->to);
}

const char *ifc_real(char text[40], double value)
{
    snprintf(text, 40, "%.9g", value + 0.0);
    if (strpbrk(text, ".e") == NULL) strcat(text, ".");
    char *e = strchr(text, 'e');
    if (e && !memchr(text, '.', (size_t)(e - text))) {
        memmove(e + 1, e, strlen(e) + 1);
        *e = '.';
    }
    if ((e = strchr(text, 'e'))) *e = 'E';
    return text;
}

int ifc_point(struct ifc *f, struct vec3 p)
{
    char x[40], y[40], z[40];
    return ifc_put(f, "IFCCARTESIANPOINT((%s,%s,%s))", ifc_real(x, p.x), ifc_real(y, p.y), ifc_real(z, p.z));
}

int ifc_direction(struct ifc *f, struct vec3 d)
{
    char x[40], y[40], z[40];
    return ifc_put(f, "IFCDIRECTION((%s,%s,%s))", ifc_real(x, d.x), ifc_real(y, d.y), ifc_real(z, d.z));
}

int ifc_element(struct ifc *f, const char *kind, const char *name, int shape, const char *rest)
{
    return ifc_element_of(f, kind, name, name, shape, rest);
}

int ifc_element_of(struct ifc *f, const char *kind, const char *key, const char *name, int shape, const char *rest)
{
    const int id = ifc_begin_of(f, kind, key, name);
    fprintf(f->to, ",$,$,#%d,", f->placement);
    if (shape)
        fprintf(f->to, "#%d,$%s);\n", shape, rest);
    else
        fprintf(f->to, "$,$%s);\n", rest);
    return id;
}
