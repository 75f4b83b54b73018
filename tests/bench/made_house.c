/* made_house.c - a described scene of a furnished house that a seed decides: one to thirty rooms, any number of photos.
 *
 *   made_house --seed N --rooms R --views V [--size WIDTHxHEIGHT] [--exposures 1|3] --out DIR
 *
 * DIR is scenes/NAME of a project. Writes scene.txt and cameras.txt (docs/scenes.md), scene.mk, scene.cfg, and
 * plan.txt: the true rooms, walls, doors and windows, against which a suggested plan is scored. The house of the
 * thesis that the method is from: --rooms 8 --views 460 --size 720x480 --exposures 3. The same options give the same
 * bytes. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/outfile.h"
#include "tests/bench/house/house.h"

enum { ATTEMPTS = 2000, PATH = 4096 };

struct scene_folder {
    const char *path, *name;
};

static enum status begin(struct outfile *file, const struct scene_folder *f, const char *name, struct err *err)
{
    char path[PATH];
    if (snprintf(path, sizeof path, "%s/%s", f->path, name) >= PATH)
        return err_set(err, ST_USAGE, "--out %s: the path is too long.", f->path);
    return outfile_open(file, path, err);
}

static enum status write_scene(const struct house *h, const struct house_camera *camera, const struct scene_folder *f,
                               struct err *err)
{
    struct outfile file = {0};
    if (begin(&file, f, "scene.txt", err)) return err->status;
    house_write_scene(h, file.fp);
    if (outfile_commit(&file, err) || begin(&file, f, "cameras.txt", err)) return err->status;
    house_write_cameras(h, camera, file.fp);
    if (outfile_commit(&file, err) || begin(&file, f, "plan.txt", err)) return err->status;
    house_write_plan(h, file.fp);
    if (outfile_commit(&file, err) || begin(&file, f, "scene.mk", err)) return err->status;
    fprintf(file.fp, "# Rendered by the project itself from scene.txt and cameras.txt (docs/scenes.md).\n");
    fprintf(file.fp, "PHOTOS := out/%s/simulated/photos\nTRUTH := out/%s/simulated/truth\n", f->name, f->name);
    fprintf(file.fp, "PRODUCTS := model textures\n");
    if (outfile_commit(&file, err) || begin(&file, f, "scene.cfg", err)) return err->status;
    fprintf(file.fp, "[simulate]\nsamples = 8\nirradiance_points = 0\n\n[sfm]\ncamera_model = EQUISOLID\n");
    fprintf(file.fp, "camera_params = %.9f\nrefine_camera = no\nsingle_camera = yes\n",
            MADE_FOCAL / MADE_WIDTH * camera->width);
    return outfile_commit(&file, err);
}

static enum status make_house(struct house *h, int rooms, int views, const struct house_camera *camera, const char *out,
                              struct err *err)
{
    const char *slash = strrchr(out, '/');
    const struct scene_folder folder = {out, slash ? slash + 1 : out};
    int attempt = 0;
    if (!*folder.name) return err_set(err, ST_USAGE, "--out %s ends in a slash; its last name is the scene's.", out);
    while (attempt < ATTEMPTS && !house_plan(h, rooms, attempt)) attempt++;
    if (attempt == ATTEMPTS)
        return err_set(err, ST_DATA, "--seed %d: none of %d attempts led to a house of %d rooms; try another seed.",
                       h->seed, ATTEMPTS, rooms);
    if (!(h->rooms = calloc((size_t)rooms, sizeof *h->rooms)))
        return err_nomem(err, "rooms of a house", (size_t)rooms * sizeof *h->rooms);
    const int photos = house_furnish(h, views);
    if (photos < views)
        log_warn("%d photos were asked for, and %d have a place; ask for more rooms or fewer photos.", views, photos);
    if (!write_scene(h, camera, &folder, err))
        printf("rooms %d walls %d doors %d windows %d bays %d slopes %d photos %d\n", rooms, h->wall_count,
               h->door_count, h->window_count, h->bay_count, h->slope_count, photos);
    free(h->rooms);
    return err->status;
}

static enum status check(int rooms, int views, const char *size, struct house_camera *camera, struct err *err)
{
    char rest;
    if (rooms < 1 || rooms > HOUSE_ROOMS)
        return err_set(err, ST_USAGE, "--rooms %d: wanted 1 to %d.", rooms, HOUSE_ROOMS);
    if (views < 2) return err_set(err, ST_USAGE, "--views %d: wanted at least 2.", views);
    if (camera->exposures != 1 && camera->exposures != 3)
        return err_set(err, ST_USAGE, "--exposures %d: wanted 1 or 3.", camera->exposures);
    if (sscanf(size, "%dx%d%c", &camera->width, &camera->height, &rest) != 2 || camera->width < 64 ||
        camera->width > 8192 || camera->height < 64 || camera->height > 8192)
        return err_set(err, ST_USAGE, "--size %s: wanted WIDTHxHEIGHT, each 64 to 8192.", size);
    return ST_OK;
}

int main(int argc, char **argv)
{
    static struct house house; /* too large for the stack */
    int rooms = 8, views = 100;
    struct house_camera camera = {.exposures = 3};
    const char *out = NULL, *size = "480x320";
    const struct cli_opt opts[] = {
        CLI_ABOUT("Makes the described scene of a furnished house from a seed."),
        CLI_INT("seed", &house.seed, CLI_REQUIRED, "number that decides everything"),
        CLI_INT("rooms", &rooms, CLI_OPTIONAL, "number of rooms, corridors among them (8)"),
        CLI_INT("views", &views, CLI_OPTIONAL, "number of photos (100)"),
        CLI_STR("size", &size, CLI_OPTIONAL, "size of photos (480x320)"),
        CLI_INT("exposures", &camera.exposures, CLI_OPTIONAL, "exposures of each photo, 1 or 3 (3)"),
        CLI_STR("out", &out, CLI_REQUIRED, "folder to write, scenes/NAME"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "made_house", opts, &prov, &err) == CLI_RUN && !check(rooms, views, size, &camera, &err))
        make_house(&house, rooms, views, &camera, out, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
