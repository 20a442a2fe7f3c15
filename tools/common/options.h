/* Numbers in option values. All functions return 0, or -1 for text that is not wholly one
 * of them or is out of range; the results are unchanged then. */
#ifndef EW_TOOLS_OPTIONS_H
#define EW_TOOLS_OPTIONS_H

/* "320x240": each 1 to 4096. */
int ew_parse_size(const char *text, unsigned *width, unsigned *height);
/* A decimal number, min to max. */
int ew_parse_unsigned(const char *text, unsigned min, unsigned max, unsigned *value);
int ew_parse_double(const char *text, double min, double max, double *value);

#endif
