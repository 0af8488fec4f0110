// What the C library and C++ need of a robot, and variables of the SDK's library.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "pogobot.h"
#include "slip.h"
#include "uart.h"

uint8_t _master_mute;
extern slip_send_descriptor_s const slip_send_descriptor;
slip_send_descriptor_s const slip_send_descriptor = {0, NULL};

// ---- The console: what a program prints is written to the serial line, character by character.

static int put(char character, FILE* file) {
    (void)file;
    uart_write(character);
    return (unsigned char)character;
}

static int get(FILE* file) {
    (void)file;
    return EOF;
}

static FILE console = FDEV_SETUP_STREAM(put, get, NULL, _FDEV_SETUP_RW);
FILE* const stdin = &console;
FILE* const stdout = &console;
FILE* const stderr = &console;

// ---- C++: programs on robots do not end, so no destructor of a static object is called.

void* __dso_handle;
int __cxa_atexit(void (*destructor)(void*), void* object, void* handle);
int __cxa_atexit(void (*destructor)(void*), void* object, void* handle) {
    (void)destructor, (void)object, (void)handle;
    return 0;
}

_Noreturn void __cxa_pure_virtual(void);
_Noreturn void __cxa_pure_virtual(void) {
    abort();
}

void* operator_new(size_t bytes) __asm__("_Znwj");
void* operator_new(size_t bytes) {
    void* const memory = malloc(bytes);
    return memory ? memory : (abort(), NULL);
}
void* operator_new_array(size_t bytes) __asm__("_Znaj");
void* operator_new_array(size_t bytes) {
    return operator_new(bytes);
}
void operator_delete(void* memory) __asm__("_ZdlPv");
void operator_delete(void* memory) {
    free(memory);
}
void operator_delete_array(void* memory) __asm__("_ZdaPv");
void operator_delete_array(void* memory) {
    free(memory);
}
void operator_delete_sized(void* memory, size_t bytes) __asm__("_ZdlPvj");
void operator_delete_sized(void* memory, size_t bytes) {
    (void)bytes, free(memory);
}
void operator_delete_array_sized(void* memory, size_t bytes) __asm__("_ZdaPvj");
void operator_delete_array_sized(void* memory, size_t bytes) {
    (void)bytes, free(memory);
}
