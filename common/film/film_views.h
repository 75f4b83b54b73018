/* film_views.h - the views that a scene's films are made from; out/SCENE/parallax/views.txt, written by choose_views
 * and read by every stage of a film.
 *
 *   remodel-film-views 1
 *   all                  every view of the scene; or
 *   views N              these N, at least one, each named once
 *   view NAME */
#ifndef REMODEL_FILM_VIEWS_H
#define REMODEL_FILM_VIEWS_H

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"

struct film_views {
    bool all; /* names is empty */
    char **names;
    int count;
};

/* ST_DATA with file and line: a malformed line, no view, a view named twice. On failure v is left empty. */
enum status film_views_read(struct film_views *v, const char *path, struct provenance *prov, struct err *err);
void film_views_release(struct film_views *v);

/* Writes the views that are marked in keep[set->view_count], or "all" if keep is NULL. A file with the same text is
 * left alone, so that no film is made again. */
enum status film_views_write(const struct camera_set *set, const bool *keep, const char *path,
                             const struct provenance *prov, struct err *err);

/* Reduces the set to the views of the file, which then becomes an input of prov (parallax/views.txt).
 * With "all", or if path is NULL, set and prov stay as they are: films of scenes without a choice do not depend on it.
 * ST_DATA: the set has no such view. */
enum status film_views_keep(struct camera_set *set, const char *path, struct provenance *prov, struct err *err);

#endif
