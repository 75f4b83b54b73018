/* ifc_lamps.c - lamps that an edit adds, in IFC4: an IfcLightFixture with its luminous opening, and with its photometry
 * as an IfcLightSourceGoniometric.
 *
 * Intensities are per lumen, as IFC has them, at the vertical angles of the file (IFC's secondary angles) and at all of
 * its horizontal ones, also those that symmetry repeats. The distribution's downward direction is -z of its placement.
 *
 * Colour. IFC wants a colour temperature: that of the light's chromaticity [McCamy 1992]; 6504 K for white. */
#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"
#include "common/math/numbers.h"
#include "stages/export_model/ifc.h"

static const double SAME = 1e-6; /* degrees */

enum status ifc_lamp_units(struct ifc *f, struct ifc_ids *units)
{
    const int flux = ifc_put(f, "IFCSIUNIT(*,.LUMINOUSFLUXUNIT.,$,.LUMEN.)");
    const int intensity = ifc_put(f, "IFCSIUNIT(*,.LUMINOUSINTENSITYUNIT.,$,.CANDELA.)");
    const int kelvin = ifc_put(f, "IFCSIUNIT(*,.THERMODYNAMICTEMPERATUREUNIT.,$,.KELVIN.)");
    const int of = ifc_put(f, "IFCDERIVEDUNITELEMENT(#%d,1)", intensity);
    const int per = ifc_put(f, "IFCDERIVEDUNITELEMENT(#%d,-1)", flux);
    const int each = ifc_put(f, "IFCDERIVEDUNIT((#%d,#%d),.LUMINOUSINTENSITYDISTRIBUTIONUNIT.,$)", of, per);
    if (ifc_keep(f, units, flux) || ifc_keep(f, units, intensity) || ifc_keep(f, units, kelvin)) return f->err->status;
    return ifc_keep(f, units, each);
}

/* All horizontal angles in degrees, ascending, those that symmetry repeats included; the caller frees them. */
static double *all_horizontal(int *count, const struct photometry *p, struct err *err)
{
    double *list = malloc((4 * (size_t)p->horizontal_count + 1) * sizeof *list);
    int n = 0;
    *count = 0;
    if (!list) {
        err_nomem(err, "angles", 4 * (size_t)p->horizontal_count * sizeof *list);
        return NULL;
    }
    for (int i = 0; i < p->horizontal_count; i++)
        for (int k = 0; k < 4; k++) {
            const double other = k & 1 ? 2 * p->mirror - p->horizontal[i] : p->horizontal[i];
            if (k & 1 && p->mirror < 0) continue;
            if (k & 2 && !(p->turn < 360)) continue;
            const double angle = other + (k & 2 ? p->turn : 0);
            list[n++] = angle - 360 * floor(angle / 360);
        }
    sort_doubles(list, (size_t)n);
    for (int i = 0; i < n; i++)
        if (!*count || list[i] > list[*count - 1] + SAME) list[(*count)++] = list[i];
    return list;
}

static void put_reals(struct ifc *f, const double *list, int count, double factor)
{
    char text[40];
    fputc('(', f->to);
    for (int i = 0; i < count; i++) fprintf(f->to, "%s%s", i ? "," : "", ifc_real(text, factor * list[i]));
    fputc(')', f->to);
}

static int put_plane(struct ifc *f, const struct photometry *p, double horizontal, double lumens)
{
    char text[40];
    const int id = ifc_next(f);
    fprintf(f->to, "#%d=IFCLIGHTDISTRIBUTIONDATA(%s,", id, ifc_real(text, horizontal * DEGREE));
    put_reals(f, p->vertical, p->vertical_count, DEGREE);
    fputs(",(", f->to);
    for (int v = 0; v < p->vertical_count; v++)
        fprintf(f->to, "%s%s", v ? "," : "",
                ifc_real(text, photometry_intensity(p, p->vertical[v], horizontal) / lumens));
    fputs("));\n", f->to);
    return id;
}

