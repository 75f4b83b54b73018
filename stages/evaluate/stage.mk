# evaluate: the products, compared with a truth and with photos held out.
FOLLOWS.evaluate = $(filter-out evaluate report verify,$(STAGE_FOLDERS))
READS.evaluate := cameras, views, depth maps, models, texture atlases, held-out photos and their frames, rendered pictures, the truth
VARIABLES.evaluate := TRUTH RENDERED
HELP.evaluate := the products, compared with TRUTH or with photos held out, into metrics.tsv

## TRUTH=DIR: known cameras and depths, which products are compared with (docs/evaluation.md)
## RENDERED=DIR: with TRUTH, rendered pictures novel/, edited-E/, relit-E/, shell/ and irradiance/ (default: O/rendered)
