/* write_ifc.c - IFC4 (ISO 16739) as a STEP file (ISO 10303-21).
 *
 * Walls, slabs and spaces are extruded outlines (ifc_walls.c, ifc_rooms.c); an opening is a box that voids its wall or
 * slab, and a door or window fills it (ifc_fillings.c). Walls that are along no axis are the triangles of their faces.
 * Walls, openings, doors, windows, spaces and coverings have their lengths, areas and volumes (ifc_quantities.c).
 * An object or a piece of furniture is an IfcFurniture of triangles in one colour (ifc_objects.c), a lamp that an edit
 * adds an IfcLightFixture with its photometry (ifc_lamps.c).
 * Photographic texture is on coverings: each face of the model is an IfcCovering of triangles, with the texture maps
 * that IFC4 defines for IfcTriangulatedFaceSet, so that readers without textures lose nothing of the building. */
#include <stdlib.h>
#include <string.h>

#include "common/base/outfile.h"
#include "common/base/version.h"
#include "common/product/product.h"
#include "stages/export_model/ifc.h"

static int put_units(struct ifc *f)
{
    /* without a scale the unit's name says so */
    const int length = ifc_put(f, "IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)");
    const int area = ifc_put(f, "IFCSIUNIT(*,.AREAUNIT.,$,.SQUARE_METRE.)");
    const int volume = ifc_put(f, "IFCSIUNIT(*,.VOLUMEUNIT.,$,.CUBIC_METRE.)");
    const int angle = ifc_put(f, "IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.)");
    struct ifc_ids units = {0};
    const int own[] = {length, area, volume, angle};
    for (int i = 0; i < 4; i++) ifc_keep(f, &units, own[i]);
    if (f->s->lamps->planned.count) ifc_lamp_units(f, &units);
    const int assignment = ifc_next(f);
    fprintf(f->to, "#%d=IFCUNITASSIGNMENT(", assignment);
    ifc_put_ids(f, &units);
    fputs(");\n", f->to);
    free(units.list);
    return assignment;
}

static int put_part(struct ifc *f, const char *kind, const char *name, const char *rest)
{
    const int id = ifc_begin(f, kind, name);
    fprintf(f->to, ",%s,$,#%d,$%s);\n", f->s->metric ? "$" : "'The scale is unknown: lengths are not metres.'",
            f->placement, rest);
    return id;
}

static void put_aggregate(struct ifc *f, int whole, const char *name, const struct ifc_ids *parts)
{
    ifc_begin(f, "IFCRELAGGREGATES", name);
    fprintf(f->to, ",$,#%d,", whole);
    ifc_put_ids(f, parts);
    fputs(");\n", f->to);
}

static void put_head(struct ifc *f)
{
    const int origin = ifc_point(f, vec3_make(0, 0, 0));
    const int z = ifc_direction(f, vec3_make(0, 0, 1)), x = ifc_direction(f, vec3_make(1, 0, 0));
    f->axes = ifc_put(f, "IFCAXIS2PLACEMENT3D(#%d,#%d,#%d)", origin, z, x);
    f->placement = ifc_put(f, "IFCLOCALPLACEMENT($,#%d)", f->axes);
    f->context = ifc_put(f, "IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-6,#%d,$)", f->axes);
    const int units = put_units(f);
    const int project = ifc_begin(f, "IFCPROJECT", f->s->name);
    fprintf(f->to, ",$,$,$,$,(#%d),#%d);\n", f->context, units);
    int site = put_part(f, "IFCSITE", "site", ",$,.ELEMENT.,$,$,$,$,$");
    int building = put_part(f, "IFCBUILDING", "building", ",$,.ELEMENT.,$,$,$");
    f->storey = put_part(f, "IFCBUILDINGSTOREY", "storey", ",$,.ELEMENT.,0.");
    put_aggregate(f, project, "project", &(struct ifc_ids){&site, 1});
    put_aggregate(f, site, "site", &(struct ifc_ids){&building, 1});
    put_aggregate(f, building, "building", &(struct ifc_ids){&f->storey, 1});
}

