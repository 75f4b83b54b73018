/* student.h - Student's distribution, for intervals of means of few values [Student 1908]. */
#ifndef REMODEL_STUDENT_H
#define REMODEL_STUDENT_H

/* The quantile 0.975 for n degrees of freedom, within 1 % for n > 1: its expansion about the normal distribution, whose
 * quantile is z. n = 0: z. */
static inline double student_quantile(int n)
{
    const double z = 1.96, by = n > 0 ? 1.0 / n : 0;
    return z + by * (2.372 + by * (2.823 + by * (2.556 + by * 1.59)));
}

#endif
