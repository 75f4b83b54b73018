/* xml_line.h - where an XML parser is, with any version of libexpat: 2.9 deprecates the name that earlier ones have. */
#ifndef REMODEL_XML_LINE_H
#define REMODEL_XML_LINE_H

#include <stdint.h>

#include <expat.h>

/* from 1 */
static inline uint64_t xml_line(XML_Parser parser)
{
#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9
    return XML_GetCurrentLineNumber64(parser);
#else
    return XML_GetCurrentLineNumber(parser);
#endif
}

#endif
