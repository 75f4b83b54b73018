/* scratch_page.h - the pages of the products in the scratch folder. Their pictures go into the folder `page` there. */
#ifndef REMODEL_TESTS_SCRATCH_PAGE_H
#define REMODEL_TESTS_SCRATCH_PAGE_H

#include <stdio.h>

#include "common/base/outfile.h"
#include "stages/report/contents.h"
#include "stages/report/page.h"
#include "tests/unit/scratch.h"

/* A page that is written to *text, which the caller frees after scratch_page_end(). folder: has room for a path.
 * address: of the folder of pictures from the page; scene: of the scene. */
static inline void scratch_page_begin(struct page *page, char **text, size_t *size, char folder[PATH_MAX],
                                      const char *address, const char *scene)
{
    struct err err = ERR_INIT;
    snprintf(folder, PATH_MAX, "%s", scratch_path("page"));
    assert_ok(outfile_make_folders(folder, &err), err);
    *page = (struct page){.to = open_memstream(text, size),
                          .parts = "stages/report/page",
                          .folder = folder,
                          .address = address,
                          .scene = scene};
}

static inline void scratch_page_end(struct page *page)
{
    fclose(page->to);
    name_list_release(&page->pictures);
}

/* The page for people, or that of numbers. The caller frees the text. */
static inline char *scratch_page_of(const struct contents_sources *from, const char *scene, bool numbers)
{
    struct contents c = {0};
    struct page page;
    struct err err = ERR_INIT;
    static char *text; /* of the stream, which ends below */
    static size_t size;
    char folder[PATH_MAX];
    scratch_page_begin(&page, &text, &size, folder, numbers ? "" : "page/", numbers ? "../" : "");
    assert_ok(contents_read(&c, from, &err), err);
    if (numbers)
        assert_ok(page_write_numbers(&page, scene, "../index.html", &c, &err), err);
    else
        assert_ok(page_write(&page, scene, "page/numbers.html", &c, &err), err);
    scratch_page_end(&page);
    contents_release(&c);
    contents_release(&c);
    return text;
}

/* The page of numbers. stages: names of the stages in data-flow order. The caller frees the text. */
static inline char *scratch_page(const char *scene, const char *stages)
{
    const struct contents_sources from = {.folder = scratch, .shared = scratch, .photos = scratch, .stages = stages};
    return scratch_page_of(&from, scene, true);
}

#endif
