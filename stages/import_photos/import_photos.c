/* import_photos.c - checks the photographs of a folder and gives them ids.
 *
 * reads   --photos DIR   *.jpg *.jpeg *.png straight in it; nothing in there is written
 * writes  --out DIR      ID.txt, a record a photo (content hash, size, EXIF); then list.txt; then photos.mk
 *
 * Each file is rewritten only if its text changes, so that Make sees which photos did. A photo that cannot be used is
 * named with the reason, and so are all others like it, before the stage fails. */
#include <sys/stat.h>

#include "common/cli.h"
#include "common/log.h"
#include "stages/import_photos/photo_scan.h"

/* The user's folder is never written to. */
static enum status check_out(const char *photos, const char *out, struct err *err)
{
    struct stat a, b;
    if (stat(photos, &a) || stat(out, &b) || a.st_dev != b.st_dev || a.st_ino != b.st_ino) return ST_OK;
    return err_set(err, ST_USAGE, "--out %s is the folder of photos itself; name another one for the records.", out);
}

static void leave_out(struct photo_scan *scan, const struct cli_list *exclude)
{
    for (int i = 0; i < exclude->count; i++)
        if (!photo_scan_exclude(scan, exclude->items[i]))
            log_warn("no photo in %s is called %s; nothing is left out for it.", scan->folder, exclude->items[i]);
}

static void report_scan(const struct photo_scan *scan)
{
    for (int i = 0; i < scan->count; i++) err_report(&scan->photos[i].err);
    if (scan->ignored) log_note("ignored in %s: %d that are no .jpg, .jpeg or .png file", scan->folder, scan->ignored);
}

int main(int argc, char **argv)
{
    const char *photos = NULL, *out = NULL;
    struct cli_list exclude = {0};
    const struct cli_opt opts[] = {
        CLI_ABOUT("check the photographs of a folder, give them ids, record what they are"),
        CLI_STR("photos", &photos, CLI_REQUIRED, "folder of JPEG and PNG photos; sub-folders are not looked into"),
        CLI_LIST("exclude", &exclude, CLI_OPTIONAL, "photo to leave out: file name, with or without ending, or id"),
        CLI_STR("out", &out, CLI_REQUIRED, "folder of records to write"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct photo_scan scan = {0};
    struct err err = ERR_INIT;

    switch (cli_parse(argc, argv, "import_photos", opts, &prov, &err)) {
    case CLI_RUN:
        if (!check_out(photos, out, &err) && !photo_scan_folder(&scan, photos, &err)) {
            leave_out(&scan, &exclude);
            if (!photo_scan_check(&scan, out, &err)) photo_scan_write(&scan, out, &err);
            report_scan(&scan);
        }
        err_report(&err);
        break;
    case CLI_DONE:
        break;
    case CLI_FAILED:
        err_report(&err);
        break;
    }
    photo_scan_release(&scan);
    cli_list_release(&exclude);
    provenance_release(&prov);
    return err_exit_code(&err);
}
