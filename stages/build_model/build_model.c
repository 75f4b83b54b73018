/* build_model.c - makes solid models of rooms from scripts (walls, rooms, doors, windows), and draws a model's edges on
 * photographs.
 *
 * reads   SCRIPT, EDIT                                  docs/model-script.md
 *         AXES                                          the model's frame, the ceiling's height
 *         VIEWS/cameras.txt, images.txt, lenses.txt     with --views: for places in photographs, and for the pictures
 *         POINTS                                        with --points: for walls given by rectangles
 *         BASE                                          with --edit: the unedited model, whose face ids are kept
 *         SCENE/objects.txt, meshes                     with --edit: synthetic objects
 *         THINGS                                        the names of things
 * writes  OUT/plan.svg, view.png, plan.txt, merged.txt, then model.txt; with --base before them texture.txt and
 *         objects.txt
 * With --overlay PHOTO instead:
 * reads   MODEL, AXES, VIEWS, RECORDS/PHOTO.txt, PHOTOS/FILE
 * writes  OUT                                           JPEG: the photograph with the model's edges */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/file_bytes.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/capture/photo_list.h"
#include "common/model/scene_inputs.h"
#include "common/product/product.h"
#include "stages/build_model/building/building.h"
#include "stages/build_model/picture/overlay_picture.h"
#include "stages/build_model/picture/overlay_shape.h"
#include "stages/build_model/picture/plan_picture.h"
#include "stages/build_model/picture/view_picture.h"

struct job {
    const char *script, *edit, *things, *scene, *axes, *views, *held, *points, *base, *out;
    const char *overlay, *model, *photos, *records, *same;
    char subject[256]; /* the edit's name, or "model" */
    struct model_params params;
    struct provenance prov;

    struct scene_inputs in, held_in; /* axes, views and lenses; views and lenses that are held out */
    struct placer placer;
};

static enum status read_frame(struct job *j, struct err *err)
{
    const struct scene_files files = {.views = j->views, .axes = j->axes}, held = {.views = j->held};
    const struct placer_views views[2] = {{&j->in.set, &j->in.lenses}, {&j->held_in.set, &j->held_in.lenses}};
    struct point_cloud cloud = {0};
    if (scene_inputs_read(&j->in, SCENE_AXES | (j->views ? SCENE_POINTS | SCENE_LENSES : 0), &files, &j->prov, err) ||
        !j->views)
        return err->status;
    if (j->held) scene_inputs_read(&j->held_in, SCENE_CAMERAS | SCENE_LENSES, &held, &j->prov, err);
    if (!err->status && j->points) point_cloud_read(&cloud, j->points, &j->prov, err);
    if (!err->status) place_init(&j->placer, views, &j->in.axes, j->points ? &cloud : NULL, &j->params, err);
    point_cloud_release(&cloud);
    return err->status;
}

/* shape.txt: left alone while the faces stay as they are, whatever else changed, so that no overlay is drawn again. */
static enum status write_shape(const struct job *j, const struct solid_mesh *mesh, struct err *err)
{
    struct overlay_shape shape = {0};
    char path[FILE_PATH], hash[HASH_TEXT], text[64 + HASH_TEXT];
    if (!product_path_in(path, j->out, PRODUCT_SHAPE, NULL, err) && !overlay_shape_make(&shape, mesh, err) &&
        !overlay_shape_hash(hash, &shape, err)) {
        const int size = snprintf(text, sizeof text, "%s\nhash %s\n", products[PRODUCT_SHAPE].head, hash);
        outfile_write_if_changed(path, text, (size_t)size, err);
    }
    overlay_shape_release(&shape);
    return err->status;
}

/* The pictures, shape.txt, then what model.txt stands for. */
static enum status write_model(struct job *j, struct building *b, const struct building_files *files, struct err *err)
{
    const struct placer *placer = j->views ? &j->placer : NULL;
    char path[FILE_PATH];
    if ((files->base && building_write_edit(b, files, j->out, &j->prov, err)) ||
        product_path_in(path, j->out, PRODUCT_PLAN_PICTURE, NULL, err) ||
        plan_picture_write(&b->plan, placer, j->in.axes.metric, path, err) ||
        product_path_in(path, j->out, PRODUCT_MODEL_PICTURE, NULL, err) ||
        view_picture_write(&b->mesh, &b->plan, placer, path, err) || write_shape(j, &b->mesh, err))
        return err->status;
    return building_write(b, j->out, &j->prov, err);
}

