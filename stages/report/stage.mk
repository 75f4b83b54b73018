# report: the page about a scene.
FOLLOWS.report = $(filter-out report verify,$(STAGE_FOLDERS))
READS.report := whatever is there
WRITES.report := index.html, remodel/index.html
HELP.report := + the page: the same as all
