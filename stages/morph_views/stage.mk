# morph_views: a film from one photo to another.
FOLLOWS.morph_views := hdr_merge sfm_import
READS.morph_views := two photos, their cameras and lenses where there are any
LIBS.morph_views := -lopencv_calib3d -lopencv_features2d -lopencv_core
STEPS.morph_views := morph
HELP.morph := the film from one photo of MORPH to the other, along matches (all that a scene of two photos gets)
NEEDS.morph = hdr $(if $(and $(PAIR),$(value REMODEL_SFM)),sfm)

## MORPH="A B": the two photos, by id, that `make morph` goes between; by default those of a scene of two photos

ifndef GRAPH
ifneq ($(MORPH),)
  ifeq ($(shell [[ '$(subst ','\'',$(MORPH))' =~ ^[A-Za-z0-9_][A-Za-z0-9_-]*\ +[A-Za-z0-9_][A-Za-z0-9_-]*\ *$$ ]] && echo good),)
    $(error MORPH=$(MORPH): wanted the ids of two photos, as in MORPH="a b")
  endif
  ifeq ($(firstword $(MORPH)),$(lastword $(MORPH)))
    $(error MORPH=$(MORPH): wanted two photos, found one twice)
  endif
endif
else
# two photos have a morph and nothing else, unless a move was named; poses are used where there are any
MORPH ?= $(if $(filter 2,$(words $(PHOTO_IDS))),$(PHOTO_IDS))
PAIR := $(if $(REMODEL_EFFECT_NAMED),,$(filter 2,$(words $(PHOTO_IDS))))
M := $(P)/morph
MORPH_FRAMES := $(call list_in,$(M)/frames.mk,MORPH_FRAMES)
MORPH_EXR := $(MORPH_FRAMES:%=$(M)/frames/%.exr)
MORPH_TXT := $(M)/path.txt $(addprefix $(M)/path/,cameras.txt images.txt points3D.txt) $(M)/first.exr $(M)/second.exr
.PHONY: morph-path morph-frames morph look-morph
morph-path: $(M)/frames.mk
morph-frames: $(MORPH_EXR)
morph: $(M)/video.mp4
MORPH_POSES := $(if $(wildcard $(O)/views/views.mk),$(VIEW_CAMERAS) $(O)/views/lenses.txt)
$(MORPH_TXT) $(M)/frames.mk &: $(foreach p,$(MORPH),$(call picture,$(p))) $(MORPH_POSES) $(O)/stamp/morph.txt $(call needs,morph_views)
	$(call stage,morph_views,path,$(O),--photos $(PICTURES) --records $(S)/photos --first $(firstword $(MORPH)) --second $(lastword $(MORPH)) \
	  $(if $(MORPH_POSES),--views $(O)/views) --out $(M))
define morph_rule
$(1:%=$(M)/frames/%.exr) &: $(MORPH_TXT) $(call needs,morph_views)
	$$(hide)stale=$$$$(common/run/stale.sh frames $(1:%=$(M)/frames/%.exr) -- $$^); \
	  $$(call farm,morph_views,$(firstword $(1)),$(1:%=$(M)/frames/%.exr),--morph $(M) --out $(M)/frames --frames,$$$$stale)
endef
$(call chunks,morph_rule,$(MORPH_FRAMES))
SHOWN += $(wildcard $(M)/video.mp4)

look-morph:
	+@common/run/keep.sh $(O)/stamp/morph.txt $(if $(MORPH),'$(MORPH)')
look:: look-morph
endif
