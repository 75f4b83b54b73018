# choose_views: the views that films are made from.
FOLLOWS.choose_views := sfm_import
READS.choose_views := cameras, sparse points; scenes/NAME/subjects.txt
STEPS.choose_views := film_views
NEEDS.film_views := sfm

ifdef GRAPH
P := $(O)/parallax
# rectangles that a user drew; a file that came or went is a change whatever its time, so the stamps have two names
DRAWN := $(wildcard scenes/$(SCENE)/subjects.txt)
# The choice is made in a step of its own and written only if it is new, so that films depend on its text and not on the
# files that it is made from: hence the stamp, and the rule without a recipe.
FILM_VIEWS := $(P)/views.txt
FILM_VIEWS_STAMP := $(O)/stamp/film_views$(if $(DRAWN),-drawn).txt
.PHONY: film_views
film_views: $(FILM_VIEWS_STAMP)
$(FILM_VIEWS_STAMP): $(VIEW_CAMERAS) $(O)/views/lenses.txt $(DRAWN) $(call needs,choose_views) \
  $(if $(wildcard $(FILM_VIEWS)),,FORCE)
	$(call stage,choose_views,all,$(O),--views $(O)/views $(DRAWN:%=--subjects %) --out $(FILM_VIEWS))
	+@mkdir -p $(@D); rm -f $(O)/stamp/film_views*.txt; echo done >$@
$(FILM_VIEWS): ;
endif
