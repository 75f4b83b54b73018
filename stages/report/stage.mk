# report: the page about a scene.
FOLLOWS.report = $(filter-out report verify,$(STAGE_FOLDERS))
READS.report := whatever is there
WRITES.report := index.html, remodel/index.html
STEPS.report := report
HELP.report := + the page: the same as all
NEEDS.report = $(if $(PAIR),morph,depth $(foreach p,$(filter-out parallax,$(PRODUCTS)),$(PRODUCT.$(p))) $(if $(EFFECTS)$(CHOOSE),video) \
  $(if $(HELDOUT)$(value REMODEL_TRUTH),evaluate) pan_scan)

ifdef GRAPH
.PHONY: report
report: $(O)/index.html
$(O)/index.html: $(if $(PAIR),$(M)/video.mp4,$(CAMERAS) $(SHOWN)) $(SHOWN_ALWAYS) $(S)/photos/list.txt \
  $(STAGES:%=$(O)/slice/%.cfg) $(O)/stamp/remodel-page.txt $(call needs,report)
	$(call stage,report,page,$(O),--scene $(SCENE) --folder $(O) --shared $(S) --photos $(PICTURES) \
	  --defaults configs/default.cfg --stages '$(STAGES)' --out $@)
# the page of remodelled rooms, for the people who live in them
REMODEL_PAGE := $(O)/remodel/index.html
.PHONY: remodel-page
remodel-page: $(REMODEL_PAGE)
$(REMODEL_PAGE): $(PICTURES_TXT) $(wildcard $(TOURS:%=%/video.mp4) $(EXPORTS)) $(wildcard scenes/$(SCENE)/edits/*.txt) $(O)/stamp/scene-page.txt \
  $(call needs,report)
	$(call stage,report,remodel,$(O),--scene $(SCENE) --folder $(O) --shared $(S) --remodel --scripts scenes/$(SCENE)/edits \
	  $(if $(filter yes,$(file <$(O)/stamp/scene-page.txt)),--back ../index.html) --out $@)
endif
