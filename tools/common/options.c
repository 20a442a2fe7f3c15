#include "options.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

int ew_parse_unsigned(const char *text, unsigned min, unsigned max, unsigned *value)
{
    char *end;
    if (!isdigit((unsigned char)text[0])) return -1;
    errno = 0;
    unsigned long number = strtoul(text, &end, 10);
    if (*end || errno || number < min || number > max) return -1;
    *value = (unsigned)number;
    return 0;
}

int ew_parse_double(const char *text, double min, double max, double *value)
{
    char *end;
    errno = 0;
    double number = strtod(text, &end);
    if (end == text || *end || errno || !(number >= min && number <= max)) return -1;
    *value = number;
    return 0;
}

int ew_parse_size(const char *text, unsigned *width, unsigned *height)
{
    char first[8];
    int used = 0;
    unsigned w, h;
    if (sscanf(text, "%7[0-9]x%n", first, &used) != 1 || !used) return -1;
    if (ew_parse_unsigned(first, 1, 4096, &w) || ew_parse_unsigned(text + used, 1, 4096, &h)) return -1;
    *width = w;
    *height = h;
    return 0;
}
