#include "cases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

cases cases_of(const char *name, long slice, long whole)
{
    const char *fuzz = getenv("EW_FUZZ"), *only = getenv("EW_CASE");
    cases c = { name, 0, 0, slice };
    if (fuzz && strtod(fuzz, NULL) > 0) c.end = (long)((double)whole * strtod(fuzz, NULL));
    if (only) {
        c.begin = strtol(only, NULL, 0);
        c.end = c.begin + 1;
    }
    c.number = c.begin - 1;
    return c;
}

int cases_alone(void) { return getenv("EW_CASE") != NULL; }

int cases_next(cases *c)
{
    long done = ++c->number - c->begin, all = c->end - c->begin;
    if (all >= 100 && done % (all / 100) == 0 && isatty(STDERR_FILENO)) {
        if (done < all) fprintf(stderr, "\r%s: %2ld %%", c->name, done * 100 / all);
        else fprintf(stderr, "\r%60s\r", "");
    }
    test_restart((uint64_t)c->number);
    return c->number < c->end;
}

void cases_figure(const char *check, const char *kind, long cases_run, long judged, long wrong, double value,
                  const char *unit)
{
    char text[32] = "na";
    if (!isnan(value)) snprintf(text, sizeof text, "%.6g", value);
    printf("# %s, %s: %ld cases, %ld judged, %ld wrong", check, kind, cases_run, judged, wrong);
    if (!isnan(value)) printf(", %s %s", text, unit);
    printf("\n");
    const char *path = getenv("EW_FIGURES");
    FILE *f = path ? fopen(path, "a") : NULL;
    if (!f) return;
    fprintf(f, "%s,%s,%ld,%ld,%ld,%s,%s\n", check, kind, cases_run, judged, wrong, text, unit);
    fclose(f);
}

uint32_t pick(uint32_t n) { return test_random() % n; }

double uniform(double low, double high) { return low + (high - low) * (test_random() / 4294967296.0); }
