# evaluate: the products, compared with a truth and with photos held out.
FOLLOWS.evaluate = $(filter-out evaluate report verify,$(STAGE_FOLDERS))
READS.evaluate := cameras, depth maps, held-out photos and their frames, a truth
WRITES.evaluate := metrics.tsv, evaluate/
VARIABLES.evaluate := TRUTH PICTURES
LIBS.evaluate := -lembree3
STEPS.evaluate := evaluate
HELP.evaluate := the depth maps, compared with TRUTH or with photos held out, into metrics.tsv
NEEDS.evaluate := depth

## TRUTH=DIR: known cameras and depths, which products are compared with (docs/evaluation.md)

ifdef GRAPH
.PHONY: evaluate
evaluate: $(O)/metrics.tsv
$(O)/metrics.tsv: $(CAMERAS) $(O)/views/lenses.txt $(MEASURED) $(HELD_CAMERAS) $(HELD_EXR) $(HELD_FRAMES) \
  $(S)/photos/list.txt $(O)/stamp/truth.txt $(call needs,evaluate)
	$(call stage,evaluate,all,$(O),--folder $(O) --shared $(S) $${REMODEL_TRUTH:+--truth "$$REMODEL_TRUTH"} --out $@)
SHOWN += $(if $(HELDOUT)$(TRUTH),$(O)/metrics.tsv)

look::
	+@stages/evaluate/look.sh $(O)/stamp/truth.txt
endif
