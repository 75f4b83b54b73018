/* scratch_page.h - the page of the products in the scratch folder. */
#ifndef REMODEL_TESTS_SCRATCH_PAGE_H
#define REMODEL_TESTS_SCRATCH_PAGE_H

#include <stdio.h>

#include "stages/report/contents.h"
#include "stages/report/page.h"
#include "tests/unit/scratch.h"

/* stages: names of the stages in data-flow order. The caller frees the text. */
static inline char *scratch_page(const char *scene, const char *stages)
{
    const struct contents_sources from = {scratch, scratch, scratch, stages, NULL};
    struct contents c = {0};
    struct err err = ERR_INIT;
    char *text = NULL;
    size_t size;
    FILE *to = open_memstream(&text, &size);
    assert_ok(contents_read(&c, &from, &err), err);
    assert_ok(page_write(to, scene, &c, &err), err);
    fclose(to);
    contents_release(&c);
    return text;
}

#endif
