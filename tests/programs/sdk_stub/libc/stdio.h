// For cross compilers without a C library: what programs use of it.
#ifndef STDIO_H
#define STDIO_H

int printf(char const* format, ...) __attribute__((format(printf, 1, 2)));
int putchar(int character);
int puts(char const* text);

#endif
