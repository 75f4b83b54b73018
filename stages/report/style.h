/* style.h - the CSS of the page: light and dark modes, wide and narrow windows, print. */
#ifndef REMODEL_STYLE_H
#define REMODEL_STYLE_H

extern const char page_style[];

#endif
