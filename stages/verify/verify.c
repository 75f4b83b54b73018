/* verify.c - whether products are whole, so that a cluster run can trust what its jobs left; and whether all files of a
 * scene are still as its runs made them.
 *
 * reads  FILE...   products; their kind in the table of products decides how they are checked (whole_product.h)
 *        with --list: the table of products
 *        with --scene S: the ledger of the scene (ledger_file.h), and all files that it names below S and below O
 * writes nothing; exit 1 with a sentence about the first file that is missing or not whole. A file that is no
 *        product only has to have a byte. With --scene a sentence about each file that was changed.
 *        With --gather: the ledger, of what the processes of a run wrote down (ledger_gather.h). */
#include "common/base/cli.h"
#include "common/product/product.h"
#include "stages/verify/check_scene.h"
#include "stages/verify/ledger_gather.h"
#include "stages/verify/whole_product.h"

/* The table of products and what its placeholders stand for, for the documents: fields with tabs between them. */
static enum status list_products(struct err *err)
{
    static const struct {
        const char *name, *forms, *meaning;
    } keys[] = {
#define PRODUCT_KEY(field, type, name, forms, meaning) {name, forms, meaning},
#include "common/product/product_keys.def"
#undef PRODUCT_KEY
    };
    static const char *const formats[] = {
#define PRODUCT_FORMAT(id, name) name,
#include "common/product/product_formats.def"
#undef PRODUCT_FORMAT
    };
    char pattern[FILE_PATH];
    for (enum product_id id = 0; id < PRODUCT_COUNT; id++) {
        const struct product *p = &products[id];
        if (product_pattern(pattern, id, err)) return err->status;
        printf("product\t%s/%s\t%s\t%s\t%s\t%s\n", p->root == PRODUCT_SHARED ? "S" : "O", pattern, formats[p->format],
               p->head ? p->head : "", p->stages, p->meaning);
    }
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        printf("key\t%s\t%s\t%s\n", keys[i].name, keys[i].forms, keys[i].meaning);
    return ST_OK;
}

int main(int argc, char **argv)
{
    struct cli_list files = {0}, given = {0}, photos = {0};
    const char *scene = NULL, *own = NULL;
    bool list = false, gather = false;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Checks that products are whole: pictures decode, videos have their index, texts have their end."),
        CLI_LIST("file", &files, CLI_OPTIONAL, "product to check; may be given several times"),
        CLI_FLAG("list", &list, "print the table of all products instead"),
        CLI_STR("scene", &scene, CLI_OPTIONAL, "folder out/SCENE: check all its files against its ledger"),
        CLI_STR("run", &own, CLI_OPTIONAL, "folder of the run whose products are checked as well (that of --scene)"),
        CLI_FLAG("gather", &gather, "put the ledger of --scene together instead, at the end of a run"),
        CLI_LIST("given", &given, CLI_OPTIONAL, "with --gather: file or folder that people gave; several times"),
        CLI_LIST("photos", &photos, CLI_OPTIONAL, "with --gather: folder of photos, or a clip; several times"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    enum cli_verdict verdict = cli_parse(argc, argv, "verify", opts, &prov, &err);

    if (verdict == CLI_RUN && list)
        list_products(&err);
    else if (verdict == CLI_RUN && gather && !scene)
        err_set(&err, ST_USAGE, "--gather needs --scene; see --help.");
    else if (verdict == CLI_RUN && gather)
        ledger_gather(&(struct ledger_gather_in){.shared = scene, .given = &given, .photos = &photos}, &err);
    else if (verdict == CLI_RUN && scene)
        scene_check(scene, own ? own : scene, &err);
    else if (verdict == CLI_RUN && !files.count)
        err_set(&err, ST_USAGE, "--file or --scene is missing; see --help.");
    for (int i = 0; verdict == CLI_RUN && !err.status && i < files.count; i++) product_verify(files.items[i], &err);
    err_report(&err);
    cli_list_release(&files);
    cli_list_release(&given);
    cli_list_release(&photos);
    provenance_release(&prov);
    return err_exit_code(&err);
}
