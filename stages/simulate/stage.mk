# simulate: photographs of a described scene, and what is true of them.
FOLLOWS.simulate :=
READS.simulate := a described scene (scenes/NAME/scene.txt, cameras.txt; docs/scenes.md)
WRITES.simulate := simulated/photos, lri, truth
SHARED.simulate := yes
LIBS.simulate := -lembree3
STEPS.simulate := edited
HELP.edited := radiance of the edited scene EDIT of a described scene, from the same cameras

## EDIT=E: the edited scene scenes/SCENE/scene-E.txt, for `make edited`

ifndef GRAPH
ifneq ($(and $(SCENE),$(EDIT)),)
  ifeq ($(wildcard scenes/$(SCENE)/scene-$(EDIT).txt),)
    $(error EDIT=$(EDIT): there is no scenes/$(SCENE)/scene-$(EDIT).txt)
  endif
endif
else
# A described scene is photographed first. photos.mk lists its SHOTS, and in SHOT_NAME the files of each.
SIM := $(S)/simulated
DESCRIBED := $(wildcard scenes/$(SCENE)/scene.txt)
$(if $(DESCRIBED),$(eval $(file <$(SIM)/photos.mk)))
SHOOT := $(if $(DESCRIBED),scenes/$(SCENE)/cameras.txt $(wildcard scenes/$(SCENE)/*.obj)) $(call shared_needs,simulate)
DESCRIPTION := $(DESCRIBED) $(SHOOT)
$(SIM)/photos.mk: $(DESCRIPTION)
	$(call stage,simulate,common,$(S),--scene scenes/$(SCENE) --out $(SIM) --common)
define shot_rules
$(SHOT_$(1):%=$(SIM)/%) &: $(DESCRIPTION)
	$$(hide)$$(call farm,simulate,$(1),$(SHOT_$(1):%=$(SIM)/%),--scene scenes/$(SCENE) --out $(SIM) --photo $(1),,$(S))
endef
$(foreach s,$(SHOTS),$(eval $(call shot_rules,$(s))))
.PHONY: simulated edited look-simulate
simulated: $(foreach s,$(SHOTS),$(SHOT_$(s):%=$(SIM)/%))

EDITED := $(SIM)/truth/edited-$(EDIT)
EDITED_TXT := $(EDITED)/scene.txt $(EDITED)/faces.txt
$(EDITED_TXT) &: scenes/$(SCENE)/scene-$(EDIT).txt $(SHOOT)
	$(call stage,simulate,edited-$(EDIT),$(S),--scene scenes/$(SCENE) --out $(SIM) --common --edit $(EDIT))
$(EDITED)/hdr/%.exr: scenes/$(SCENE)/scene-$(EDIT).txt $(SHOOT)
	$(hide)$(call farm,simulate,$*,$@,--scene scenes/$(SCENE) --out $(SIM) --photo $* --edit $(EDIT),,$(S))
edited: $(EDITED_TXT) $(patsubst truth/%,$(EDITED)/%,$(foreach s,$(SHOTS),$(filter truth/hdr/%,$(SHOT_$(s)))))

look-simulate:
	+@common/run/look.sh slices $(BIN) $(S)/slice simulate $(SHARED_CONFIGS)
endif
