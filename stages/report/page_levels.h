/* page_levels.h - the page of light levels: groups of light on the plan with sliders, and pictures of photographs. */
#ifndef REMODEL_PAGE_LEVELS_H
#define REMODEL_PAGE_LEVELS_H

#include "stages/report/page_parts.h"

/* What `make lux` made below a folder, and where the page of the scene is; back NULL: it has none. */
struct levels_sources {
    const char *scene, *folder, *back;
};

/* ST_DATA: nothing was made for the unedited room; what is missing of edits is left out. */
enum status levels_page_write(struct page *page, const struct levels_sources *from, struct err *err);

#endif
