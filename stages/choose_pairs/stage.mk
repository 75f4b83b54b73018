# choose_pairs: the pairs of photos whose features are matched.
FOLLOWS.choose_pairs := extract_features
READS.choose_pairs := of many photos the largest features
SHARED.choose_pairs := yes
HELP.pairs := + the pairs of photos that are compared: all of up to 60 photos, of more those that look alike
