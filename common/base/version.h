/* version.h - the release number, part of every product's provenance. */
#ifndef REMODEL_VERSION_H
#define REMODEL_VERSION_H

#define REMODEL_VERSION "0.1.0"

#endif
