#include "process/crash_name.hpp"

#include <pthread.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "process/fibers.hpp"

namespace pogosim {

namespace {

struct CrashName {
    int signal;
    char const* name;
};
constexpr std::array kNames{
    CrashName{SIGSEGV, "segmentation fault"},
    CrashName{SIGBUS, "bus error"},
    CrashName{SIGFPE, "arithmetic error (such as an integer division by zero)"},
    CrashName{SIGILL, "illegal instruction"},
    CrashName{SIGTRAP, "trap instruction"},
    CrashName{SIGSYS, "forbidden system call"},
    CrashName{SIGABRT, "abort() (such as a failed assert or an uncaught C++ exception)"},
};
static_assert(kNames.size() == kCrashSignals.size());

// How far from the stack pointer a function may touch memory, plus the last pages before the end, which the system
// keeps free.
constexpr std::uintptr_t kStackMarginBytes = 65536;
constexpr std::uintptr_t kBytesPerKib = 1024;

// Where the processor of the robot has its registers (LiteX SoC: CSR). Systems with 64 bits put nothing there.
constexpr std::uintptr_t kFirstRegister = 0xf0000000;
constexpr std::uintptr_t kEndOfRegisters = 0xf0010000;

struct Stack {
    std::uintptr_t end = 0;  // its lowest address
    std::uintptr_t bytes = 0;
};

thread_local Stack noted;

/// What the processor had in its registers at the time of a signal; null on unknown architectures.
struct Registers {
    void* counter = nullptr;
    void* stack = nullptr;
    void* link = nullptr;  // the return address, where calls leave it in a register
};

Registers registers_of([[maybe_unused]] void const* signal_context) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system hands out an address
    [[maybe_unused]] auto const place = [](auto address) { return reinterpret_cast<void*>(address); };
    [[maybe_unused]] auto const& at_signal = static_cast<ucontext_t const*>(signal_context)->uc_mcontext;
#if defined(__linux__) && defined(__x86_64__)
    return {.counter = place(at_signal.gregs[REG_RIP]), .stack = place(at_signal.gregs[REG_RSP])};
#elif defined(__linux__) && defined(__aarch64__)
    constexpr int link_register = 30;
    return {.counter = place(at_signal.pc), .stack = place(at_signal.sp), .link = place(at_signal.regs[link_register])};
#elif defined(__APPLE__) && defined(__x86_64__)
    return {.counter = place(at_signal->__ss.__rip), .stack = place(at_signal->__ss.__rsp)};
#elif defined(__APPLE__)
    return {.counter = place(at_signal->__ss.__pc),
            .stack = place(at_signal->__ss.__sp),
            .link = place(at_signal->__ss.__lr)};
#else
    return {};
#endif
}

/// Both the stack pointer and the faulting address are at or beyond the end of the stack.
bool is_stack_overflow(Stack const& stack, siginfo_t const& info, void const* signal_context) {
    auto const pointer = reinterpret_cast<std::uintptr_t>(registers_of(signal_context).stack);
    auto const touched = reinterpret_cast<std::uintptr_t>(info.si_addr);
    std::uintptr_t const first = stack.end + std::min(kStackMarginBytes, stack.bytes / 4);
    return stack.end > 0 && pointer != 0 && pointer < first && touched < first && touched + kStackMarginBytes > pointer;
}

}  // namespace

void note_stack() {
#ifdef __linux__
    pthread_attr_t attributes;
    void* end = nullptr;
    std::size_t bytes = 0;
    if (pthread_getattr_np(pthread_self(), &attributes) == 0) {
        if (pthread_attr_getstack(&attributes, &end, &bytes) == 0) {
            noted = {.end = reinterpret_cast<std::uintptr_t>(end), .bytes = bytes};
        }
        pthread_attr_destroy(&attributes);
    }
#elif defined(__APPLE__)
    std::size_t const bytes = pthread_get_stacksize_np(pthread_self());
    auto const first = reinterpret_cast<std::uintptr_t>(pthread_get_stackaddr_np(pthread_self()));  // the highest
    noted = {.end = first - bytes, .bytes = bytes};
#endif
}

CrashText crash_name(int signal, siginfo_t const& info, void const* signal_context) {
    CrashText text;
    bool const has_address = (signal == SIGSEGV || signal == SIGBUS) && info.si_code > 0;
    std::span const fiber = running_fiber_stack();
    Stack const stack =
        fiber.empty() ? noted : Stack{.end = reinterpret_cast<std::uintptr_t>(fiber.data()), .bytes = fiber.size()};
    if (has_address && is_stack_overflow(stack, info, signal_context)) {
        text << "stack overflow: the ";
        text.whole(stack.bytes / kBytesPerKib)
            << " KiB of the stack are full (" << (fiber.empty() ? "ulimit -s" : "robot_stack_size")
            << "), as after a function that calls itself without end, or with large local arrays; a real robot has 128 "
               "KiB of memory in all";
        return text;
    }
    auto const* const crash =
        std::find_if(kNames.begin(), kNames.end(), [&](CrashName const& c) { return c.signal == signal; });
    text << crash->name;
    if (has_address) {
        text << " at address ";
        text.address(info.si_addr);
        auto const address = reinterpret_cast<std::uintptr_t>(info.si_addr);
        if (address >= kFirstRegister && address < kEndOfRegisters) {
            text << ", which is a register of the hardware on the robot: those are not simulated";
        }
    }
    return text;
}

void const* return_address(void const* signal_context) {
    Registers const registers = registers_of(signal_context);
#ifdef __x86_64__
    return *static_cast<void* const*>(registers.stack);  // where calls leave it
#else
    return registers.link;
#endif
}

void* program_counter(void const* signal_context) {
    return registers_of(signal_context).counter;
}

}  // namespace pogosim
