# sample_validity: the viewpoints from which a move can be shown.
FOLLOWS.sample_validity := segment_depth choose_views find_subjects choose_effects
READS.sample_validity := parallax/views.txt, cameras, all layers, subjects.txt

ifdef GRAPH
# of a planned effect: establishing moves show no subject; the image effects of a move share its valid viewpoints
needs_subjects = $(if $(filter establishing_%,$(1)),,$(SUBJECTS))
move_of = $(firstword $(subst +, ,$(1)))
validity = $(addprefix $(P)/$(call move_of,$(1))/,validity.txt validity.png)
# $(1): a move
define validity_rule
$(call validity,$(1)) &: $(VIEW_CAMERAS) $(O)/views/lenses.txt $(DEPTH_EXR) $(DEPTH_TXT) $(call needs_subjects,$(1)) $(FILM_VIEWS) \
  $(call needs,sample_validity) | $(FILM_VIEWS_STAMP)
	$$(call stage,sample_validity,$(1),$(O),--views $(O)/views --film-views $(FILM_VIEWS) --depth $(O)/depth --records $(S)/photos --effect $(1) \
	  $(addprefix --subjects ,$(call needs_subjects,$(1))) --out $(P)/$(1))
endef
endif
