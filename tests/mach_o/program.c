// A program with variables of all kinds, for macOS.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "pogosim/shared_state.h"

int steps = 3;                           // has a value
static long sums[5];                     // is 0 in the beginning
double const table[2] = {1.5, 2.5};      // no variable
char const* const names[] = {"a", "b"};  // filled by the linker, then constant
POGO_SHARED int of_all = 7;
_Thread_local int of_thread = 4;
static _Thread_local char buffer_of_thread[24];
static float gain = 2.0F;

__attribute__((used)) static void before_constructors(void) {}

int robot_step(int of, char const* text) {
    static int calls = 0;
    POGO_NOTE_CONFIGURED(gain);
    char word[8];
    ++calls;
    sums[of % 5] += of;
    buffer_of_thread[of % 24] += (char)of_thread++;
    if (sscanf(text, "%7s", word) == 1) {
        gain += (float)sin(of);
    }
    return calls + steps++ + of_all + (int)strlen(names[of % 2]) + (int)(gain + table[of % 2]);
}
