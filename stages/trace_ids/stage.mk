# trace_ids: the faces of the solid model in each view, where furniture hides them, and what edits reveal.
FOLLOWS.trace_ids := build_model rectify segment_depth
READS.trace_ids := the model, its axes and edits, cameras, one view's depth
LIBS.trace_ids := -lembree3
STEPS.trace_ids := ids
HELP.ids := + faces of the solid model in each view, where furniture hides them, and what edits reveal
NEEDS.ids := model

ifdef GRAPH
IDS_VIEWS := $(if $(MODEL_SCRIPT),$(VIEWS))
IDS_EXR := $(IDS_VIEWS:%=$(O)/ids/%.exr)
IDS_TXT := $(IDS_VIEWS:%=$(O)/ids/%.txt)
IDS_INDEX := $(if $(IDS_VIEWS),$(O)/ids/index.txt)
REVEAL_EXR := $(IDS_VIEWS:%=$(O)/reveal/%.exr)
.PHONY: ids ids-views ids-reveal
ids: ids-views ids-reveal $(IDS_INDEX)
ids-views: $(IDS_EXR) $(IDS_TXT)
ids-reveal: $(REVEAL_EXR)
IDS_NEEDS := $(O)/model/model.txt $(AXES) $(VIEW_CAMERAS) $(call needs,trace_ids)
IDS_ARGS := --model $(O)/model/model.txt --axes $(AXES) --views $(O)/views
EDIT_MODELS := $(MODEL_EDITS:%=$(O)/remodel/%/model.txt)
# an edit that went is a change whatever the times of the others
$(O)/stamp/edits.txt: FORCE
	+@mkdir -p $(@D); echo '$(MODEL_EDITS)' | cmp -s - $@ || echo '$(MODEL_EDITS)' >$@
# $(1): a view. VIEW.exr of reveal is replaced only if its bytes change: VIEW.txt is what Make goes by, and the next call of
# Make sees whether VIEW.exr changed.
define ids_rules
$(O)/ids/$(1).txt $(O)/ids/$(1).exr &: $(IDS_NEEDS) $(O)/depth/$(1).exr $(O)/depth/$(1).txt
	$$(hide)$$(call farm,trace_ids,$(1),$(O)/ids/$(1).txt $(O)/ids/$(1).exr,$(IDS_ARGS) --depth $(O)/depth,,,--view $(1) \
	  --out $(O)/ids/$(1).exr)
$(O)/reveal/$(1).txt: $(IDS_NEEDS) $(EDIT_MODELS) $(O)/stamp/edits.txt $(if $(wildcard $(O)/reveal/$(1).exr),,FORCE)
	$$(hide)$$(call farm,trace_ids,reveal-$(1),$(O)/reveal/$(1).txt,$(IDS_ARGS) --reveal $(EDIT_MODELS:%=--edit %),,,--view $(1) \
	  --out $(O)/reveal/$(1).exr)
$(O)/reveal/$(1).exr: | $(O)/reveal/$(1).txt
endef
$(foreach v,$(IDS_VIEWS),$(eval $(call ids_rules,$(v))))
$(IDS_INDEX): $(IDS_TXT) $(IDS_NEEDS)
	$(call stage,trace_ids,index,$(O),$(IDS_ARGS) --index $(O)/ids --out $@)
endif
