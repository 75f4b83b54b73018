# evaluate: the products, compared with a truth and with photos held out.
FOLLOWS.evaluate = $(filter-out evaluate report verify,$(STAGE_FOLDERS))
READS.evaluate := cameras, views, depth maps, models, texture atlases, held-out photos and their frames, rendered pictures, a truth
VARIABLES.evaluate := TRUTH RENDERED
LIBS.evaluate := -lembree3
STEPS.evaluate := evaluate
HELP.evaluate := the products, compared with TRUTH or with photos held out, into metrics.tsv
NEEDS.evaluate := depth

## TRUTH=DIR: known cameras and depths, which products are compared with (docs/evaluation.md)
## RENDERED=DIR: with TRUTH, rendered pictures novel/, edited-E/, relit-E/, shell/ and irradiance/ (default: O/rendered)

ifdef GRAPH
RENDERED_FOLDER := $${REMODEL_RENDERED:-$(O)/rendered}
# models of edits, their relit pictures, and the irradiance that a relighting program wrote
EDITED_MODELS := $(if $(value REMODEL_TRUTH),$(call $(if $(and $(MODELLED),$(MODELS)),made,wildcard),$(MODELS:%=%/model.txt)) \
  $(RELIT_MEASURED) $(wildcard $(O)/relight/*/tour/video.mp4) $(wildcard $(foreach e,exr txt,$(addprefix $(O)/relight/,irradiance.txt irradiance/*.$(e) edited-*/irradiance/*.$(e)))))
.PHONY: evaluate
evaluate: $(O)/metrics.tsv
$(O)/metrics.tsv: $(VIEW_CAMERAS) $(O)/views/lenses.txt $(MEASURED) $(HELD_CAMERAS) $(HELD_EXR) $(HELD_FRAMES) \
  $(S)/photos/list.txt $(EDITED_MODELS) $(ATLASES) $(O)/stamp/truth.txt $(O)/stamp/rendered.txt $(call needs,evaluate)
	$(call stage,evaluate,all,$(O),--folder $(O) --shared $(S) $${REMODEL_TRUTH:+--truth "$$REMODEL_TRUTH"} \
	  --rendered "$(RENDERED_FOLDER)" --out $@)
SHOWN += $(if $(HELDOUT)$(TRUTH),$(O)/metrics.tsv)

look::
	+@stages/evaluate/look.sh $(O)/stamp/truth.txt $(O)/stamp/rendered.txt "$(RENDERED_FOLDER)"
endif
