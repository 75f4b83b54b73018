# build_model: solid models of rooms, by a script and its edits.
FOLLOWS.build_model := find_axes suggest_model
READS.build_model := scenes/NAME/model.txt, edits/E.txt, objects.txt and the meshes of objects, axes.txt, cameras, points.ply; the photos for overlays
STEPS.build_model := model
HELP.model := the solid model of scenes/SCENE/model.txt and of each edit in edits/, with pictures to check them
NEEDS.model := depth
PRODUCT.model := model

ifdef GRAPH
# the model of model.txt, and one of each edit
model_files = $(addprefix $(1)/,model.txt model.obj plan.txt merged.txt plan.svg view.png)
MODEL_SCRIPT := $(wildcard scenes/$(SCENE)/model.txt)
edit_files = $(call model_files,$(1)) $(1)/texture.txt $(1)/objects.txt
MODEL_EDITS := $(if $(MODEL_SCRIPT),$(patsubst scenes/$(SCENE)/edits/%.txt,%,$(wildcard scenes/$(SCENE)/edits/*.txt)))
# those that are drawn and relit
DRAWN_EDITS := $(if $(EDIT),$(filter $(EDIT),$(MODEL_EDITS)),$(if $(DRAW),$(filter $(DRAW),$(MODEL_EDITS)),$(MODEL_EDITS)))
MODELS := $(if $(MODEL_SCRIPT),$(O)/model $(MODEL_EDITS:%=$(O)/remodel/%))
# edges drawn on photos, of the unedited model and of the edits that are drawn
OVERLAYS := $(foreach m,$(if $(MODEL_SCRIPT),$(O)/model $(DRAWN_EDITS:%=$(O)/remodel/%)),$(VIEWED:%=$(m)/overlay/%.jpg))
.PHONY: model overlays
model: $(foreach m,$(MODELS),$(call model_files,$(m))) $(MODEL_EDITS:%=$(O)/remodel/%/texture.txt) $(MODEL_EDITS:%=$(O)/remodel/%/objects.txt)
overlays: $(OVERLAYS)
# a script that places nothing in photographs needs no points
MODEL_POINTS := $(if $(MODEL_SCRIPT),$(if $(shell grep -lE '^[ \t]*(wall|adjust)[ \t]+[^ \t]+[ \t]+in[ \t]' \
  $(MODEL_SCRIPT) $(MODEL_EDITS:%=scenes/$(SCENE)/edits/%.txt)),$(POINTS)))
MODEL_NEEDS := $(AXES) $(VIEW_CAMERAS) $(O)/views/lenses.txt $(HELD_CAMERAS) $(MODEL_POINTS) $(call needs,build_model)
MODEL_ARGS := --axes $(AXES) --views $(O)/views $(if $(HELD_CAMERAS),--held $(H)/views) $(MODEL_POINTS:%=--points %)
$(call model_files,$(O)/model) &: $(MODEL_SCRIPT) $(MODEL_NEEDS)
	$(call stage,build_model,model,$(O),--script $(MODEL_SCRIPT) $(MODEL_ARGS) --out $(O)/model)
# an edit's script, and those that it stands on
edit_scripts = $(wildcard scenes/$(SCENE)/edits/$(1).txt) $(foreach b,$(filter-out $(2) $(1),$(shell sed -nE 's/^[ \t]*base[ \t]+([A-Za-z0-9_-]+).*/\1/p' \
  scenes/$(SCENE)/edits/$(1).txt 2>/dev/null)),$(call edit_scripts,$(b),$(2) $(1)))
# the objects of all edits, and the meshes that these files name; FORCE, for build_model to say that one is missing
SCENE_OBJECTS := $(wildcard scenes/$(SCENE)/objects.txt)
# a file that went is a change whatever the times of the others
$(O)/stamp/objects.txt: FORCE
	+@common/run/keep.sh $@ '$(or $(SCENE_OBJECTS),none)'
edit_meshes = $(foreach m,$(sort $(if $(1),$(shell sed -nE 's/^[ \t]*object[ \t]+[^ \t]+[ \t]+([A-Za-z0-9_.\/-]+\.obj)[ \t].*/\1/p' \
  $(1)))),$(or $(wildcard scenes/$(SCENE)/$(m)),FORCE))
edit_objects = $(O)/stamp/objects.txt $(SCENE_OBJECTS) $(call edit_meshes,$(SCENE_OBJECTS) $(call edit_scripts,$(1)))
define edit_rule
$(call edit_files,$(O)/remodel/$(1)) &: $(MODEL_SCRIPT) $(call edit_scripts,$(1)) $(call edit_objects,$(1)) $(O)/model/model.txt $(MODEL_NEEDS)
	$$(call stage,build_model,$(1),$(O),--script $(MODEL_SCRIPT) --edit scenes/$(SCENE)/edits/$(1).txt --scene scenes/$(SCENE) \
	  --base $(O)/model/model.txt $(MODEL_ARGS) --out $(O)/remodel/$(1))
endef
$(foreach e,$(MODEL_EDITS),$(eval $(call edit_rule,$(e))))
# $(1): a model's folder; $(2): a photo
define overlay_rule
$(1)/overlay/$(2).jpg: $(1)/model.txt $(AXES) $(VIEW_CAMERAS) $(O)/views/lenses.txt $(call picture,$(2)) $(call needs,build_model)
	$$(hide)$$(call farm,build_model,$(notdir $(1))-$(2),$$@,--overlay $(2) --model $(1)/model.txt --axes $(AXES) \
	  --views $(O)/views --photos $$(PICTURES) --records $(S)/photos --out $$@)
endef
$(foreach m,$(MODELS),$(foreach p,$(VIEWED),$(eval $(call overlay_rule,$(m),$(p)))))
MODELLED := $(filter model textures remodel,$(PRODUCTS))
MEASURED += $(call $(if $(and $(MODELLED),$(MODELS)),made,wildcard),$(AXES) $(if $(MODELS),$(O)/model/plan.txt))
SHOWN_ALWAYS += $(call $(if $(MODELLED),made,wildcard),$(foreach m,$(MODELS),$(call model_files,$(m))) $(OVERLAYS))
endif
