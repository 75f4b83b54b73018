/* trace_ids.c - which face of the model each pixel of a view shows, at which depth, and what stands in front of it.
 *
 * reads   MODEL, EDIT...                                the unedited model, those of the edits
 *         AXES                                          their frame in the scene
 *         VIEWS/cameras.txt, images.txt, points3D.txt   the cameras
 *         DEPTH/VIEW.exr, VIEW.txt                      the view's depth, for what stands in front of the model
 * writes  OUT, OUT with .txt for .exr                   faces of a view, and their list
 *         REVEAL                                        faces that the edits reveal to the view
 *         INDEX                                         with --index: which views show a face, from all lists in IDS */
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/model/model_axes.h"
#include "common/texture/face_index.h"
#include "stages/trace_ids/reveal.h"
#include "stages/trace_ids/view_records.h"

struct request {
    const char *model, *axes, *views, *depth, *view, *out, *reveal, *index, *ids;
    struct cli_list edits;
};

struct inputs {
    struct camera_set set;
    struct model_axes axes;
    struct solid_mesh mesh;
    struct ray_scene rays;
    struct view camera; /* in the model's frame */
};

static enum status read_inputs(struct inputs *in, const struct request *r, struct provenance *prov, struct err *err)
{
    int view = -1;
    enum status st = camera_set_read(&in->set, r->views, err);
    if (!st) st = camera_set_add_inputs(prov, r->views, err);
    if (!st && (view = camera_set_find(&in->set, r->view)) < 0)
        st = err_set(err, ST_USAGE, "there is no view %s in %s/images.txt; the views are listed in %s/views.mk.",
                     r->view, r->views, r->views);
    if (!st) st = model_axes_read(&in->axes, r->axes, err);
    if (!st) st = provenance_add_file(prov, "model/axes.txt", r->axes, err);
    if (!st) st = solid_mesh_read(&in->mesh, r->model, err);
    if (!st) st = provenance_add_file(prov, "model/model.txt", r->model, err);
    if (!st) st = model_rays_make(&in->rays, &in->mesh, true, err);
    if (!st) in->camera = model_from_world_view(&in->axes, &in->set.views[view]);
    return st;
}

static void release_inputs(struct inputs *in)
{
    ray_scene_release(&in->rays);
    solid_mesh_release(&in->mesh);
    camera_set_release(&in->set);
}

static enum status add_clutter(struct view_faces *f, const struct inputs *in, const struct request *r,
                               struct provenance *prov, struct err *err)
{
    struct layered_depth depth = {0};
    char path[FILE_PATH];
    enum status st = provenance_add_in(prov, "depth", r->depth, r->view, ".txt", path, err);
    if (!st) st = provenance_add_in(prov, "depth", r->depth, r->view, ".exr", path, err);
    if (!st) st = layered_depth_read_interior(&depth, path, err);
    if (!st) st = view_faces_find_clutter(f, &in->mesh, &depth, in->axes.scale, err);
    layered_depth_release(&depth);
    return st;
}

static enum status write_reveal(const struct view_faces *f, const struct inputs *in, const struct request *r,
                                const struct provenance *prov, struct err *err)
{
    struct revealed revealed = {0};
    struct solid_mesh *edits = calloc((size_t)r->edits.count + 1, sizeof *edits);
    enum status st = edits ? ST_OK : err_nomem(err, "edits", (size_t)r->edits.count * sizeof *edits);
    for (int i = 0; !st && i < r->edits.count; i++) st = solid_mesh_read(&edits[i], r->edits.items[i], err);
    if (!st) st = reveal_find(&revealed, &in->mesh, f, edits, r->edits.count, &in->camera, err);
    if (!st) st = reveal_write(&revealed, in->axes.scale, r->reveal, prov, err);
    for (int i = 0; edits && i < r->edits.count; i++) solid_mesh_release(&edits[i]);
    free(edits);
    reveal_release(&revealed);
    return st;
}

static enum status trace_view(const struct request *r, struct provenance *prov, struct err *err)
{
    struct inputs in = {0};
    struct view_faces faces = {0};
    enum status st = read_inputs(&in, r, prov, err);
    if (!st) st = view_faces_trace(&faces, &in.mesh, &in.rays, &in.camera, err);
    if (!st && r->reveal) st = write_reveal(&faces, &in, r, prov, err);
    if (!st && r->out) st = add_clutter(&faces, &in, r, prov, err);
    if (!st && r->out) st = view_records_write(&faces, &in.mesh, &in.camera, in.axes.scale, r->out, prov, err);
    view_faces_release(&faces);
    release_inputs(&in);
    return st;
}

static enum status make_index(const struct request *r, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    enum status st = camera_set_read(&set, r->views, err);
    const char **names = malloc(((size_t)set.view_count + 1) * sizeof *names);
    if (!st && !names) st = err_nomem(err, "views", (size_t)set.view_count * sizeof *names);
    for (int i = 0; !st && i < set.view_count; i++) names[i] = set.views[i].name;
    if (!st) st = face_index_write(r->ids, names, set.view_count, r->index, prov, err);
    free(names);
    camera_set_release(&set);
    return st;
}

static enum status check_request(const struct request *r, struct err *err)
{
    if (r->index)
        return r->ids ? ST_OK : err_set(err, ST_USAGE, "--index wants --ids, the folder of the views' lists.");
    if (!r->view || !r->model || !r->axes || (!r->out && !r->reveal))
        return err_set(err, ST_USAGE, "give --view, --model, --axes and --out or --reveal; or else --index.");
    if (r->out && !r->depth) return err_set(err, ST_USAGE, "--out wants --depth, the folder of the views' depth.");
    return ST_OK;
}

int main(int argc, char **argv)
{
    struct request r = {0};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Finds the face of the model that each pixel of a view shows, and what stands in front of it."),
        CLI_STR("views", &r.views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("model", &r.model, CLI_OPTIONAL, "the unedited model, model.txt"),
        CLI_LIST("edit", &r.edits, CLI_OPTIONAL, "model.txt of an edit; repeat for several; for --reveal"),
        CLI_STR("axes", &r.axes, CLI_OPTIONAL, "the models' frame, axes.txt"),
        CLI_STR("depth", &r.depth, CLI_OPTIONAL, "folder of the views' depth"),
        CLI_STR("view", &r.view, CLI_OPTIONAL, "view to work on"),
        CLI_STR("out", &r.out, CLI_OPTIONAL, "EXR of the view's faces to write, with a list beside it"),
        CLI_STR("reveal", &r.reveal, CLI_OPTIONAL,
                "EXR to write of the faces that the edits reveal; kept if nothing changed"),
        CLI_STR("ids", &r.ids, CLI_OPTIONAL, "with --index: folder of the views' lists"),
        CLI_STR("index", &r.index, CLI_OPTIONAL,
                "index of the views that show each face to write, in place of a view's faces"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "trace_ids", opts, &prov, &err) == CLI_RUN && !check_request(&r, &err)) {
        if (r.index)
            make_index(&r, &prov, &err);
        else
            trace_view(&r, &prov, &err);
    }
    err_report(&err);
    cli_list_release(&r.edits);
    provenance_release(&prov);
    return err_exit_code(&err);
}
