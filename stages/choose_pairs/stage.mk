# choose_pairs: the pairs of photos whose features are matched.
FOLLOWS.choose_pairs := extract_features
READS.choose_pairs := the photos; the largest features of sets of more than 60
SHARED.choose_pairs := yes
HELP.pairs := + the pairs of photos to match: all pairs of up to 60 photos; in larger sets, neighbours by name and photos that look alike
