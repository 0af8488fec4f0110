// What Box2D takes from the system, replaced where it is a shared library: the definitions here come before its own.
//
// Its own allocation does not look whether there was memory, and it reads the clock for each island of touching bodies,
// a quarter of the time of a swarm that is spread out, to measure what nobody asks for.
#ifdef B2_SHARED

#include <cstdlib>
#include <new>

#include "physics/box2d_units.hpp"

/// Throws std::bad_alloc. Blocks are freed with std::free(), by b2Free_Default().
void* b2Alloc_Default(int32 size) {
    void* const block = std::malloc(static_cast<std::size_t>(size));
    if (block == nullptr && size > 0) {
        throw std::bad_alloc();
    }
    return block;
}

b2Timer::b2Timer() : m_start_sec(0), m_start_usec(0) {}

void b2Timer::Reset() {}

float b2Timer::GetMilliseconds() const {
    return 0.0F;
}

#endif
