# gather_irradiance: the light that arrives at points and at the surfaces of a view.
FOLLOWS.gather_irradiance := bake_outdoors bake_vita fit_lights fit_materials
READS.gather_irradiance := the model, axes.txt, the VITA, outdoors.exr, lights/lights.txt and the reference images that it names if there are any, lights/materials.txt and the cameras if somebody marked materials, points or a view's camera
LIBS.gather_irradiance := -lembree3
VARIABLES.gather_irradiance := GATHER_POINTS
STEPS.gather_irradiance := irradiance
HELP.irradiance := the light that arrives at the points of GATHER_POINTS, or of TRUTH/irradiance.txt, and at views named by GATHER_VIEWS
NEEDS.irradiance := vita outdoors

## GATHER_POINTS=FILE: for `make irradiance`: lines X Y Z NX NY NZ, points and normals in the frame of O/views
## GATHER_VIEWS="V W": for `make irradiance`: views of which each pixel's surface gets its irradiance

ifdef GRAPH
# of lamps that somebody marked; without marks the panes of the model are its openings
GIVEN_LIGHTS := $(if $(MODEL_SCRIPT),$(patsubst %,$(O)/lights/lights.txt,$(wildcard scenes/$(SCENE)/lights.txt)))
GATHERED_POINTS := $(if $(value REMODEL_GATHER_POINTS),$(O)/stamp/irradiance_points.txt,$(if $(wildcard $(O)/evaluate/irradiance_points.txt),$(O)/stamp/irradiance_points.txt))
GATHERED_VIEWS := $(GATHER_VIEWS:%=$(O)/relight/irradiance/%.exr)
# materials that somebody marked, and the cameras of their regions
GIVEN_MATERIALS := $(if $(MODEL_SCRIPT),$(patsubst %,$(O)/lights/materials.txt,$(wildcard scenes/$(SCENE)/materials.txt)))
gather_needs = $(O)/model/model.txt $(AXES) $(VITA_TXT) $(OUTDOORS) $(GIVEN_LIGHTS) $(GIVEN_MATERIALS) $(if $(GIVEN_MATERIALS),$(VIEW_CAMERAS) $(O)/views/lenses.txt) \
  $(GATHER_LRI) $(call needs,gather_irradiance)
# images that openings of lights.txt name are among those that `make lri` made
GATHER_LRI := $(if $(GIVEN_LIGHTS),$(OUTDOORS_LRI))
gather_args = --model $(O)/model/model.txt --axes $(AXES) --vita $(O)/vita --outdoors $(OUTDOORS) $(GIVEN_LIGHTS:%=--lights %) $(GIVEN_MATERIALS:%=--materials %) --views $(O)/views $(if $(GATHER_LRI),--references $(S)/lri)
.PHONY: irradiance
irradiance: $(if $(MODEL_SCRIPT),$(if $(GATHERED_POINTS),$(O)/relight/irradiance.txt) $(GATHERED_VIEWS))
# the points alone, without the provenance of what wrote them
$(O)/stamp/irradiance_points.txt: FORCE
	+@mkdir -p $(@D); grep -v '^#' "$${REMODEL_GATHER_POINTS:-$(O)/evaluate/irradiance_points.txt}" >$@.tmp; \
	  cmp -s $@.tmp $@ && rm $@.tmp || mv $@.tmp $@
$(O)/relight/irradiance.txt: $(GATHERED_POINTS) $(gather_needs)
	$(call stage,gather_irradiance,points,$(O),$(gather_args) --points $(GATHERED_POINTS) --out $(O)/relight)
$(GATHERED_VIEWS): $(O)/relight/irradiance/%.exr: $(VIEW_CAMERAS) $(gather_needs)
	$(call stage,gather_irradiance,$*,$(O),$(gather_args) --view $* $(if $(GIVEN_MATERIALS),--specular) --out $(O)/relight)
# no rule makes these, so that the page never gathers what a run did not ask for
SHOWN_ALWAYS += $(wildcard $(O)/relight/*.light.txt $(O)/relight/irradiance/*.light.txt)
endif
