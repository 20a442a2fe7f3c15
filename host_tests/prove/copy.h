/* Before every source: parts of structures are copied by memcpy, as GNU compilers do (src/raster/arch.h);
 * Eva knows it, with its precondition, where a loop over bytes would leave any bytes. */
#ifndef EW_PROVE_COPY_H
#define EW_PROVE_COPY_H

#include <string.h>

#define EW_COPY(to, from, bytes) ((void)memcpy(to, from, bytes))

#endif
