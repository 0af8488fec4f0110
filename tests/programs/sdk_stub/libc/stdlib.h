// For cross compilers without a C library: what programs use of it.
#ifndef STDLIB_H
#define STDLIB_H

#define RAND_MAX 0x7fffffff

int rand(void);
void srand(unsigned seed);
_Noreturn void abort(void);
_Noreturn void exit(int status);

#endif
