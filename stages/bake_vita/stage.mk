# bake_vita: one texture atlas of all faces.
FOLLOWS.bake_vita := rectify trace_ids
READS.bake_vita := the model, those of the edits, axes.txt, the views that show faces best, their ids
STEPS.bake_vita := vita textures
HELP.vita := + one texture atlas of the model, each face seen orthogonally
NEEDS.vita := ids
HELP.textures := both kinds of atlases
NEEDS.textures := vdta vita
PRODUCT.textures := textures

ifdef GRAPH
VITA_TXT := $(if $(MODEL_SCRIPT),$(O)/vita/atlas.txt)
.PHONY: vita textures
vita: $(VITA_TXT)
textures: $(VDTA_TXT) $(VITA_TXT)
$(VITA_TXT): $(O)/model/model.txt $(EDIT_MODELS) $(AXES) $(VIEW_CAMERAS) $(O)/views/lenses.txt $(IDS_INDEX) $(VIEW_EXR) $(IDS_EXR) $(call needs,bake_vita)
	$(call stage,bake_vita,all,$(O),--model $(O)/model/model.txt $(EDIT_MODELS:%=--edit %) --axes $(AXES) --views $(O)/views --ids $(O)/ids --out $(O)/vita)
# atlases that the scene asks for are shown and measured; others only if they exist
ATLASES := $(call $(if $(filter textures remodel,$(PRODUCTS)),made,wildcard),$(VDTA_TXT) $(VITA_TXT))
SHOWN_ALWAYS += $(ATLASES)
endif
