# segment_depth: layered depth of each view, in rounds.
FOLLOWS.segment_depth := rectify
READS.segment_depth := one view and the neighbours it selects; its depth in DEPTH, if there is any; after the first round, what they had in the round before and how much it had changed
VARIABLES.segment_depth := DEPTH
STEPS.segment_depth := depth
HELP.depth := + layered depth maps
NEEDS.depth := views

## DEPTH=DIR: depth that is known already: DIR/VIEW.exr or .png of any view (docs/formats.md); the others are matched

ifdef GRAPH
DEPTH_EXR := $(VIEWS:%=$(O)/depth/%.exr)
DEPTH_TXT := $(DEPTH_EXR:.exr=.txt)
.PHONY: depth
depth: $(DEPTH_EXR) $(DEPTH_TXT) $(DEPTH_EXR:.exr=.round)
# Each round reads what the one before left in its folder; the last is O/depth itself. A view that little changes in and
# around is carried over from the round before: that is decided by segment_depth, from the records VIEW.round.
LAST_ROUND := $(shell sed -n 's/^rounds = //p' $(O)/slice/segment_depth.cfg 2>/dev/null)
ROUNDS := $(if $(LAST_ROUND),$(shell seq 0 $(LAST_ROUND)))
# the round before; empty for the first
before = $(if $(filter-out 0,$(1)),$(word $(1),$(ROUNDS)))
round = $(O)/depth$(if $(filter-out $(LAST_ROUND),$(1)),/round$(1))
GIVEN := $(if $(value REMODEL_DEPTH),--given "$$$$REMODEL_DEPTH")
# $(1): a view; $(2): the folder of a round; $(3): that of the round before, empty for the first; $(4): its target. Every view
# waits for all pictures and for all of the round before: through one target, since a list of all for each is too long
.PHONY: pictures
pictures: $(VIEW_EXR)
define depth_rule
$(2)/$(1).exr $(2)/$(1).txt $(2)/$(1).round &: $(O)/views/$(1).exr $(if $(3),$(3)/$(1).exr) $(wildcard $(S)/stamp/given/$(1).txt) \
  $(VIEW_CAMERAS) $(call needs,segment_depth) | pictures $(filter-out %none,$(4))
	$$(hide)$$(call farm,segment_depth,$(1),$(2)/$(1).round $(2)/$(1).txt $(2)/$(1).exr,\
	  --view $(1) --views $(O)/views --records $(S)/photos $(if $(3),--before $(3)) $(GIVEN) --out $(2)/$(1).exr --deps $(2)/$(1).d)
endef
# $(1): a round
define round_rules
.PHONY: depth-round$(1)
depth-round$(1): $(foreach e,exr txt round,$(VIEWS:%=$(call round,$(1))/%.$(e)))
-include $(wildcard $(VIEWS:%=$(call round,$(1))/%.d)) # the neighbours each view really read
endef
$(foreach k,$(ROUNDS),$(eval $(call round_rules,$(k)))$(foreach b,$(or $(call before,$(k)),none),$(foreach \
  v,$(VIEWS),$(eval $(call depth_rule,$(v),$(call round,$(k)),$(if $(filter-out none,$(b)),$(call round,$(b))),$(b:%=depth-round%))))))
$(O)/views/%.exr: ; # a neighbour that is a view no more
MEASURED += $(DEPTH_EXR) $(DEPTH_TXT)
SHOWN += $(DEPTH_EXR) $(DEPTH_TXT)

look:: look-photos
	+@stages/segment_depth/look.sh $(S)
endif
