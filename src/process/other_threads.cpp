#include "process/other_threads.hpp"

#include <dlfcn.h>
#include <pthread.h>
#include <sys/mman.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <memory>

#include "process/crash_handler.hpp"
#include "process/crash_name.hpp"

namespace pogosim {

namespace {

constexpr std::size_t kSignalStackBytes = 65536;

void use_for_signals(void* memory) {
    stack_t stack = {};
    stack.ss_sp = memory;
    stack.ss_size = kSignalStackBytes;
    sigaltstack(&stack, nullptr);
}

/// Memory for a stack of signal handlers, as long as the thread lives.
class SignalStack {
public:
    SignalStack() = default;
    ~SignalStack() {
        if (exists()) {
            stack_t now = {};
            if (sigaltstack(nullptr, &now) == 0 && now.ss_sp == memory_) {
                now.ss_flags = SS_DISABLE;
                sigaltstack(&now, nullptr);
            }
            munmap(memory_, kSignalStackBytes);
        }
    }
    SignalStack(SignalStack const&) = delete;
    SignalStack& operator=(SignalStack const&) = delete;

    bool exists() const { return memory_ != MAP_FAILED; }
    void use() const { use_for_signals(memory_); }

private:
    void* memory_ = mmap(nullptr, kSignalStackBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
};

SignalStack const& signal_stack() {
    static thread_local SignalStack const stack;
    return stack;
}

[[maybe_unused]] void prepare_thread_for_crashes() {
    note_stack();
    if (signal_stack().exists()) {
        signal_stack().use();
    }
}

}  // namespace

void use_large_signal_stack() {
    static thread_local bool is_noted = false;
    if (!is_noted) {
        is_noted = true;
        note_stack();
    }
    stack_t now = {};
    bool const is_large =
        sigaltstack(nullptr, &now) == 0 && (now.ss_flags & SS_DISABLE) == 0 && now.ss_size >= kSignalStackBytes;
    if (!is_large && signal_stack().exists()) {
        signal_stack().use();
    }
}

void prepare_main_thread_for_crashes() {
    note_stack();
    static std::array<char, kSignalStackBytes> memory;  // destructors after the run also need it
    use_for_signals(memory.data());
}

}  // namespace pogosim

// When clang's sanitizers are in the library itself, their pthread_create() must be the one that is called: otherwise
// they do not know the threads, and report what only a thread's stack points to as a leak.
#if defined(__has_feature)
#if __has_feature(thread_sanitizer) || __has_feature(address_sanitizer)
#define POGOSIM_HAS_SANITIZER
#endif
#endif

#if defined(__linux__) && !defined(POGOSIM_HAS_SANITIZER)

extern "C" {

/// Defined when the program is built with -fsanitize=address, which gives threads such stacks and takes them away.
__attribute__((weak)) void __asan_init();
/// With -fsanitize=thread, whose own first thread must not run code of ours.
__attribute__((weak)) void __tsan_init();

using ThreadFunction = void* (*)(void*);

/// Wraps the C library's function: this library comes before libc in the search order.
__attribute__((visibility("default"))) int pthread_create(pthread_t* thread, pthread_attr_t const* attributes,
                                                          ThreadFunction function, void* argument) noexcept {
    struct Start {
        ThreadFunction function;
        void* argument;
    };
    using Create = int (*)(pthread_t*, pthread_attr_t const*, ThreadFunction, void*);
    static auto const create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
    if (&__asan_init != nullptr || &__tsan_init != nullptr) {
        return create(thread, attributes, function, argument);
    }
    auto start = std::make_unique<Start>(Start{function, argument});
    ThreadFunction const run = [](void* of_start) -> void* {
        Start const start = *std::unique_ptr<Start>(static_cast<Start*>(of_start));
        pogosim::prepare_thread_for_crashes();
        return start.function(start.argument);
    };
    int const error = create(thread, attributes, run, start.get());
    if (error == 0) {
        [[maybe_unused]] Start const* const owned_by_thread = start.release();
    }
    return error;
}

/// Replaces the C library's function, and calls it.
__attribute__((visibility("default"))) void pthread_exit(void* result) {
    pogosim::check_end_of_thread();
    static auto const end_thread = reinterpret_cast<void (*)(void*)>(dlsym(RTLD_NEXT, "pthread_exit"));
    end_thread(result);
    std::abort();  // not reached
}
}

#endif
