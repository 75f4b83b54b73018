# bake_vdta: a texture atlas for each viewpoint.
FOLLOWS.bake_vdta := rectify trace_ids
READS.bake_vdta := the model, axes.txt, one photo's views and those that show what it does not, their ids, what the edits reveal
STEPS.bake_vdta := vdta
HELP.vdta := + texture atlases of the model as each photo sees it
NEEDS.vdta := ids
RUN.vdta := farm

ifdef GRAPH
VIEWPOINTS := $(sort $(foreach v,$(VIEWS),$(call photo_of,$(v))))
VDTA_TXT := $(if $(MODEL_SCRIPT),$(VIEWPOINTS:%=$(O)/vdta/%/atlas.txt))
.PHONY: vdta
vdta: $(VDTA_TXT)
# $(1): a photo; $(2): its views. Which other views it reads is known when it has been made, and listed in PHOTO.d
define vdta_rule
$(O)/vdta/$(1)/atlas.txt: $(O)/model/model.txt $(AXES) $(VIEW_CAMERAS) $(O)/views/lenses.txt $(IDS_INDEX) $(foreach v,$(2),$(O)/views/$(v).exr \
  $(O)/ids/$(v).exr $(O)/reveal/$(v).exr) $(call needs,bake_vdta) | $(VIEW_EXR) $(IDS_EXR)
	$$(hide)$$(call farm,bake_vdta,$(1),$$@,--model $(O)/model/model.txt --axes $(AXES) --views $(O)/views --ids $(O)/ids \
	  --reveal $(O)/reveal --out $(O)/vdta,,,--photo $(1) --deps $(O)/vdta/$(1).d)
endef
$(if $(MODEL_SCRIPT),$(foreach p,$(VIEWPOINTS),$(eval $(call vdta_rule,$(p),$(filter $(p) $(p)@%,$(VIEWS))))))
-include $(wildcard $(VIEWPOINTS:%=$(O)/vdta/%.d)) # the views that each one really read
endif
