# What this scene is made from. Every variable of `make help` may stand here; the command line wins.
PHOTOS := ../shared/data/kermit/photos
# photos to leave out, by id or file name; names with blanks in quotes
EXCLUDE := 
PRODUCTS := parallax
