/* faces.c - exported triangles: they cover their faces, and their texture coordinates are the atlas's own. */
#include "stages/export_model/export_faces.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stages/build_model/solid/unite.h"
#include "stages/export_model/writers.h"
#include "tests/unit/build_model/scripted.h"

enum { TEXELS = 10 }; /* in a unit */

struct room {
    struct plan plan;
    struct solid_list solids;
    struct solid_mesh mesh;
    struct atlas atlas;
};

/* A tile for each face name, as large as the model's bounding box needs; the wall south/in has two, left and right. */
static void make(struct room *r, const char *text)
{
    struct err err = ERR_INIT;
    *r = (struct room){0};
    build(&r->plan, &r->solids, text, NULL);
    assert_ok(unite_solids(&r->mesh, &r->solids, NULL, &err), err);
    r->atlas.tiles = calloc(2 * (size_t)r->mesh.name_count, sizeof *r->atlas.tiles);
    r->atlas.page_sizes = calloc(1, sizeof *r->atlas.page_sizes);
    assert_true(r->atlas.tiles && r->atlas.page_sizes);
    r->atlas.page_count = 1;
    r->atlas.page_sizes[0][0] = r->atlas.page_sizes[0][1] = 1024;
    for (int n = 0; n < r->mesh.name_count; n++) {
        int face = 0;
        while (r->mesh.faces[face].name != n) face++;
        const struct vec3 normal = r->mesh.faces[face].normal;
        const int u = fabs(normal.x) > 0.5 ? 1 : 0, v = fabs(normal.z) > 0.5 ? 1 : 2;
        const bool split = !strcmp(r->mesh.names[n].name, "wall/south/in");
        for (int half = 0; half < (split ? 2 : 1); half++) {
            struct atlas_tile *t = &r->atlas.tiles[r->atlas.tile_count++];
            /* 6 units from -1; of the wall's two tiles the second begins at 2 */
            *t = (struct atlas_tile){.face = r->mesh.names[n].id, .view = -1, .x = 100 * half, .y = 8 * n};
            t->width = split ? half ? 4 * TEXELS : 3 * TEXELS : 6 * TEXELS;
            t->height = 6 * TEXELS;
            t->matrix[0][u] = t->matrix[1][v] = TEXELS;
            t->matrix[0][3] = t->x + TEXELS * (half ? -2 : 1);
            t->matrix[1][3] = t->y + TEXELS;
            t->matrix[2][3] = 1;
        }
    }
}

static void release(struct room *r)
{
    atlas_release(&r->atlas);
    solid_mesh_release(&r->mesh);
    drop(&r->plan, &r->solids);
}

static double area_of(const struct export_triangle *t)
{
    return vec3_length(vec3_cross(vec3_sub(t->p[1], t->p[0]), vec3_sub(t->p[2], t->p[0]))) / 2;
}

static void triangles_cover_each_face_and_keep_its_direction(void **state)
{
    struct room r;
    struct export_faces f;
    struct err err = ERR_INIT;
    (void)state;
    make(&r, TWO "window w on south from 3 1 to 3.5 2\n");
    assert_ok(export_faces_make(&f, &r.mesh, NULL, &r.atlas, &err), err);
    double volume = 0;
    for (int face = 0; face < r.mesh.face_count; face++) {
        double area = 0;
        for (int i = f.first[face]; i < f.first[face + 1]; i++) {
            const struct export_triangle *t = &f.triangles[i];
            assert_true(vec3_dot(vec3_cross(vec3_sub(t->p[1], t->p[0]), vec3_sub(t->p[2], t->p[0])),
                                 r.mesh.faces[face].normal) > 0);
            area += area_of(t);
            volume += vec3_dot(t->p[0], vec3_cross(t->p[1], t->p[2])) / 6;
        }
        assert_true(fabs(area - solid_mesh_area(&r.mesh, face)) < 1e-9);
    }
    assert_true(fabs(volume - solid_mesh_volume(&r.mesh, -1)) < 1e-9);
    export_faces_release(&f);
    release(&r);
}

