/* draw_model.c - writes a page in which people draw the model of a scene on its photographs.
 *
 * reads   VIEWS, AXES, POINTS, LINES, SUGGESTED, CONFIG   what build_model reads, straight edges, a first script
 *         CANDIDATES, LIGHTS                    marks of lamps that fit_lights proposes, lamps that it fitted
 *         THINGS                                furniture, its surfaces, and which of it each view shows
 *         REFERENCES/ID.jpg                     lighting reference images
 *         SCENE/NAME.txt, NAME.obj, edits/E.txt, masks/PHOTO.png   what people wrote of the scene
 *         RECORDS/PHOTO.txt, PHOTOS/FILE        the photographs
 *         WASM                                  build_model as WebAssembly
 *         PAGE/page.html                        the page's sources
 * writes  OUT/photos/PHOTO.js, photos.js, scene.js, points.js, code.js, then index.html */
#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/product/product.h"
#include "stages/draw_model/draw_data.h"

static enum status write_all(const char *out, const struct draw_sources *from, struct err *err)
{
    char scene[FILE_PATH], points[FILE_PATH], code[FILE_PATH], page[FILE_PATH];
    return product_path_in(scene, out, PRODUCT_DRAW_SCENE, NULL, err) ||
                   product_path_in(points, out, PRODUCT_DRAW_POINTS, NULL, err) ||
                   product_path_in(code, out, PRODUCT_DRAW_CODE, NULL, err) ||
                   product_path_in(page, out, PRODUCT_DRAW_PAGE, NULL, err) || draw_photos_write(out, from, err) ||
                   draw_data_write_scene(scene, from, err) || draw_points_write(points, from, err) ||
                   draw_data_write_code(code, from, err) || draw_page_write(page, from, err)
               ? err->status
               : ST_OK;
}

int main(int argc, char **argv)
{
    struct draw_params params = DRAW_PARAMS_DEFAULT;
    struct draw_sources from = {.params = &params};
    const char *out = NULL;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Writes a page in which people draw the model of a scene on its photographs."),
        CLI_STR("name", &from.name, CLI_REQUIRED, "name of the scene"),
        CLI_STR("scene", &from.scene, CLI_REQUIRED, "folder of what people wrote of it: model.txt, edits/E.txt"),
        CLI_STR("views", &from.views, CLI_REQUIRED, "folder of the cameras"),
        CLI_STR("axes", &from.axes, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("points", &from.points, CLI_OPTIONAL, "PLY of oriented points, for walls given by rectangles"),
        CLI_STR("lines", &from.lines, CLI_OPTIONAL, "folder of the views' straight edges, to snap to"),
        CLI_STR("suggested", &from.suggested, CLI_OPTIONAL, "a first script, to begin with"),
        CLI_STR("candidates", &from.candidates, CLI_OPTIONAL, "marks of lamps that fit_lights proposes"),
        CLI_STR("lights", &from.lights, CLI_OPTIONAL, "lamps that fit_lights fitted, to show beside their marks"),
        CLI_STR("things", &from.things, CLI_OPTIONAL, "folder of the furniture that find_things found"),
        CLI_STR("references", &from.references, CLI_OPTIONAL, "folder of lighting reference images, ID.jpg"),
        CLI_STR("model-config", &from.config, CLI_OPTIONAL, "effective parameters of build_model"),
        CLI_STR("photos", &from.photos, CLI_REQUIRED, "folder of the photographs"),
        CLI_STR("records", &from.records, CLI_REQUIRED, "folder of the photos' records"),
        CLI_STR("wasm", &from.wasm, CLI_REQUIRED, "build_model as WebAssembly"),
        CLI_STR("page", &from.page, CLI_REQUIRED, "folder of the page's sources"),
        CLI_STR("out", &out, CLI_REQUIRED, "folder to write the page to"),
        CLI_PARAMS(draw_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "draw_model", opts, &prov, &err) != CLI_RUN || write_all(out, &from, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
