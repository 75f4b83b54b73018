/* ledger_gather.h - puts together what the processes of a run wrote down, at its end. */
#ifndef REMODEL_LEDGER_GATHER_H
#define REMODEL_LEDGER_GATHER_H

#include "common/base/cli.h"
#include "common/base/err.h"

struct ledger_gather_in {
    const char *shared;            /* S: the ledger is S/log/ledger.txt, products are below S and S+... */
    const struct cli_list *given;  /* folders and files that people gave: scenes/NAME, ... */
    const struct cli_list *photos; /* the folder of photos, or clips */
};

/* Reads S/log/ledger.txt and the lines of S/log/ledger, and writes the first anew. Of two hashes of a product the
 * newer one counts; where the product has the older one's bytes, since a process was killed before it replaced them,
 * the older one. Products that are gone are forgotten: a run may remove what is not wanted any more. With given
 * files, these are hashed; photos have the hashes that import_photos recorded when it read them. ST_DATA: the ledger
 * was changed. */
enum status ledger_gather(const struct ledger_gather_in *in, struct err *err);

#endif
