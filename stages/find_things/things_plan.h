/* things_plan.h - the things of a scene on the plan of its model. */
#ifndef REMODEL_THINGS_PLAN_H
#define REMODEL_THINGS_PLAN_H

#include "common/model/model_plan.h"
#include "common/model/thing_list.h"

/* SVG: the plan, and the box around each thing with its name; dashed: it hangs on a wall or from the ceiling. */
enum status things_plan_write(const struct thing_list *list, const struct model_plan *plan, const char *path,
                              struct err *err);

#endif
