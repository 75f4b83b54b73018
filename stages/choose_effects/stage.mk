# choose_effects: which effects suit a scene, for EFFECT=auto and EFFECT=all.
FOLLOWS.choose_effects := find_subjects
READS.choose_effects := subjects.txt; only for EFFECT=auto and all
VARIABLES.choose_effects := EFFECT EFFECT_NAMED
STEPS.choose_effects := choice
NEEDS.choice := depth film_views

## EFFECT="NAMES": films to make, by name, like dolly_in or dolly_in+narrow_dof (docs/formats.md); establishing_dolly by default
## EFFECT=auto|all: one drawn at random from those that suit the scene, or all of them; two photos get their morph
## EFFECT=FILM: the film of keys scenes/SCENE/keyframes/FILM.txt

ifndef GRAPH
ifneq ($(SCENE),)
  EFFECT_NAMED := $(if $(filter undefined,$(origin EFFECT)),,$(filter-out auto all,$(EFFECT)))
  EFFECT ?= establishing_dolly
  ifeq ($(shell [[ '$(subst ','\'',$(EFFECT))' =~ ^[A-Za-z0-9_+\ -]+$$ ]] && echo good),)
    $(error EFFECT=$(EFFECT): effects are named with letters, digits, _, - and +)
  endif
endif
else
.PHONY: choice
choice: $(if $(CHOOSE),$(P)/$(CHOOSE)-effects.mk)
$(P)/%-effects.mk: $(SUBJECTS) $(call needs,choose_effects)
	$(call stage,choose_effects,$(CHOOSE),$(O),--subjects $(SUBJECTS) --effect $(CHOOSE) --out $@)
endif
