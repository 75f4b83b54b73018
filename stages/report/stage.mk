# report: the page about a scene.
FOLLOWS.report = $(filter-out report verify,$(STAGE_FOLDERS))
READS.report := whatever is there
STEPS.report := report
HELP.report := + the page: the same as all
NEEDS.report = $(if $(PAIR),morph,depth $(foreach p,$(filter-out parallax,$(PRODUCTS)),$(PRODUCT.$(p))) $(if $(EFFECTS)$(CHOOSE),video) \
  $(if $(HELDOUT)$(value REMODEL_TRUTH),evaluate) pan_scan)

ifdef GRAPH
REMODEL_PAGE := $(O)/remodel/index.html
.PHONY: report
# the page of remodelled rooms shows relit pictures and their truth, which come after it
report: $(O)/index.html $(if $(filter remodel,$(PRODUCTS)),$(REMODEL_PAGE))
$(O)/index.html: $(if $(PAIR),$(M)/video.mp4,$(VIEW_CAMERAS) $(SHOWN)) $(SHOWN_ALWAYS) $(S)/photos/list.txt \
  $(STAGES:%=$(O)/slice/%.cfg) $(O)/stamp/remodel-page.txt $(call needs,report)
	$(call stage,report,page,$(O),--scene $(SCENE) --folder $(O) --shared $(S) --photos $(PICTURES) \
	  --defaults configs/default.cfg --stages '$(STAGES)' --out $@)
# the page of remodelled rooms, for the people who live in them
.PHONY: remodel-page
remodel-page: $(REMODEL_PAGE)
$(REMODEL_PAGE): $(PICTURES_TXT) $(wildcard $(RELIT_TXT) $(O)/evaluate/relit/*/*.exr) $(wildcard $(TOURS:%=%/video.mp4) $(EXPORTS)) $(wildcard scenes/$(SCENE)/edits/*.txt) $(O)/stamp/scene-page.txt \
  $(call needs,report)
	$(call stage,report,remodel,$(O),--scene $(SCENE) --folder $(O) --shared $(S) --remodel --scripts scenes/$(SCENE)/edits \
	  $(if $(filter yes,$(file <$(O)/stamp/scene-page.txt)),--back ../index.html) --out $@)
endif
