# trace_ids: the faces of the model that each view shows, and what the edits reveal to it.
FOLLOWS.trace_ids := segment_depth build_model
READS.trace_ids := the model, those of the edits, axes.txt, cameras, the view's depth
WRITES.trace_ids := ids/VIEW.exr, VIEW.txt, index.txt; reveal/VIEW.exr
LIBS.trace_ids := -lembree3
STEPS.trace_ids := ids face_index
HELP.ids := + the faces of the model that each view shows, and what edits reveal
NEEDS.ids := model
RUN.ids := farm
NEEDS.face_index := ids

ifdef GRAPH
# nothing to trace without a model
IDS_EXR := $(if $(MODEL_SCRIPT),$(VIEWS:%=$(O)/ids/%.exr))
REVEAL_EXR := $(if $(MODEL_SCRIPT),$(VIEWS:%=$(O)/reveal/%.exr))
FACE_INDEX := $(if $(MODEL_SCRIPT),$(O)/ids/index.txt)
MODEL_TXT := $(O)/model/model.txt
EDIT_TXT := $(EDITS:%=$(O)/remodel/%/model.txt)
TRACE_ARGS := --views $(O)/views --model $(MODEL_TXT) --axes $(AXES)
.PHONY: ids face_index
ids: $(IDS_EXR) $(REVEAL_EXR)
face_index: $(FACE_INDEX)
$(FACE_INDEX): $(IDS_EXR) $(call needs,trace_ids)
	$(call stage,trace_ids,index,$(O),--views $(O)/views --ids $(O)/ids --index $@)
define trace_rules
$(O)/ids/$(1).exr $(O)/ids/$(1).txt &: $(MODEL_TXT) $(AXES) $(CAMERAS) $(O)/depth/$(1).exr $(O)/depth/$(1).txt $(call needs,trace_ids)
	$$(hide)$$(call farm,trace_ids,$(1),$(O)/ids/$(1).txt $(O)/ids/$(1).exr,$(TRACE_ARGS) --depth $(O)/depth --view $(1) --out $(O)/ids/$(1).exr)
$(O)/reveal/$(1).done: $(MODEL_TXT) $(EDIT_TXT) $(AXES) $(CAMERAS) $(call needs,trace_ids)
	$$(hide)$$(call farm,trace_ids,reveal-$(1),$(O)/reveal/$(1).exr,$(TRACE_ARGS) $(EDIT_TXT:%=--edit %) --view $(1) --reveal $(O)/reveal/$(1).exr && touch $$@)
# its time changes only if the edits reveal something else
$(O)/reveal/$(1).exr: $(O)/reveal/$(1).done ;
endef
$(if $(MODEL_SCRIPT),$(foreach v,$(VIEWS),$(eval $(call trace_rules,$(v)))))
endif
