# trace_ids: the faces of the solid model in each view, and where furniture hides them.
FOLLOWS.trace_ids := build_model rectify segment_depth
READS.trace_ids := the model and its axes, cameras, one view's depth
WRITES.trace_ids := ids/VIEW.exr, VIEW.txt
LIBS.trace_ids := -lembree3
STEPS.trace_ids := ids
HELP.ids := + faces of the solid model in each view, with depth, and where furniture hides them
NEEDS.ids := model
RUN.ids := farm

ifdef GRAPH
IDS_EXR := $(if $(MODEL_SCRIPT),$(VIEWS:%=$(O)/ids/%.exr))
IDS_TXT := $(IDS_EXR:.exr=.txt)
.PHONY: ids
ids: $(IDS_EXR) $(IDS_TXT)
# $(1): a view
define ids_rule
$(O)/ids/$(1).txt $(O)/ids/$(1).exr &: $(O)/model/model.txt $(AXES) $(CAMERAS) $(O)/depth/$(1).exr $(O)/depth/$(1).txt \
  $(call needs,trace_ids)
	$$(hide)$$(call farm,trace_ids,$(1),$(O)/ids/$(1).txt $(O)/ids/$(1).exr,--model $(O)/model/model.txt \
	  --axes $(AXES) --views $(O)/views --view $(1) --depth $(O)/depth --out $(O)/ids/$(1).exr)
endef
$(if $(IDS_EXR),$(foreach v,$(VIEWS),$(eval $(call ids_rule,$(v)))))
endif
