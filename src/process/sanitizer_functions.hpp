// Functions of sanitizers that a program may be built with; each is null if there are none. They may be in the user's
// program alone, so they are found when it runs.
#pragma once

#include <cstddef>

#ifdef __APPLE__

// The linker wants each function to be in some library, weak or not.
#include <dlfcn.h>

namespace pogosim {

template <class Function>
Function* function_of_sanitizer(char const* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace pogosim

#define POGO_SANITIZER_FUNCTION(result, name, ...) \
    inline auto* const name = pogosim::function_of_sanitizer<result(__VA_ARGS__)>(#name);

#else

#define POGO_SANITIZER_FUNCTION(result, name, ...) extern "C" [[gnu::weak]] result name(__VA_ARGS__);

#endif

POGO_SANITIZER_FUNCTION(void, __asan_init)
POGO_SANITIZER_FUNCTION(void, __asan_unpoison_memory_region, void const volatile* address, std::size_t bytes)
POGO_SANITIZER_FUNCTION(void, __sanitizer_start_switch_fiber, void** fake_stack, void const* bottom, std::size_t bytes)
POGO_SANITIZER_FUNCTION(void, __sanitizer_finish_switch_fiber, void* fake_stack, void const** old_bottom,
                        std::size_t* old_bytes)
POGO_SANITIZER_FUNCTION(void*, __tsan_create_fiber, unsigned flags)
POGO_SANITIZER_FUNCTION(void, __tsan_destroy_fiber, void* fiber)
POGO_SANITIZER_FUNCTION(void*, __tsan_get_current_fiber)
POGO_SANITIZER_FUNCTION(void, __tsan_switch_to_fiber, void* fiber, unsigned flags)

#undef POGO_SANITIZER_FUNCTION
