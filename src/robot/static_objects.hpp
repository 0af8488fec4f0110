// What a program asks for at the end of its process: destructors of static objects, and functions given to atexit().
#pragma once

namespace pogosim {

/// How many functions the program has registered so far, without those of robots that have variables of their own.
unsigned functions_at_end();

}  // namespace pogosim
