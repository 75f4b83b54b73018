# match_photos: features of a photo that look like those of other photos.
FOLLOWS.match_photos := choose_pairs
READS.match_photos := pairs.txt, the features of a photo, and of those that it is compared with
SHARED.match_photos := yes
HELP.matches := + features that look alike, of each pair of photos that is compared
