/* Many numbered random cases: a slice of them in `make test`, all in `make fuzz`. */
#ifndef EW_TEST_CASES_H
#define EW_TEST_CASES_H

#include "../unit/unit.h"

/* A run over numbered cases. Each starts the generator from EW_SEED and its own number, so
 * that EW_CASE=N runs case N alone. */
typedef struct cases {
    const char *name;
    long number; /* of the case at hand */
    long begin, end;
} cases;

/* for (cases c = cases_of("coverage", 20000, 10000000); cases_next(&c);) ...
 * runs the first number of cases, or the second when EW_FUZZ is set to 1; EW_FUZZ=0.1 is a
 * tenth of that. On a terminal it shows how far it is. */
cases cases_of(const char *name, long slice, long whole);
int cases_next(cases *c);
/* Whether a single case was asked for, which proves nothing about the rest. */
int cases_alone(void);

/* Prints a figure, and appends it to the file EW_FIGURES, if set, as a CSV row of
 * check, kind, cases, judged (pixels or fragments), wrong, value, unit. Value is "na" where NAN. */
void cases_figure(const char *check, const char *kind, long cases_run, long judged, long wrong, double value,
                  const char *unit);

/* One of n, and a number from low to high. */
uint32_t pick(uint32_t n);
double uniform(double low, double high);

#endif