static void log_summary(const struct building *b)
{
    int merged = 0;
    for (int i = 0; i < b->log.count; i++) {
        if (b->log.notes[i].event != UNITE_MERGED) continue;
        if (++merged <= 12) log_note("face %s became part of %s", b->log.notes[i].name, b->log.notes[i].into);
    }
    if (merged > 12) log_note("and %d more, in merged.txt", merged - 12);
    log_note("%d walls, %d rooms, %d openings: %d faces in %d bodies, volume %.4g; closed, without self-intersection",
             b->plan.wall_count, b->plan.room_count, b->plan.opening_count, b->mesh.face_count, b->mesh.body_count,
             b->report.volume);
}

/* A run builds many edits: each line of a log says which one it is about. */
static void name_subject(struct job *j)
{
    const char *name = j->edit ? path_file_name(j->edit) : "model", *dot = strrchr(name, '.');
    snprintf(j->subject, sizeof j->subject, "%.*s", (int)(dot && dot > name ? (size_t)(dot - name) : strlen(name)),
             name);
    log_set_subject(j->subject);
}

static enum status build(struct job *j, struct err *err)
{
    const struct placer *placer = j->views ? &j->placer : NULL;
    const struct building_files files = {j->script, j->things, j->edit, j->base, j->scene};
    struct building building = {0};
    name_subject(j);
    if (!read_frame(j, err) && !building_make(&building, &files, &j->in.axes, placer, &j->prov, err) &&
        !write_model(j, &building, &files, err))
        log_summary(&building);
    building_release(&building);
    return err->status;
}

/* Whether the photo shows the edited model as it shows the unedited one. */
static enum status compare(bool *same, struct job *j, const struct solid_mesh *mesh, const struct photo_camera *camera,
                           struct err *err)
{
    struct solid_mesh base = {0};
    struct overlay_shape shapes[2] = {{0}};
    if (!solid_mesh_read(&base, j->base, NULL, err) && !overlay_shape_make(&shapes[0], &base, err) &&
        !overlay_shape_make(&shapes[1], mesh, err))
        *same = !overlay_shape_differs(&base, &shapes[0], mesh, &shapes[1], camera);
    for (int k = 0; k < 2; k++) overlay_shape_release(&shapes[k]);
    solid_mesh_release(&base);
    return err->status;
}

static enum status copy(const char *from, const char *to, struct err *err)
{
    struct file_bytes bytes = {0};
    struct outfile out = {0};
    if (!file_bytes_read(&bytes, from, err) && !outfile_open(&out, to, err)) {
        fwrite(bytes.bytes, 1, bytes.size, out.fp);
        outfile_commit(&out, err);
    }
    outfile_discard(&out);
    file_bytes_release(&bytes);
    return err->status;
}

static enum status overlay(struct job *j, struct err *err)
{
    struct solid_mesh mesh = {0};
    bool same = false;
    struct photo_record record = {0};
    struct photo photo = {0};
    char path[FILE_PATH];
    int at = 0;
    if (!read_frame(j, err)) solid_mesh_read(&mesh, j->model, NULL, err);
    if (!err->status) {
        while (at < j->placer.photo_count && strcmp(j->placer.photos[at].id, j->overlay)) at++;
        if (at == j->placer.photo_count) err_set(err, ST_DATA, "%s/lenses.txt has no photo %s.", j->views, j->overlay);
    }
    const struct photo_camera *camera = err->status ? NULL : &j->placer.photos[at].camera;
    if (!err->status && j->same) compare(&same, j, &mesh, camera, err);
    if (!err->status && same) copy(j->same, j->out, err);
    if (!err->status && !same && !photo_record_read(&record, j->records, j->overlay, NULL, err) &&
        !file_path(path, j->photos, record.file, "", err))
        photo_read(&photo, path, err);
    if (!err->status && !same && (photo.info.width != camera->lens.width || photo.info.height != camera->lens.height))
        err_set(err, ST_DATA, "%s has %d x %d pixels, but its lens is for %d x %d; make the views again.", path,
                photo.info.width, photo.info.height, camera->lens.width, camera->lens.height);
    if (!err->status && !same) overlay_write(&mesh, camera, &photo, j->params.overlay_side, j->out, err);
    photo_release(&photo);
    photo_record_release(&record);
    solid_mesh_release(&mesh);
    return err->status;
}

