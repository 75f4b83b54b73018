# fit_response: the camera's response curve, from the exposures of some views.
FOLLOWS.fit_response := import_photos
READS.fit_response := the exposures of some views; only where photos are brackets
SHARED.fit_response := yes
