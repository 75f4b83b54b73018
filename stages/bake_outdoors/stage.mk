# bake_outdoors: what lies outside of the model, by direction.
FOLLOWS.bake_outdoors := rectify trace_ids hdr_merge
READS.bake_outdoors := the model, axes.txt, the views that look out of it and their ids, lighting reference images that `make lri` made
LIBS.bake_outdoors := -lembree3
STEPS.bake_outdoors := outdoors
HELP.outdoors := + what lies outside of the model's openings, by direction, from lighting reference images and photos
NEEDS.outdoors := ids

ifdef GRAPH
OUTDOORS := $(if $(MODEL_SCRIPT),$(O)/outdoors/outdoors.exr)
# reference images are used if they are there: no scene must have any
OUTDOORS_LRI := $(filter $(LRI_IDS:%=$(S)/lri/%.exr),$(wildcard $(S)/lri/*.exr))
.PHONY: outdoors
outdoors: $(OUTDOORS)
# an image that went is a change whatever the times of the others
$(O)/stamp/outdoors.txt: FORCE
	+@mkdir -p $(@D); echo '$(OUTDOORS_LRI)' | cmp -s - $@ || echo '$(OUTDOORS_LRI)' >$@
$(OUTDOORS): $(O)/model/model.txt $(AXES) $(VIEW_CAMERAS) $(O)/views/lenses.txt $(VIEW_EXR) $(IDS_EXR) $(OUTDOORS_LRI) $(O)/stamp/outdoors.txt $(call needs,bake_outdoors)
	$(call stage,bake_outdoors,all,$(O),--model $(O)/model/model.txt --axes $(AXES) --views $(O)/views --ids $(O)/ids $(OUTDOORS_LRI:%=--reference %) --out $@)
endif
