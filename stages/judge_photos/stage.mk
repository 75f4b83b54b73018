# judge_photos: whether the photos are good enough, and what suits them.
FOLLOWS.judge_photos := match_photos
READS.judge_photos := photos or hdr/*.jpg, their records, features and matches
SHARED.judge_photos := yes
HELP.doctor := whether this machine is able; with SCENE and PHOTOS also whether the photos are good enough, and what suits them
