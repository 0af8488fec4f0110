// For cross compilers without a C library: what programs use of it.
#ifndef MATH_H
#define MATH_H

float sinf(float x);
float cosf(float x);
float atan2f(float y, float x);
float sqrtf(float x);
float fabsf(float x);
float fminf(float x, float y);
float fmaxf(float x, float y);
float logf(float x);
float powf(float x, float y);

#endif
