# sfm_import: the SfM model as rectified pinhole views.
FOLLOWS.sfm_import := sfm
READS.sfm_import := sfm/, photos/
STEPS.sfm_import := sfm
HELP.sfm := + camera poses: COLMAP, or the model in SFM
NEEDS.sfm := hdr

## HOLDOUT=N: every Nth photo, the first included, is kept out of depth and rendering, to compare; in out/SCENE+holdoutN
## HOLDOUT_VIEWS="NAMES": the same for these photos or views, in out/SCENE+holdout
HELDOUT := $(if $(HOLDOUT),+holdout$(HOLDOUT),$(if $(HOLDOUT_VIEWS),+holdout))

ifndef GRAPH
ifneq ($(SCENE),)
  ifneq ($(HOLDOUT),)
    ifeq ($(shell [[ '$(subst ','\'',$(HOLDOUT))' =~ ^[1-9][0-9]{0,8}$$ ]] && echo good),)
      $(error HOLDOUT=$(HOLDOUT): wanted a number: every how many photos one is held out)
    endif
    ifneq ($(HOLDOUT_VIEWS),)
      $(error HOLDOUT and HOLDOUT_VIEWS are both given; give one of them)
    endif
  endif
  ifneq ($(HOLDOUT_VIEWS),)
    ifeq ($(shell [[ '$(subst ','\'',$(HOLDOUT_VIEWS))' =~ ^[A-Za-z0-9_@\ -]+$$ ]] && echo good),)
      $(error HOLDOUT_VIEWS=$(HOLDOUT_VIEWS): names of photos and views are letters, digits, _, - and @)
    endif
  endif
endif
else
H := $(O)/holdout
HELD := $(if $(HELDOUT),$(call list_in,$(H)/views/views.mk,VIEWS))
VIEWS := $(call list_in,$(O)/views/views.mk,VIEWS)
VIEW_CAMERAS := $(addprefix $(O)/views/,cameras.txt images.txt points3D.txt)
HELD_CAMERAS := $(if $(HELDOUT),$(addprefix $(H)/views/,cameras.txt images.txt points3D.txt lenses.txt views.mk))
# a view's photo; the photos that have a view
photo_of = $(firstword $(subst @, ,$(1)))
VIEWED := $(sort $(foreach v,$(VIEWS),$(call photo_of,$(v))))
.PHONY: sfm
sfm: $(O)/views/views.mk
$(VIEW_CAMERAS) $(addprefix $(O)/views/,lenses.txt residuals.txt lens_forms.txt views.mk) $(HELD_CAMERAS) &: $(S)/sfm/models.txt $(S)/photos/list.txt \
  $(S)/stamp/photo_sizes.txt $(if $(HELDOUT),$(O)/stamp/holdout.txt) $(call needs,sfm_import)
	$(call stage,sfm_import,all,$(O),--sfm $(S)/sfm --records $(S)/photos --out $(O)/views \
	  $(if $(HOLDOUT),--holdout $(HOLDOUT)) $(if $(HOLDOUT_VIEWS),--holdout-views '$(HOLDOUT_VIEWS)'))

look::
	+@common/run/keep.sh $(if $(HELDOUT),$(O)/stamp/holdout.txt 'every $(HOLDOUT)' 'views $(HOLDOUT_VIEWS)')
endif
