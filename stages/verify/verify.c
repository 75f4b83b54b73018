/* verify.c - whether products are whole, so that a cluster run can trust what its jobs left.
 *
 * reads  FILE...   products; their kind in the table of products decides how they are checked (whole_product.h)
 *        with --list: the table of products
 * writes nothing; exit 1 with a sentence about the first file that is missing or not whole. A file that is no
 *        product only has to have a byte. */
#include "common/base/cli.h"
#include "common/product/product.h"
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
    struct cli_list files = {0};
    bool list = false;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Checks that products are whole: pictures decode, videos have their index, texts have their end."),
        CLI_LIST("file", &files, CLI_OPTIONAL, "product to check; may be given several times"),
        CLI_FLAG("list", &list, "print the table of all products instead"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    enum cli_verdict verdict = cli_parse(argc, argv, "verify", opts, &prov, &err);

    if (verdict == CLI_RUN && list)
        list_products(&err);
    else if (verdict == CLI_RUN && !files.count)
        err_set(&err, ST_USAGE, "--file is missing; see --help.");
    for (int i = 0; verdict == CLI_RUN && !err.status && i < files.count; i++) product_verify(files.items[i], &err);
    err_report(&err);
    cli_list_release(&files);
    provenance_release(&prov);
    return err_exit_code(&err);
}
