# update_vita: the atlas of all faces after an edit, under the light that the edit makes.
FOLLOWS.update_vita := build_model bake_vita bake_outdoors fit_lights gather_irradiance
READS.update_vita := both models, texture.txt and objects.txt, axes.txt, the VITA, outdoors.exr, lights/lights.txt and the reference images that it names
LIBS.update_vita := -lembree3
STEPS.update_vita := relit-vita
NEEDS.relit-vita := vita outdoors

ifdef GRAPH
# $(1): an edit
change_args = --model $(O)/model/model.txt --edited $(O)/remodel/$(1)/model.txt --map $(O)/remodel/$(1)/texture.txt --axes $(AXES) \
  --vita $(O)/vita --outdoors $(OUTDOORS) $(GIVEN_LIGHTS:%=--lights %) $(if $(GATHER_LRI),--references $(S)/lri) \
  --objects $(O)/remodel/$(1)/objects.txt --scene scenes/$(SCENE)
change_needs = $(O)/model/model.txt $(O)/remodel/$(1)/model.txt $(O)/remodel/$(1)/texture.txt $(O)/remodel/$(1)/objects.txt $(AXES) \
  $(VITA_TXT) $(OUTDOORS) $(GIVEN_LIGHTS) $(GATHER_LRI)
RELIT_EDITS := $(if $(MODEL_SCRIPT),$(DRAWN_EDITS))
define relit_vita_rule
$(O)/relight/$(1)/vita/atlas.txt $(O)/relight/$(1)/objects.txt &: $(call change_needs,$(1)) $(call needs,update_vita)
	$$(call stage,update_vita,$(1),$(O),$(call change_args,$(1)) --out $(O)/relight/$(1))
endef
$(foreach e,$(RELIT_EDITS),$(eval $(call relit_vita_rule,$(e))))
.PHONY: relit-vita
relit-vita: $(RELIT_EDITS:%=$(O)/relight/%/vita/atlas.txt)
endif
