# report: the page about a scene.
FOLLOWS.report = $(filter-out report verify,$(STAGE_FOLDERS))
READS.report := whatever is there
WRITES.report := index.html
STEPS.report := report
HELP.report := + the page: the same as all
NEEDS.report = $(if $(PAIR),morph,depth $(foreach p,$(filter-out parallax,$(PRODUCTS)),$(PRODUCT.$(p))) $(if $(EFFECTS)$(CHOOSE),video) \
  $(if $(HELDOUT)$(value REMODEL_TRUTH),evaluate) pan_scan)

ifdef GRAPH
.PHONY: report
report: $(O)/index.html
$(O)/index.html: $(if $(PAIR),$(M)/video.mp4,$(CAMERAS) $(SHOWN)) $(SHOWN_ALWAYS) $(S)/photos/list.txt \
  $(STAGES:%=$(O)/slice/%.cfg) $(call needs,report)
	$(call stage,report,page,$(O),--scene $(SCENE) --folder $(O) --shared $(S) --photos $(PICTURES) \
	  --defaults configs/default.cfg --stages '$(STAGES)' --out $@)
endif
