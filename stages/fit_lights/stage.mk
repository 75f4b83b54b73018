# fit_lights: lamps and openings of a scene.
FOLLOWS.fit_lights := trace_ids bake_outdoors bake_vita
READS.fit_lights := scenes/NAME/lights.txt, the model and its plan, axes.txt, cameras, the views that face lamps and marked points, their ids, the VITA, outdoors.exr
LIBS.fit_lights := -lembree3
STEPS.fit_lights := lights
HELP.lights := + lamps that scenes/SCENE/lights.txt marks, with radiance and cones from the photos, and windows as lights
NEEDS.lights := vita outdoors

ifdef GRAPH
LIGHTS := $(if $(MODEL_SCRIPT),$(O)/lights/lights.txt)
LAMPS := $(wildcard scenes/$(SCENE)/lights.txt)
.PHONY: lights
lights: $(LIGHTS)
# a file of marks that came or went is a change whatever its time
$(O)/stamp/lamps.txt: FORCE
	+@mkdir -p $(@D); echo '$(LAMPS)' | cmp -s - $@ || echo '$(LAMPS)' >$@
$(O)/lights/fit.txt $(O)/lights/lights.txt &: $(O)/model/model.txt $(O)/model/plan.txt $(AXES) $(VIEW_CAMERAS) \
  $(O)/views/lenses.txt $(VIEW_EXR) $(IDS_EXR) $(VITA_TXT) $(OUTDOORS) $(if $(LAMPS),$(OUTDOORS_LRI)) $(LAMPS) $(O)/stamp/lamps.txt \
  $(call needs,fit_lights)
	$(call stage,fit_lights,all,$(O),$(LAMPS:%=--lamps %) --model $(O)/model/model.txt --plan $(O)/model/plan.txt \
	  --axes $(AXES) --views $(O)/views --ids $(O)/ids --vita $(O)/vita --outdoors $(OUTDOORS) $(if $(LAMPS),$(if $(OUTDOORS_LRI),--references $(S)/lri)) --out $(O)/lights)
SHOWN_ALWAYS += $(wildcard $(LIGHTS))
endif