static void put_pages(struct ifc *f)
{
    for (int i = 0; i < f->s->page_count; i++) {
        f->maps[i] = ifc_put(f, "IFCIMAGETEXTURE(.F.,.F.,'DIFFUSE',$,$,'page%d.png')", i);
        const int textures = ifc_put(f, "IFCSURFACESTYLEWITHTEXTURES((#%d))", f->maps[i]);
        const int white = ifc_put(f, "IFCCOLOURRGB($,1.,1.,1.)");
        const int shading = ifc_put(f, "IFCSURFACESTYLESHADING(#%d,0.)", white);
        f->styles[i] = ifc_put(f, "IFCSURFACESTYLE('page%d',.BOTH.,(#%d,#%d))", i, shading, textures);
    }
}

/* ------------------------------------------------------------------------------------------------------- coverings */

static const char *covering_type(const char *face)
{
    if (!strncmp(face, "floor/", 6)) return ",.FLOORING.";
    if (!strncmp(face, "ceiling/", 8)) return ",.CEILING.";
    return ",.CLADDING.";
}

/* The textured triangles of a face, one set for each page. */
static enum status put_covering(struct ifc *f, int face)
{
    const struct export_faces *all = f->s->faces;
    struct ifc_ids sets = {0};
    for (int i = all->first[face], end; !f->err->status && i < all->first[face + 1]; i = end) {
        const int page = all->triangles[i].material;
        end = i + 1;
        while (end < all->first[face + 1] && all->triangles[end].material == page) end++;
        if (page >= 0) ifc_keep(f, &sets, ifc_triangles(f, i, end, page));
    }
    if (!f->err->status && sets.count) {
        char name[1100];
        const int shape = ifc_tessellation(f, &sets);
        /* faces of one name are told apart by their number */
        snprintf(name, sizeof name, "%s %d", solid_face_name(f->s->mesh, face), face);
        const int id = ifc_element(f, "IFCCOVERING", name, shape, covering_type(solid_face_name(f->s->mesh, face)));
        const double area = solid_mesh_area(f->s->mesh, face);
        const struct ifc_quantity list[] = {{IFC_AREA, "GrossArea", area}, {IFC_AREA, "NetArea", area}};
        ifc_keep(f, &f->contained, id);
        ifc_quantities(f, id, "Qto_CoveringBaseQuantities", name, list, 2);
    }
    free(sets.list);
    return f->err->status;
}

static enum status put_body(struct ifc *f)
{
    put_head(f);
    put_pages(f);
    if (!ifc_walls(f) && !ifc_rooms(f) && !ifc_boxes(f) && !ifc_objects(f)) ifc_lamps(f);
    for (int i = 0; !f->err->status && i < f->s->mesh->face_count; i++) put_covering(f, i);
    if (!f->err->status && f->contained.count) {
        ifc_begin(f, "IFCRELCONTAINEDINSPATIALSTRUCTURE", "elements");
        fputs(",$,", f->to);
        ifc_put_ids(f, &f->contained);
        fprintf(f->to, ",#%d);\n", f->storey);
    }
    if (!f->err->status && f->spaces.count) put_aggregate(f, f->storey, "storey", &f->spaces);
    return f->err->status;
}

enum status write_ifc(const struct export_scene *s, struct err *err)
{
    struct ifc f = {.s = s, .err = err};
    struct outfile out = {0};
    char path[FILE_PATH];
    f.styles = calloc((size_t)s->page_count + 1, sizeof *f.styles);
    f.maps = calloc((size_t)s->page_count + 1, sizeof *f.maps);
    if (!f.styles || !f.maps) err_nomem(err, "pages", (size_t)s->page_count * sizeof *f.styles);
    if (!err->status && !product_path_in(path, s->out, PRODUCT_EXPORT_IFC, NULL, err) &&
        !outfile_open(&out, path, err)) {
        f.to = out.fp;
        fputs("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('ViewDefinition [ReferenceView]'),'2;1');\nFILE_NAME(", f.to);
        ifc_text(f.to, s->name);
        /* no date: the same model gives the same bytes */
        fputs(",'1970-01-01T00:00:00',(''),(''),'remodel " REMODEL_VERSION "','remodel " REMODEL_VERSION
              "','');\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n",
              f.to);
        put_body(&f);
        fputs("ENDSEC;\nEND-ISO-10303-21;\n", f.to);
        if (!err->status) outfile_commit(&out, err);
    }
    outfile_discard(&out);
    free(f.contained.list);
    free(f.spaces.list);
    free(f.styles);
    free(f.maps);
    return err->status;
}
