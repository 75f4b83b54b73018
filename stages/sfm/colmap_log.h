/* colmap_log.h - what COLMAP's logs say about the photos. */
#ifndef REMODEL_COLMAP_LOG_H
#define REMODEL_COLMAP_LOG_H

#include <stddef.h>

/* Number of pictures that match another one, from the log of `colmap mapper`; -1 if the log does not state it. */
int colmap_log_connected(const char *log);

/* The last line that begins with a letter, for error messages; "" if there is none. */
void colmap_log_last_line(char *text, size_t size, const char *log);

#endif
