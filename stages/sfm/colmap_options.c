/* colmap_options.c - reads the names of options from COLMAP's help. */
#include "stages/sfm/colmap_options.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "common/base/file_bytes.h"
#include "stages/sfm/colmap_job.h"

static const struct colmap_options versions[] = {
    {"--FeatureMatching.use_gpu", "--FeatureMatching.num_threads"}, /* 3.13 and later */
    {"--SiftMatching.use_gpu", "--SiftMatching.num_threads"},
};

/* Whether the text has the option as a whole word. */
static bool has_option(const char *text, const char *option)
{
    const size_t length = strlen(option);
    for (const char *at = text; (at = strstr(at, option)); at += length)
        if (!isalnum((unsigned char)at[length]) && at[length] != '_') return true;
    return false;
}

bool colmap_options_find(struct colmap_options *o, const char *help)
{
    for (size_t i = 0; i < sizeof versions / sizeof *versions; i++)
        if (has_option(help, versions[i].use_gpu) && has_option(help, versions[i].num_threads)) {
            *o = versions[i];
            return true;
        }
    return false;
}

enum status colmap_options_ask(struct colmap_options *o, const char *log, struct err *err)
{
    const char *args[] = {"matches_importer", "-h", NULL};
    struct file_bytes help = {0};
    int status = 0;
    *o = (struct colmap_options){0};
    remove(log);
    if (!colmap_exit_status(&status, log, args, err) && !file_bytes_read(&help, log, err) &&
        !colmap_options_find(o, help.bytes))
        err_set(err, ST_IO,
                "the help of `colmap matches_importer` names neither %s nor %s; it is in %s. Install a COLMAP between "
                "3.8 and 4.x that runs: `colmap help` says which one is there.",
                versions[1].use_gpu, versions[0].use_gpu, log);
    file_bytes_release(&help);
    return err->status;
}
