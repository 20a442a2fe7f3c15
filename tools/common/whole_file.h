/* A file that appears under its name only when it is whole: written under a temporary name
 * beside it, renamed at the end. A symbolic link keeps pointing where it does; what is no
 * regular file (a device, a folder) is refused. Functions return -1 after one line
 * `tool: path: cannot be written: why` on stderr. */
#ifndef EW_TOOLS_WHOLE_FILE_H
#define EW_TOOLS_WHOLE_FILE_H

#include <stdio.h>

typedef struct ew_whole_file {
    FILE *file; /* NULL: not open */
    const char *tool;
    char *shown, *target, *temporary; /* the name as given; where it leads; where it is written */
} ew_whole_file;

/* path NULL: nothing is written, 0 is returned and close does nothing. `whole` need not be
 * initialised. */
int ew_whole_file_open(ew_whole_file *whole, const char *tool, const char *path);
/* The file of this descriptor is read: from now on, to write over it is refused. One file. */
void ew_whole_file_spare(int descriptor);
/* Gives the file its name, or with keep = 0 removes what was written. */
int ew_whole_file_close(ew_whole_file *whole, int keep);

#endif
