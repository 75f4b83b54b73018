/* line_list.h - the straight edges of a view: out/SCENE/lines/VIEW.txt, and the planes that they span with its camera.
 */
#ifndef REMODEL_LINE_LIST_H
#define REMODEL_LINE_LIST_H

#include "common/base/provenance.h"
#include "common/capture/view.h"

struct view_line {
    double u0, v0, u1, v1; /* ends in the view's pixels */
};

struct line_list {
    struct view_line *lines; /* owned */
    int count;
};

enum status line_list_add(struct line_list *list, const struct view_line *line, struct err *err);
/* list is empty after a failure. ST_DATA: a line of length 0. */
enum status line_list_read(struct line_list *list, const char *path, struct provenance *prov, struct err *err);
enum status line_list_write(const struct line_list *list, const char *path, const struct provenance *prov,
                            struct err *err);
void line_list_release(struct line_list *list);

#endif