static void coordinates_are_those_of_the_atlas(void **state)
{
    struct room r;
    struct export_faces f;
    struct err err = ERR_INIT;
    int textured = 0, panes = 0;
    (void)state;
    make(&r, TWO "window w on south from 3 1 to 3.5 2\n");
    assert_ok(export_faces_make(&f, &r.mesh, NULL, &r.atlas, &err), err);
    for (int i = 0; i < f.count; i++) {
        const struct export_triangle *t = &f.triangles[i];
        panes += t->material == MATERIAL_GLASS;
        if (t->material != 0) continue;
        textured++;
        const struct vec3 middle = vec3_scale(vec3_add(t->p[0], vec3_add(t->p[1], t->p[2])), 1.0 / 3);
        double x, y;
        const struct atlas_tile *tile = atlas_find(&r.atlas, solid_face_id(&r.mesh, t->face), middle, &x, &y);
        assert_non_null(tile);
        const double u = (t->uv[0][0] + t->uv[1][0] + t->uv[2][0]) / 3,
                     v = (t->uv[0][1] + t->uv[1][1] + t->uv[2][1]) / 3;
        assert_true(fabs(1024 * u - x) < 0.01 + 0.5 && fabs(1024 * v - y) < 0.01 + 0.5);
        /* a triangle stays in one tile, half a texel from its border */
        for (int k = 0; k < 3; k++) {
            assert_true(1024 * t->uv[k][0] >= tile->x + 0.49 && 1024 * t->uv[k][0] <= tile->x + tile->width - 0.49);
            assert_true(1024 * t->uv[k][1] >= tile->y + 0.49 && 1024 * t->uv[k][1] <= tile->y + tile->height - 0.49);
        }
    }
    assert_true(textured > 50 && panes >= 12);
    export_faces_release(&f);
    release(&r);
}

static void a_rule_moves_texture_and_a_colour_covers_a_part(void **state)
{
    struct room r;
    struct export_faces f;
    struct err err = ERR_INIT;
    (void)state;
    make(&r, ROOM);
    int face = 0;
    while (strcmp(solid_face_name(&r.mesh, face), "wall/north/in")) face++;
    struct texture_rule rules[2] = {{.kind = TEXTURE_COLOUR,
                                     .albedo = {0.5F, 0.25F, 0},
                                     .limited = true,
                                     .within = {{1, 3, 0.5}, {2, 3, 0.5}, {2, 3, 1.5}, {1, 3, 1.5}}},
                                    {.kind = TEXTURE_PLACE,
                                     .from = solid_face_id(&r.mesh, face),
                                     .matrix = {{1, 0, 0, 0.5}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};
    struct texture_face of = {.id = solid_face_id(&r.mesh, face),
                              .normal = r.mesh.faces[face].normal,
                              .offset = r.mesh.faces[face].offset,
                              .rules = rules,
                              .rule_count = 2};
    const struct texture_map map = {.faces = &of, .face_count = 1};
    assert_ok(export_faces_make(&f, &r.mesh, &map, &r.atlas, &err), err);
    double coloured = 0;
    for (int i = f.first[face]; i < f.first[face + 1]; i++) {
        const struct export_triangle *t = &f.triangles[i];
        if (t->material == MATERIAL_COLOUR) coloured += area_of(t);
        if (t->material != 0) continue;
        double x, y;
        const struct vec3 moved = vec3_add(t->p[0], vec3_make(0.5, 0, 0));
        if (!atlas_find(&r.atlas, of.id, moved, &x, &y)) continue;
        assert_true(fabs(1024 * t->uv[0][0] - x) < 0.51);
    }
    assert_true(fabs(coloured - 1) < 1e-9);
    export_faces_release(&f);
    release(&r);
}

static void identifiers_repeat_and_differ(void **state)
{
    char a[23], b[23], c[23];
    (void)state;
    ifc_guid(a, "scene/IFCWALL/south");
    ifc_guid(b, "scene/IFCWALL/south");
    ifc_guid(c, "scene/IFCWALL/north");
    assert_string_equal(a, b);
    assert_string_not_equal(a, c);
    assert_int_equal(strlen(a), 22);
    assert_true(a[0] >= '0' && a[0] <= '3'); /* 128 bits: the first digit has two */
}

static void strings_are_those_of_step(void **state)
{
    char *text = NULL;
    size_t size = 0;
    (void)state;
    FILE *to = open_memstream(&text, &size);
    ifc_text(to, "a'b\\c K\xc3\xbc"
                 "che \xe2\x82\xac");
    fclose(to);
    assert_string_equal(text, "'a''b\\\\c K\\X2\\00FC\\X0\\che \\X2\\20AC\\X0\\'");
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangles_cover_each_face_and_keep_its_direction),
        cmocka_unit_test(coordinates_are_those_of_the_atlas),
        cmocka_unit_test(a_rule_moves_texture_and_a_colour_covers_a_part),
        cmocka_unit_test(identifiers_repeat_and_differ),
        cmocka_unit_test(strings_are_those_of_step),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
