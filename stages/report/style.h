/* style.h - the page's CSS: light and dark, wide and narrow. */
#ifndef REMODEL_STYLE_H
#define REMODEL_STYLE_H

extern const char page_style[];

#endif
