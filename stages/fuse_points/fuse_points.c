/* fuse_points.c - oriented points on which the depth maps of several views agree.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the cameras
 *         DEPTH/VIEW.exr, VIEW.txt                      all views' interior layers and segments
 * writes  OUT                                           binary PLY: position, normal, colour, views, confidence
 *
 * Holds one view's layer, as many of the other views' segment maps as fit into --memory, and the points. */
#include <inttypes.h>
#include <stdio.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/product/product.h"
#include "stages/fuse_points/fuse.h"

enum { DEFAULT_MIB = 1024 };

struct depth_folder {
    const char *folder;
    const struct camera_set *set;
    struct provenance *prov;
};

static enum status find_depth(const struct depth_folder *f, int view_idx, char path[FILE_PATH], struct err *err)
{
    const struct product_key key = {.view = f->set->views[view_idx].name};
    return product_path_in(path, f->folder, PRODUCT_DEPTH, &key, err);
}

static enum status read_ids(void *ctx, int view_idx, struct layered_depth *d, struct err *err)
{
    const struct depth_folder *f = ctx;
    char path[FILE_PATH];
    return find_depth(f, view_idx, path, err) ? err->status : layered_depth_read_ids(d, path, f->prov, err);
}

static enum status read_interior(void *ctx, int view_idx, struct layered_depth *d, struct err *err)
{
    const struct depth_folder *f = ctx;
    char path[FILE_PATH];
    return find_depth(f, view_idx, path, err) ? err->status : layered_depth_read_interior(d, path, f->prov, err);
}

static void log_stats(const struct point_cloud *cloud, const struct fuse_stats *stats)
{
    const double percent = stats->samples ? 100.0 / (double)stats->samples : 0;
    log_note("%zu points on a grid of %.4g (the scene's median depth is %.4g), from %" PRId64 " confident pixels",
             cloud->count, cloud->cell, stats->depth, stats->samples);
    log_note("left out: %.1f %% on which fewer than %d views agree, %.1f %% that other views see through",
             percent * (double)stats->unsupported, stats->views, percent * (double)stats->seen_through);
}

static enum status fuse(const char *views, const char *depth, const char *out, int mib,
                        const struct fuse_params *params, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct point_cloud cloud = {0};
    struct fuse_stats stats;
    if (mib < 0) return err_set(err, ST_USAGE, "--memory %d: wanted a number of MiB, 0 or more.", mib);
    camera_set_read(&set, views, prov, err);
    if (!err->status) {
        struct depth_folder folder = {depth, &set, prov};
        const struct depth_reader source = {read_ids, read_interior, &folder};
        fuse_points(&cloud, &stats, &set, &source, params, (size_t)mib << 20, err);
    }
    if (!err->status && !point_cloud_write(&cloud, out, prov, err)) log_stats(&cloud, &stats);
    point_cloud_release(&cloud);
    camera_set_release(&set);
    return err->status;
}

int main(int argc, char **argv)
{
    const char *views = NULL, *depth = NULL, *out = NULL;
    int mib = DEFAULT_MIB;
    struct fuse_params params = FUSE_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Oriented points on which the depth maps of several views agree."),
        CLI_STR("views", &views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("depth", &depth, CLI_REQUIRED, "folder of the views' depth"),
        CLI_STR("out", &out, CLI_REQUIRED, "PLY to write"),
        CLI_INT("memory", &mib, CLI_OPTIONAL,
                "MiB for the cache of segment maps (1024); changes the time, not the points"),
        CLI_PARAMS(fuse_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "fuse_points", opts, &prov, &err) != CLI_RUN ||
        fuse(views, depth, out, mib, &params, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
