/* ifc_quantities.c - lengths, areas and volumes of elements in IFC4, in the sets that its standard names; see ifc.h. */
#include <stdio.h>

#include "stages/export_model/ifc.h"

void ifc_quantities(struct ifc *f, int element, const char *set, const char *key, const struct ifc_quantity *list,
                    int count)
{
    static const char *const measures[] = {[IFC_LENGTH] = "LENGTH", [IFC_AREA] = "AREA", [IFC_VOLUME] = "VOLUME"};
    char text[1200], value[40];
    const int first = f->last + 1;
    for (int i = 0; i < count; i++)
        ifc_put(f, "IFCQUANTITY%s('%s',$,$,%s,$)", measures[list[i].measure], list[i].name,
                ifc_real(value, list[i].value));
    snprintf(text, sizeof text, "%s %s", set, key);
    const int quantities = ifc_begin_of(f, "IFCELEMENTQUANTITY", text, set);
    fputs(",$,$,(", f->to);
    for (int i = 0; i < count; i++) fprintf(f->to, "%s#%d", i ? "," : "", first + i);
    fputs("));\n", f->to);
    ifc_begin(f, "IFCRELDEFINESBYPROPERTIES", text);
    fprintf(f->to, ",$,(#%d),#%d);\n", element, quantities);
}
