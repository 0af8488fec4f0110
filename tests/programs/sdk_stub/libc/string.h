// For cross compilers without a C library: what programs use of it.
#ifndef STRING_H
#define STRING_H

#include <stddef.h>

void* memcpy(void* to, void const* from, size_t count);
void* memset(void* memory, int value, size_t count);
int memcmp(void const* a, void const* b, size_t count);
int strcmp(char const* a, char const* b);
size_t strlen(char const* text);

#endif