/* An IfcLightIntensityDistribution; 0: out of memory. */
static int put_distribution(struct ifc *f, const struct photometry *p)
{
    struct ifc_ids planes = {0};
    int count, id = 0;
    double *horizontal = all_horizontal(&count, p, f->err);
    const double lumens = photometry_lumens(p);
    for (int i = 0; !f->err->status && i < count; i++) ifc_keep(f, &planes, put_plane(f, p, horizontal[i], lumens));
    if (!f->err->status) {
        id = ifc_next(f);
        fprintf(f->to, "#%d=IFCLIGHTINTENSITYDISTRIBUTION(.TYPE_C.,", id);
        ifc_put_ids(f, &planes);
        fputs(");\n", f->to);
    }
    free(planes.list);
    free(horizontal);
    return id;
}

static double temperature(const double c[3])
{
    const double x = 0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2], y = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    const double z = 0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2], sum = x + y + z;
    const double n = (x / sum - 0.3320) / (0.1858 - y / sum);
    return clamp(((449 * n + 3525) * n + 6823.3) * n + 5520.33, 1000, 40000);
}

static int put_source(struct ifc *f, const struct planned_lamp *l)
{
    char r[40], g[40], b[40];
    double c[3];
    export_lamps_colour(c, l);
    const int distribution = put_distribution(f, &l->web);
    const int rgb = ifc_put(f, "IFCCOLOURRGB($,%s,%s,%s)", ifc_real(r, c[0]), ifc_real(g, c[1]), ifc_real(b, c[2]));
    const int at = ifc_point(f, l->at), up = ifc_direction(f, vec3_scale(l->down, -1));
    const int place = ifc_put(f, "IFCAXIS2PLACEMENT3D(#%d,#%d,#%d)", at, up, ifc_direction(f, l->along));
    const int id = ifc_next(f);
    fprintf(f->to, "#%d=IFCLIGHTSOURCEGONIOMETRIC(", id);
    ifc_text(f->to, l->name);
    fprintf(f->to, ",#%d,$,$,#%d,#%d,%s,%s,.NOTDEFINED.,#%d);\n", rgb, place, rgb, ifc_real(r, temperature(c)),
            ifc_real(g, export_lamps_lumens(l)), distribution);
    return id;
}

static enum status put_lamp(struct ifc *f, int lamp)
{
    const struct planned_lamp *l = &f->s->lamps->planned.list[lamp];
    struct vec3 corners[PLANNED_LAMP_CORNERS];
    int fan[PLANNED_LAMP_CORNERS][3];
    char key[300];
    double c[3];
    const int count = export_lamps_outline(corners, f->s->lamps, lamp);
    for (int k = 0; k < count - 2; k++) fan[k][0] = 0, fan[k][1] = k + 1, fan[k][2] = k + 2;
    export_lamps_colour(c, l);
    const int set = ifc_triangle_set(f, corners, count, (const int(*)[3])fan, count - 2);
    ifc_put(f, "IFCSTYLEDITEM(#%d,(#%d),$)", set, ifc_style(f, l->name, c));
    const int body = ifc_representation(f, "Body", "Tessellation", &(struct ifc_ids){(int[]){set}, 1});
    const int source = put_source(f, l);
    const int light = ifc_representation(f, "Lighting", "LightSource", &(struct ifc_ids){(int[]){source}, 1});
    const int shape = ifc_put(f, "IFCPRODUCTDEFINITIONSHAPE($,$,(#%d,#%d))", body, light);
    snprintf(key, sizeof key, "lamp/%s", l->name);
    return ifc_keep(f, &f->contained, ifc_element_of(f, "IFCLIGHTFIXTURE", key, l->name, shape, ",.NOTDEFINED."));
}

enum status ifc_lamps(struct ifc *f)
{
    for (int i = 0; !f->err->status && i < f->s->lamps->planned.count; i++) put_lamp(f, i);
    return f->err->status;
}
