# fit_materials: the reflectance of marked materials.
FOLLOWS.fit_materials := trace_ids bake_outdoors bake_vita fit_lights
READS.fit_materials := scenes/NAME/materials.txt, the model, axes.txt, cameras, the views that face marked regions, their ids, the VITA, outdoors.exr, lights/lights.txt if there is one
LIBS.fit_materials := -lembree3
STEPS.fit_materials := materials
HELP.materials := + reflectance of the materials that scenes/SCENE/materials.txt marks: Lambert, Phong or Ward, as they need
NEEDS.materials := vita outdoors

ifdef GRAPH
MARKED_MATERIALS := $(wildcard scenes/$(SCENE)/materials.txt)
MATERIALS := $(if $(MODEL_SCRIPT),$(MARKED_MATERIALS:%=$(O)/lights/materials.txt))
MATERIAL_LIGHTS := $(if $(MODEL_SCRIPT),$(patsubst %,$(O)/lights/lights.txt,$(wildcard scenes/$(SCENE)/lights.txt)))
.PHONY: materials
materials: $(MATERIALS)
	$(if $(MATERIALS),,@echo "There is no scenes/$(SCENE)/materials.txt or no model: nothing is marked whose material could be fitted.")
$(O)/lights/materials.txt $(O)/lights/materials/samples.txt &: $(MARKED_MATERIALS) $(O)/model/model.txt $(AXES) $(VIEW_CAMERAS) \
  $(O)/views/lenses.txt $(VIEW_EXR) $(IDS_EXR) $(VITA_TXT) $(OUTDOORS) $(MATERIAL_LIGHTS) $(call needs,fit_materials)
	$(call stage,fit_materials,all,$(O),--marks $(MARKED_MATERIALS) --model $(O)/model/model.txt --axes $(AXES) \
	  --views $(O)/views --ids $(O)/ids --vita $(O)/vita --outdoors $(OUTDOORS) $(MATERIAL_LIGHTS:%=--lights %) --out $(O)/lights)
SHOWN_ALWAYS += $(wildcard $(MATERIALS))
endif
