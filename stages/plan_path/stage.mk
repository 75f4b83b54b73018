# plan_path: a camera move, or a film of keys.
FOLLOWS.plan_path := sample_validity
READS.plan_path := validity.txt, parallax/views.txt, cameras, all layers, subjects.txt; or keyframes/FILM.txt and the moves that it chains
LIBS.plan_path := -ljansson
STEPS.plan_path := path
HELP.path := + the camera move
NEEDS.path = depth film_views $(if $(CHOOSE),choice)

ifdef GRAPH
# the films of this run (EFFECTS), and FRAMES_film of each
EFFECTS ?= $(sort $(EFFECT))
$(foreach e,$(EFFECTS),$(eval FRAMES_$(e) := $(call list_in,$(P)/$(e)/frames.mk,FRAMES)))
keyframes = $(wildcard scenes/$(SCENE)/keyframes/$(1).txt)
FILMS := $(foreach e,$(EFFECTS),$(if $(call keyframes,$(e)),$(e))) # films of keys among them
path_txt = $(P)/$(1)/path.txt $(addprefix $(P)/$(1)/path/,cameras.txt images.txt points3D.txt)
path_all = $(call path_txt,$(1)) $(addprefix $(P)/$(1)/,effects.txt transforms.json blender.py frames.mk)
.PHONY: path
path: $(foreach e,$(EFFECTS),$(call path_all,$(e)) $(if $(filter $(e),$(FILMS)),,$(call validity,$(e))))
# $(1): a planned effect
define path_rule
$(call path_all,$(1)) &: $(VIEW_CAMERAS) $(call validity,$(1)) $(DEPTH_EXR) $(DEPTH_TXT) $(call needs_subjects,$(1)) $(FILM_VIEWS) \
  $(call needs,plan_path) | $(FILM_VIEWS_STAMP)
	$$(call stage,plan_path,$(1),$(O),--views $(O)/views --film-views $(FILM_VIEWS) --depth $(O)/depth --validity $(firstword $(call validity,$(1))) \
	  --effect $(1) $(addprefix --subjects ,$(call needs_subjects,$(1))) --out $(P)/$(1))
endef
# a film of keys: its effect is its name; the moves that it chains are planned first
chained = $(sort $(shell awk '$$1 == "move" && $$2 ~ /^[A-Za-z0-9_+-]+$$/ { print $$2 }' $(call keyframes,$(1))))
define film_rule
$(call path_all,$(1)) &: $(call keyframes,$(1)) $(foreach m,$(CHAINED_$(1)),$(P)/$(m)/path.txt $(P)/$(m)/effects.txt) \
  $(VIEW_CAMERAS) $(O)/views/lenses.txt $(call needs,plan_path)
	$$(call stage,plan_path,$(1),$(O),--views $(O)/views --records $(S)/photos --keyframes $(call keyframes,$(1)) \
	  --moves $(P) --effect $(1) --out $(P)/$(1))
endef
$(foreach f,$(FILMS),$(eval CHAINED_$(f) := $(call chained,$(f))))
$(foreach f,$(FILMS),$(foreach e,$(CHAINED_$(f)),$(if $(call keyframes,$(e)),\
  $(error $(call keyframes,$(f)) chains $(e), a film of keys: only planned moves can be chained))))
PLANNED := $(sort $(filter-out $(FILMS),$(EFFECTS)) $(foreach f,$(FILMS),$(CHAINED_$(f))))
$(foreach m,$(sort $(foreach e,$(PLANNED),$(call move_of,$(e)))),$(eval $(call validity_rule,$(m))))
$(foreach e,$(PLANNED),$(eval $(call path_rule,$(e))))
$(foreach f,$(FILMS),$(eval $(call film_rule,$(f))))
SHOWN += $(EFFECTS:%=$(P)/%/path.txt)
endif
