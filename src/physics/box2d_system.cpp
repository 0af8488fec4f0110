// Replacements of the functions with which Box2D uses the system. They take effect where Box2D is a shared library,
// since our definitions precede its own.
//
// Box2D's own allocation function does not check whether malloc() failed. Its timer reads the clock for each island of
// touching bodies, which takes a quarter of the time of a sparse swarm, for measurements that are not used.
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
