/* glossy_field.h - shared by tests: the room of box_field.h with materials.
 *
 * The room is 4 x 4 x 4 about the origin. View v0, from which all texels but those of the wall -x come, looks down on
 * the floor; v1 looks up at the ceiling. */
#ifndef REMODEL_TESTS_GLOSSY_FIELD_H
#define REMODEL_TESTS_GLOSSY_FIELD_H

#include "tests/unit/common/gather/box_field.h"

static const struct model_axes axes = {.rotation = {1, 0, 0, 0}, .translation = {1, 2, 3}, .scale = 2};
static const struct vec3 eye0 = {-1, 0.25, 0}, eye1 = {0.5, 0, 0.5};

/* Two photos of 400 x 400 pixels, 127 degrees wide, that are views as they are. */
static inline const char *write_views(void)
{
    static const char *const turns[2] = {"0 1 0 0", "1 0 0 0"};
    const struct vec3 eyes[2] = {eye0, eye1};
    char images[1024] = "", lenses[1024] = "remodel-lenses 1\n";
    for (int i = 0; i < 2; i++) {
        const struct vec3 c = world_from_model_point(&axes, eyes[i]);
        const double sign = i ? 1 : -1; /* half a turn about x: y and z change sign */
        snprintf(images + strlen(images), sizeof images - strlen(images), "%d %s %.17g %.17g %.17g 1 v%d.exr\n\n",
                 i + 1, turns[i], -c.x, -sign * c.y, -sign * c.z, i);
        snprintf(lenses + strlen(lenses), sizeof lenses - strlen(lenses),
                 "v%d v%d PINHOLE 400 400 100 100 200 200 turn 1 0 0 0\n", i, i);
    }
    scratch_write("cameras.txt", "1 PINHOLE 400 400 100 100 200 200\n");
    scratch_write("images.txt", images);
    scratch_write("lenses.txt", lenses);
    return scratch;
}

#define ALL        "0 0 400 0 400 400 0 400\n"
#define JUST_FLOOR "150 112.5 350 112.5 350 312.5 150 312.5\n" /* of v0 */

static inline struct model_field *read_with(struct built *b, const char *materials)
{
    struct model_field *f = read_field(b);
    struct err err = ERR_INIT;
    char text[2048];
    snprintf(text, sizeof text, "remodel-materials 1\n%s", materials);
    const char *path = scratch_write("materials.txt", text);
    assert_ok(model_field_read_materials(f, path, write_views(), &axes, NULL, &err), err);
    return f;
}

/* The floor has the material `line`: MODEL R G B K_S SHAPE. */
static inline struct model_field *glossy_floor(struct built *b, const float colours[][3], const char *line)
{
    char text[1024];
    b->files = (struct model_field_files){.model = write_boxes(room, 2), .vita = write_vita(colours, 6, 0)};
    snprintf(text, sizeof text, "material floor %s\nregion floor v0 " JUST_FLOOR, line);
    return read_with(b, text);
}

static inline const char *phong(double ks, double n)
{
    static char text[128];
    snprintf(text, sizeof text, "phong 0 0 0 %.17g %.17g", ks, n);
    return text;
}

#endif