static enum status check_usage(const struct job *j, struct err *err)
{
    if (!j->overlay && !j->script) return err_set(err, ST_USAGE, "--script or --overlay is missing; see --help.");
    if (j->overlay && (!j->model || !j->views || !j->photos || !j->records))
        return err_set(err, ST_USAGE, "--overlay also needs --model, --views, --photos and --records.");
    if (j->same && !j->overlay) return err_set(err, ST_USAGE, "--same is only for --overlay.");
    if (j->same && !j->base) return err_set(err, ST_USAGE, "--same also needs --base, the model that it shows.");
    if (j->base && !j->edit && !j->same)
        return err_set(err, ST_USAGE, "--base is only for --edit and --same: it is the model before the edit.");
    if (j->scene && !j->edit) return err_set(err, ST_USAGE, "--scene is only for --edit: it has the edit's objects.");
    if ((j->points || j->held) && !j->views) return err_set(err, ST_USAGE, "--points and --held also need --views.");
    return ST_OK;
}

int main(int argc, char **argv)
{
    struct job j = {.params = MODEL_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Builds the solid model that a script describes, or draws a model's edges on a photograph."),
        CLI_STR("script", &j.script, CLI_OPTIONAL, "model script: walls, rooms, openings (docs/model-script.md)"),
        CLI_STR("edit", &j.edit, CLI_OPTIONAL, "script of changes to the model"),
        CLI_STR("things", &j.things, CLI_OPTIONAL,
                "names of things, furniture that edits may clear, move and copy: scenes/NAME/things.txt"),
        CLI_STR("scene", &j.scene, CLI_OPTIONAL,
                "with --edit: the scene's folder, with objects.txt for all edits and the meshes of objects"),
        CLI_STR("base", &j.base, CLI_OPTIONAL,
                "with --edit or --same: model.txt of the unedited model, whose face ids are kept"),
        CLI_STR("axes", &j.axes, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("views", &j.views, CLI_OPTIONAL, "folder of cameras, for places in photographs and for the pictures"),
        CLI_STR("held", &j.held, CLI_OPTIONAL,
                "folder of cameras of photos held out, in which places may be drawn too"),
        CLI_STR("points", &j.points, CLI_OPTIONAL, "PLY of oriented points, for walls given by rectangles"),
        CLI_STR("overlay", &j.overlay, CLI_OPTIONAL,
                "photo on which to draw the edges of --model; --out is then a JPEG"),
        CLI_STR("model", &j.model, CLI_OPTIONAL, "with --overlay: model.txt"),
        CLI_STR("photos", &j.photos, CLI_OPTIONAL, "with --overlay: folder of the photographs"),
        CLI_STR("records", &j.records, CLI_OPTIONAL, "with --overlay: folder of the photos' records"),
        CLI_STR("same", &j.same, CLI_OPTIONAL,
                "with --overlay and --base: JPEG of the edges of --base, which is copied if the photo shows no other"),
        CLI_STR("out", &j.out, CLI_REQUIRED, "folder to write the model to, or with --overlay the JPEG"),
        CLI_PARAMS(model_param_table, &j.params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "build_model", opts, &j.prov, &err) != CLI_RUN || check_usage(&j, &err) ||
        (j.overlay ? overlay(&j, &err) : build(&j, &err)))
        err_report(&err);
    place_release(&j.placer);
    scene_inputs_release(&j.held_in);
    scene_inputs_release(&j.in);
    provenance_release(&j.prov);
    return err_exit_code(&err);
}
