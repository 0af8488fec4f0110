// Stacks for code that may stop in the middle and go on later: fibers, with the switch between stacks of Boost.Context.
//
//   run_on(fiber, body) ──► body ──► leave_fiber() ──┐
//   resume(fiber) ◄─────────────────────────────────┘
//        └─────► after leave_fiber() ──► body returns ──► fiber may be used for other code
//
// Code that is never resumed is left as it is: its destructors do not run, and its stack is given back with the others.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace pogosim {

class Fiber;

/// A copy of suspended code on a fiber.
struct SavedFiber {
    Fiber* fiber = nullptr;
    void* goes_on_at = nullptr;       // of the context that Boost.Context keeps on the stack
    std::vector<std::byte> stack;     // from there to its end
    std::array<void*, 2> exceptions;  // that it is handling
};

/// Fibers that are used again and again. May be used by several threads.
class FiberPool {
public:
    explicit FiberPool(std::size_t stack_bytes);
    ~FiberPool();
    FiberPool(FiberPool const&) = delete;
    FiberPool& operator=(FiberPool const&) = delete;

    /// Returns a fiber on which no code runs. Throws OutOfMemory.
    Fiber& take();
    void put_back(Fiber& fiber);

    /// The same for a fiber whose suspended code is not to be resumed.
    void discard(Fiber& fiber);

    /// Copies the stacks of all suspended code.
    std::vector<SavedFiber> save() const;

    /// Code that was suspended in `saved`, of this pool, is suspended there again; all other fibers are free. What the
    /// frames point to has to be as it was. No code runs on any of them.
    void restore(std::vector<SavedFiber> const& saved);

    /// How much of a stack code has used so far, at most, in whole pages; 0 where that is not known.
    std::size_t deepest_bytes() const;

private:
    std::size_t stack_bytes_;
    mutable std::mutex mutex_;  // of what follows
    std::vector<std::unique_ptr<Fiber>> all_;
    std::vector<Fiber*> unused_;
};

/// Calls body(argument) on a fiber, from code that is on none. Returns when the body has returned (true) or has called
/// leave_fiber() (false). Exceptions that leave the body are thrown here.
bool run_on(Fiber& fiber, void (*body)(void*), void* argument);

/// Continues the code on the fiber where it left it; returns as run_on() does.
bool resume(Fiber& fiber);

/// Switches back to the caller of run_on() or resume(). Returns when the fiber is resumed, perhaps in another thread.
void leave_fiber();

/// Calls body(argument) on the stack of a suspended fiber, below the frames of its suspended code.
void visit(Fiber& fiber, void (*body)(void*), void* argument);

/// The fiber on which this thread runs, or null.
Fiber* running_fiber();

/// The code on the running fiber of this thread was left with a jump; it cannot be resumed.
void forget_running_fiber();

/// The stack on which this thread runs, if it is a fiber's; else empty. For signal handlers.
std::span<std::byte const> running_fiber_stack();

}  // namespace pogosim
