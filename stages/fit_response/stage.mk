# fit_response: the camera's response curve, from the exposures of some views.
FOLLOWS.fit_response := import_photos
READS.fit_response := the exposures of some views; only where photos are brackets
SHARED.fit_response := yes

ifdef GRAPH
# The scene's response.txt wins, else the exposures show the curve. It is found before the merges are planned
# (stages/hdr_merge/run.sh), and written only if it is new, so that merges depend on its text and not on the photos:
# hence the stamp, and the rule without a recipe.
RESPONSE := $(or $(wildcard scenes/$(SCENE)/response.txt),$(S)/hdr/response.txt)
RESPONSE_STAMP := $(if $(wildcard scenes/$(SCENE)/response.txt),,$(S)/stamp/response.txt)
$(S)/stamp/response.txt: $(if $(BRACKETED),$(PHOTO_IDS:%=$(S)/photos/%.txt) $(S)/photos/list.txt) $(call shared_needs,fit_response)
	$(call stage,fit_response,all,$(S),--photos $(ORIGINALS) --records $(S)/photos --out $(S)/hdr/response.txt)
	+@mkdir -p $(@D); echo done >$@
$(S)/hdr/response.txt: ;
.PHONY: response
response: $(if $(BRACKETED),$(RESPONSE_STAMP))
endif
