/* made_room.c - a described scene of a furnished room that a seed decides, for figures on rooms that nobody tuned on.
 *
 *   made_room --seed N --out DIR [--small]
 *
 * DIR is scenes/NAME of a project. The scene is a rectangular or L-shaped room, or two rooms with a doorway, with
 * furniture made of boxes, pictures, windows, lamps and sun, and 20 to 26 photos through the fisheye lens of
 * scenes/loft. Writes
 *   scene.txt, cameras.txt               the furnished rooms and the photos (docs/scenes.md)
 *   scene-bare.txt, scene-moved.txt      without furniture; with one piece gone and one moved
 *   scene-window.txt                     with a larger window
 *   model.txt, scale.txt, things.txt, lights.txt, edits/bare.txt, edits/moved.txt, edits/window.txt
 *                                        what a person would write of it, by marks in the photos
 *   scene.mk, scene.cfg                  photos are rendered at half the size in cameras.txt
 * --small: the same room in 12 or 14 of these photos, which are rendered at 0.3 of that size, and settings for
 * these.
 * The same seed gives the same bytes. */
#include <stdio.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/outfile.h"
#include "tests/bench/room/made_room.h"

enum { ATTEMPTS = 400, PATH = 4096 };

/* Draws rooms until one has all that it must have. */
static enum status draw_room(struct made_room *r, int seed, struct err *err)
{
    for (int i = 0; i < ATTEMPTS; i++) {
        *r = (struct made_room){.seed = seed, .scale = MADE_SCALE};
        if (!made_outline(r, i) || !made_furniture(r, i) || !made_pictures(r, i) || !made_photos(r, i)) continue;
        if (!made_marks(r)) continue;
        made_larger_window(r);
        return ST_OK;
    }
    return err_set(err, ST_DATA, "--seed %d: none of %d attempts led to a room; try another seed.", seed, ATTEMPTS);
}

struct scene_folder {
    const char *path, *name;
};

static void write_make(const struct scene_folder *f, FILE *to)
{
    fprintf(to, "# Rendered by the project itself from scene.txt and cameras.txt (docs/scenes.md).\n");
    fprintf(to, "PHOTOS := out/%s/simulated/photos\nTRUTH := out/%s/simulated/truth\n", f->name, f->name);
    fprintf(to, "PRODUCTS := model textures\n");
}

static void write_config(const struct made_room *r, FILE *to)
{
    fprintf(to, "[simulate]\nsamples = 8\nscale = %g\nirradiance_points = 0\n\n", r->scale);
    fprintf(to, "[sfm]\ncamera_model = EQUISOLID\ncamera_params = %.9f\nrefine_camera = no\nsingle_camera = yes\n",
            MADE_FOCAL * r->scale / MADE_SCALE);
    if (r->scale < MADE_SCALE) /* as many planes and directions for a pixel as in the larger photos */
        fprintf(to, "\n[segment_depth]\nplanes = 64\n\n[bake_outdoors]\nheight = 1024\n");
}

static enum status open_file(struct outfile *file, const struct scene_folder *f, const char *name, struct err *err)
{
    char path[PATH];
    if (snprintf(path, sizeof path, "%s/%s", f->path, name) >= PATH)
        return err_set(err, ST_USAGE, "--out %s: the path is too long.", f->path);
    return outfile_open(file, path, err);
}

static enum status write_texts(const struct made_room *r, const struct scene_folder *f, struct err *err)
{
    static const struct {
        const char *name;
        void (*write)(const struct made_room *r, FILE *to);
    } texts[] = {
        {"scene.txt", made_write_scene},          {"scene-bare.txt", made_write_bare},
        {"scene-moved.txt", made_write_moved},    {"cameras.txt", made_write_cameras},
        {"model.txt", made_write_model},          {"scale.txt", made_write_scale},
        {"things.txt", made_write_things},        {"lights.txt", made_write_lights},
        {"edits/bare.txt", made_write_edit_bare}, {"edits/moved.txt", made_write_edit_moved},
        {"scene-window.txt", made_write_window},  {"edits/window.txt", made_write_edit_window},
    };
    for (size_t i = 0; !err->status && i < sizeof texts / sizeof *texts; i++) {
        struct outfile file = {0};
        if (open_file(&file, f, texts[i].name, err)) break;
        texts[i].write(r, file.fp);
        outfile_commit(&file, err);
    }
    return err->status;
}

static enum status write_settings(const struct made_room *r, const struct scene_folder *f, struct err *err)
{
    struct outfile file = {0};
    if (open_file(&file, f, "scene.mk", err)) return err->status;
    write_make(f, file.fp);
    if (outfile_commit(&file, err) || open_file(&file, f, "scene.cfg", err)) return err->status;
    write_config(r, file.fp);
    return outfile_commit(&file, err);
}

static enum status make_scene(int seed, bool small, const char *out, struct err *err)
{
    static struct made_room room; /* too large for the stack */
    const char *slash = strrchr(out, '/');
    const struct scene_folder folder = {out, slash ? slash + 1 : out};
    if (!*folder.name) return err_set(err, ST_USAGE, "--out %s ends in a slash; its last name is the scene's.", out);
    if (draw_room(&room, seed, err)) return err->status;
    if (small) made_small(&room);
    if (write_texts(&room, &folder, err)) return err->status;
    return write_settings(&room, &folder, err);
}

int main(int argc, char **argv)
{
    int seed = 1;
    bool small = false;
    const char *out = NULL;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Makes the described scene of a furnished room from a seed."),
        CLI_INT("seed", &seed, CLI_REQUIRED, "number that decides everything"),
        CLI_STR("out", &out, CLI_REQUIRED, "folder to write, scenes/NAME"),
        CLI_FLAG("small", &small, "fewer and smaller photos of the same room"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "made_room", opts, &prov, &err) == CLI_RUN) make_scene(seed, small, out, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
