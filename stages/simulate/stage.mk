# simulate: photographs of a described scene, and what is true of them.
FOLLOWS.simulate :=
READS.simulate := a described scene (scenes/NAME/scene.txt, cameras.txt; docs/scenes.md)
SHARED.simulate := yes
LIBS.simulate := -lembree3
STEPS.simulate := truth edited
HELP.truth := more truth of a described scene: its witnesses, its rooms without furniture, IRRADIANCE_VIEWS
HELP.edited := truth of the edited scenes EDITS of a described scene, from the same cameras or EDIT_VIEWS

## EDITS="A B"|all: the edited scenes scenes/SCENE/scene-A.txt and so on, for `make edited`; EDIT=A is the same for one
## EDIT_VIEWS="N M": the photos and witnesses to render them from; default: all
## IRRADIANCE_VIEWS="N M": photos and witnesses that get pictures of irradiance, for `make truth` and `make edited`

EDIT_NAMES := $(sort $(EDIT) $(if $(filter all,$(EDITS)),$(patsubst scenes/$(SCENE)/scene-%.txt,%,$(wildcard \
  scenes/$(SCENE)/scene-*.txt)),$(EDITS)))
ifndef GRAPH
ifneq ($(and $(SCENE),$(filter edited,$(MAKECMDGOALS))),)
  $(foreach e,$(EDIT_NAMES),$(if $(wildcard scenes/$(SCENE)/scene-$(e).txt),,$(error EDITS: there is no scenes/$(SCENE)/scene-$(e).txt)))
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
.PHONY: simulated look-simulate
simulated: $(foreach s,$(SHOTS),$(SHOT_$(s):%=$(SIM)/%))

# the truth of a camera: $(1) the folder under truth/, $(2) the camera, $(3) more options, $(4) what it needs
TRUTH_KINDS := hdr depth ids
true_files = $(foreach v,$(2),$(TRUTH_KINDS:%=$(SIM)/truth/$(1)/%/$(v).exr))
unknown_views := $(if $(SHOTS),$(filter-out $(TRUE_VIEWS),$(EDIT_VIEWS) $(IRRADIANCE_VIEWS)))
$(if $(unknown_views),$(error EDIT_VIEWS, IRRADIANCE_VIEWS: $(unknown_views): scenes/$(SCENE)/cameras.txt has no such photo or witness))
define view_rules
$(TRUTH_KINDS:%=$(SIM)/truth/$(1)/%/$(2).exr) &: $(4)
	$$(hide)$$(call farm,simulate,$(subst /,-,$(1))-$(2),$$(call true_files,$(1),$(2)),--scene scenes/$(SCENE) --out $(SIM) --photo $(2) $(3),,$(S))
endef
define irradiance_rules
$(SIM)/truth/$(if $(3),$(3)/)irradiance/$(1).exr: $(4)
	$$(hide)$$(call farm,simulate,$(if $(3),$(3)-)irradiance-$(1),$$@,--scene scenes/$(SCENE) --out $(SIM) --photo $(1) --kind irradiance $(2),,$(S))
endef
$(foreach v,$(WITNESSES),$(eval $(call view_rules,novel,$(v),,$(DESCRIPTION))))
$(foreach v,$(TRUE_VIEWS),$(eval $(call view_rules,shell,$(v),--kind shell,$(DESCRIPTION))))
$(foreach v,$(IRRADIANCE_VIEWS),$(eval $(call irradiance_rules,$(v),,,$(DESCRIPTION))))
.PHONY: truth edited edited-texts
truth: $(call true_files,novel,$(WITNESSES)) $(call true_files,shell,$(TRUE_VIEWS)) $(IRRADIANCE_VIEWS:%=$(SIM)/truth/irradiance/%.exr)

EDITED_VIEWS := $(or $(EDIT_VIEWS),$(TRUE_VIEWS))
edited_texts = $(SIM)/truth/edited-$(1)/scene.txt $(SIM)/truth/edited-$(1)/faces.txt $(SIM)/truth/edited-$(1)/images.txt
edited_needs = scenes/$(SCENE)/scene-$(1).txt $(DESCRIPTION)
define edit_rules
$(edited_texts) &: $(edited_needs)
	$$(call stage,simulate,edited-$(1),$(S),--scene scenes/$(SCENE) --out $(SIM) --common --edit $(1))
$(foreach v,$(EDITED_VIEWS),$(eval $(call view_rules,edited-$(1),$(v),--edit $(1),$(edited_needs))))
$(foreach v,$(IRRADIANCE_VIEWS),$(eval $(call irradiance_rules,$(v),--edit $(1),edited-$(1),$(edited_needs))))
endef
$(foreach e,$(EDIT_NAMES),$(eval $(call edit_rules,$(e))))
edited-texts: $(foreach e,$(EDIT_NAMES),$(call edited_texts,$(e)))
edited: edited-texts $(foreach e,$(EDIT_NAMES),$(call true_files,edited-$(e),$(EDITED_VIEWS)) $(IRRADIANCE_VIEWS:%=$(SIM)/truth/edited-$(e)/irradiance/%.exr))

look-simulate:
	+@common/run/look.sh slices $(BIN) $(S)/slice simulate $(SHARED_CONFIGS)
endif
