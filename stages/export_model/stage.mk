# export_model: the model and its edits with their texture, for other programs.
FOLLOWS.export_model := bake_vita
READS.export_model := a model, its plan and axes, texture.txt, the VITA
LIBS.export_model := -ljansson
STEPS.export_model := exports
HELP.exports := the model and its edits with their texture as OBJ, glTF 2.0 and IFC4
NEEDS.exports := vita

ifdef GRAPH
.PHONY: exports
# $(1): a model's folder. The pages come first, the IFC file last
EXPORTS := $(MODELS:%=%/export/model.ifc)
exports: $(EXPORTS)
define export_rule
$(1)/export/model.ifc: $(1)/model.txt $(1)/plan.txt $(if $(filter $(O)/remodel/%,$(1)),$(1)/texture.txt) $(AXES) $(VITA_TXT) $(call needs,export_model)
	$$(call stage,export_model,$(notdir $(1)),$(O),--name $(SCENE)$(if $(filter $(O)/remodel/%,$(1)),-$(notdir $(1))) --model $(1) \
	  $(if $(filter $(O)/remodel/%,$(1)),--map $(1)/texture.txt) --axes $(AXES) --vita $(O)/vita --out $(1)/export)
endef
$(foreach m,$(MODELS),$(eval $(call export_rule,$(m))))
endif
