# verify: whether products are whole, for a cluster's jobs.
FOLLOWS.verify = $(filter-out verify,$(STAGE_FOLDERS))
READS.verify := any products
