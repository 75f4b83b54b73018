/* verify.c - whether products are whole, so that a cluster run can trust what its jobs left.
 *
 * reads  FILE...   products; their extensions decide how they are checked, as product.h lists
 * writes nothing; exit 1 with a sentence about the first file that is missing or not whole. A file with an extension
 *        that product.h does not list only has to have a byte. */
#include "common/base/cli.h"
#include "stages/verify/product.h"

int main(int argc, char **argv)
{
    struct cli_list files = {0};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Checks that products are whole: pictures decode, videos have their index, texts have their end."),
        CLI_LIST("file", &files, CLI_REQUIRED, "product to check; may be given several times"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    enum cli_verdict verdict = cli_parse(argc, argv, "verify", opts, &prov, &err);

    for (int i = 0; verdict == CLI_RUN && !err.status && i < files.count; i++) product_verify(files.items[i], &err);
    err_report(&err);
    cli_list_release(&files);
    provenance_release(&prov);
    return err_exit_code(&err);
}
