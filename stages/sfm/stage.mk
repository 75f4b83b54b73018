# sfm: camera poses by COLMAP, or a model that is already there.
FOLLOWS.sfm := import_photos hdr_merge
READS.sfm := photos or hdr/*.jpg (runs COLMAP), or a model that is already there
SHARED.sfm := yes
VARIABLES.sfm := SFM
STEPS.sfm := resfm
HELP.resfm := run COLMAP again, after photos were changed
NEEDS.resfm := hdr

## SFM=DIR: a COLMAP (text, binary) or Bundler model of the photos, used in place of running COLMAP

ifdef GRAPH
MASKS := $(if $(wildcard scenes/$(SCENE)/masks),--masks scenes/$(SCENE)/masks)
# SfM runs once for a set of photos: COLMAP is not reproducible, so a changed photo or mask does not redo it (make resfm does)
$(S)/sfm/models.txt: $(S)/photos/list.txt $(S)/slice/sfm.cfg $(S)/stamp/sfm_source.txt | $(HDR)
	$(call stage,sfm,all,$(S),--photos $(PICTURES) --records $(S)/photos --out $(S)/sfm \
	  $(MASKS) $${REMODEL_SFM:+--model "$$REMODEL_SFM"})

look:: look-photos
	+@stages/sfm/look.sh $(S)
endif
