# report: the page about a scene.
FOLLOWS.report = $(filter-out report verify,$(STAGE_FOLDERS))
READS.report := whatever is there
HELP.report := + the page: the same as all
