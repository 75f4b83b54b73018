# plan_tour: walks through the rooms of the model and of each edit.
FOLLOWS.plan_tour := build_model
READS.plan_tour := a model, its plan and axes, cameras, scenes/NAME/tour.txt
LIBS.plan_tour := -lembree3
STEPS.plan_tour := tour-path
NEEDS.tour-path := model

ifdef GRAPH
TOUR_MODELS := $(MODELS)
TOUR_SCRIPT := $(wildcard scenes/$(SCENE)/tour.txt)
tour_files = $(addprefix $(1)/tour/,path.txt pairs.txt plan.svg path/cameras.txt path/images.txt path/points3D.txt)
.PHONY: tour-path
tour-path: $(foreach m,$(TOUR_MODELS),$(call tour_files,$(m)))
define tour_path_rule
$(call tour_files,$(1)) &: $(1)/model.txt $(1)/plan.txt $(AXES) $(VIEW_CAMERAS) $(O)/views/lenses.txt $(TOUR_SCRIPT) $(call needs,plan_tour)
	$$(call stage,plan_tour,$(notdir $(1)),$(O),--model $(1) --axes $(AXES) --views $(O)/views $(TOUR_SCRIPT:%=--script %) --out $(1)/tour)
endef
$(foreach m,$(TOUR_MODELS),$(eval $(call tour_path_rule,$(m))))
endif
