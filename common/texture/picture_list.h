/* picture_list.h - pictures.txt: the pictures of a folder that were drawn from given cameras, written when all are
 * there.
 *
 *   remodel-pictures 1
 *   picture NAME           for each */
#ifndef REMODEL_PICTURE_LIST_H
#define REMODEL_PICTURE_LIST_H

#include "common/base/provenance.h"

/* {0} is the empty state. */
struct picture_list {
    char **names; /* owned */
    int count;
};

enum status picture_list_add(struct picture_list *l, const char *name, struct err *err);
void picture_list_release(struct picture_list *l);
/* FOLDER/pictures.txt. ST_DATA with file and line. */
enum status picture_list_read(struct picture_list *l, const char *folder, struct provenance *prov, struct err *err);
/* ST_DATA: a name that textfile_quote() refuses. */
enum status picture_list_write(const struct picture_list *l, const char *folder, const struct provenance *prov,
                               struct err *err);

#endif
