/* page.h - what the campaign of faults (campaign.c) and the library that it loads into each program (shim.c) tell each
 * other: a page of memory that both have, behind the file descriptor FAULT_PAGE of the environment. */
#ifndef REMODEL_FAULT_PAGE_H
#define REMODEL_FAULT_PAGE_H

#include <stdatomic.h>
#include <sys/types.h>

#define FAULT_MARK 0x46415554 /* the first argument of a prctl() that tells the tracer: main() begins */

struct fault_page {
    pid_t pid;           /* the process that is meant; others, which it starts, are left alone */
    atomic_long mallocs; /* allocations since main() began */
    long malloc_at;      /* which of them fails, from 1; 0: none */
    int malloc_sticky;   /* all after it fail as well */
    atomic_int foreign;  /* a failing allocation was asked for by a library that is not ours */
    char library[128];   /* its file */
    long frames[6];      /* where the program itself asked for it: for addr2line */
    atomic_long clocks;  /* readings of a clock since main() began */
    long clock_at;       /* from which one each clock goes back, an hour with each reading; 0: none */
};

#endif
