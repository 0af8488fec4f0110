#include "process/fibers.hpp"

#include <cxxabi.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/context/detail/fcontext.hpp>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "base/counted.hpp"
#include "base/memory.hpp"
#include "process/program_memory.hpp"
#include "process/sanitizer_functions.hpp"  // which need to know which stack is in use

// libc++ has this function of the C++ ABI, and does not declare it.
#ifdef _LIBCPP_VERSION
namespace __cxxabiv1 {
struct __cxa_eh_globals;
extern "C" __cxa_eh_globals* __cxa_get_globals() noexcept;
}  // namespace __cxxabiv1
#endif

namespace pogosim {

namespace {

// boost::context::fiber would unwind the stack of code that is never resumed, which is the user's. So this uses the
// functions that it is made of.
using boost::context::detail::fcontext_t;
using boost::context::detail::jump_fcontext;
using boost::context::detail::make_fcontext;
using boost::context::detail::transfer_t;

constexpr std::size_t kGuardBytes = std::size_t{1} << 20U;  // large local arrays must not reach beyond it
constexpr std::size_t kJumpedBytes = 65536;  // of frames between the resuming context and the target of a jump
constexpr double kBytesPerKib = 1024.0;

// What mincore() tells of a page.
#ifdef __APPLE__
using PageState = char;
#else
using PageState = unsigned char;
#endif

/// Memory with forbidden pages before it, in which an overflow ends.
class Stack {
public:
    explicit Stack(std::size_t bytes) : mapped_bytes_(kGuardBytes + bytes) {
        void* const place = mmap(nullptr, mapped_bytes_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (place == MAP_FAILED) {
            throw std::bad_alloc();
        }
        mapping_ = static_cast<std::byte*>(place);
        if (mprotect(mapping_ + kGuardBytes, bytes, PROT_READ | PROT_WRITE) != 0) {
            munmap(place, mapped_bytes_);
            throw std::bad_alloc();
        }
#ifdef MADV_NOHUGEPAGE
        madvise(place, mapped_bytes_, MADV_NOHUGEPAGE);  // else a stack takes 2 MB as soon as it is used
#endif
        forget_frames();
    }
    ~Stack() {
        forget_frames();  // what is mapped here next, such as a library, is no stack
        munmap(mapping_, mapped_bytes_);
    }
    Stack(Stack const&) = delete;
    Stack& operator=(Stack const&) = delete;

    std::span<std::byte> bytes() const {
        return {mapping_ + kGuardBytes, mapped_bytes_ - kGuardBytes};
    }

private:
    /// Code that was left within a call has variables that a sanitizer watches.
    void forget_frames() {
        if (__asan_unpoison_memory_region != nullptr) {
            __asan_unpoison_memory_region(mapping_, mapped_bytes_);
        }
    }

    std::size_t mapped_bytes_;
    std::byte* mapping_ = nullptr;
};

/// The exceptions being handled, which the C++ runtime keeps for each thread.
using HandledExceptions = std::array<void*, 2>;

/// Replaces this thread's exceptions with those of the code that runs next.
void swap_handled_exceptions(HandledExceptions& other) {
    void* const of_thread = abi::__cxa_get_globals();
    HandledExceptions before;
    std::memcpy(before.data(), of_thread, sizeof(before));
    std::memcpy(of_thread, other.data(), sizeof(other));
    other = before;
}

}  // namespace

class Fiber {
public:
    explicit Fiber(std::size_t stack_bytes) : stack_(stack_bytes) { reset(); }
    ~Fiber() {
        if (tsan_fiber_ != nullptr) {
            __tsan_destroy_fiber(tsan_fiber_);
        }
    }
    Fiber(Fiber const&) = delete;
    Fiber& operator=(Fiber const&) = delete;

    void reset();
    void call(void (*body)(void*), void* argument) {
        body_ = body;
        argument_ = argument;
        has_returned_ = false;
    }
    bool enter();
    void leave();
    void visit(void (*body)(void*), void* argument);
    void forget();
    bool is_suspended() const { return !has_returned_; }
    SavedFiber save();
    void restore(SavedFiber const& saved);
    std::span<std::byte const> stack() const { return stack_.bytes(); }

private:
    [[noreturn]] static void main_of_fiber(transfer_t from);
    void switch_to_outside();
    void note_entry();

    Stack stack_;
    fcontext_t inside_ = nullptr;   // where its code goes on
    fcontext_t outside_ = nullptr;  // context that resumed it
    void (*body_)(void*) = nullptr;
    void* argument_ = nullptr;
    void (*visitor_)(void*) = nullptr;
    void* argument_of_visitor_ = nullptr;
    bool has_returned_ = true;
    std::exception_ptr thrown_;
    HandledExceptions handled_{};  // while suspended, its own; otherwise, those of the context that resumed it

    // For sanitizers.
    void* fake_stack_ = nullptr;
    void* outside_fake_stack_ = nullptr;
    void const* outside_stack_ = nullptr;
    std::size_t outside_stack_bytes_ = 0;
    std::byte const* outside_frame_ = nullptr;  // the last frame of the context that resumed it
    void* tsan_fiber_ = nullptr;
    void* tsan_outside_ = nullptr;
};

namespace {

constinit thread_local Fiber* running = nullptr;

}  // namespace

/// Makes the stack one on which no code runs.
void Fiber::reset() {
    std::span const bytes = stack_.bytes();
    if (__asan_unpoison_memory_region != nullptr) {
        __asan_unpoison_memory_region(bytes.data(), bytes.size());
    }
    inside_ = make_fcontext(bytes.data() + bytes.size(), bytes.size(), main_of_fiber);
    has_returned_ = true;
    handled_ = {};
    fake_stack_ = nullptr;
    if (tsan_fiber_ != nullptr) {
        __tsan_destroy_fiber(tsan_fiber_);
    }
    tsan_fiber_ = __tsan_create_fiber != nullptr ? __tsan_create_fiber(0) : nullptr;
}

void Fiber::main_of_fiber(transfer_t from) {
    Fiber& self = *static_cast<Fiber*>(from.data);
    self.outside_ = from.fctx;
    self.note_entry();
    for (;;) {
        try {
            self.body_(self.argument_);
        } catch (...) {
            self.thrown_ = std::current_exception();
        }
        self.has_returned_ = true;
        self.leave();
    }
}

/// Tells the sanitizer that this fiber runs now. To be called first after each switch to it.
void Fiber::note_entry() {
    if (__sanitizer_finish_switch_fiber != nullptr) {
        __sanitizer_finish_switch_fiber(fake_stack_, &outside_stack_, &outside_stack_bytes_);
    }
}

bool Fiber::enter() {
    running = this;
    outside_frame_ = static_cast<std::byte const*>(__builtin_frame_address(0));
    swap_handled_exceptions(handled_);
    if (__sanitizer_start_switch_fiber != nullptr) {
        __sanitizer_start_switch_fiber(&outside_fake_stack_, stack_.bytes().data(), stack_.bytes().size());
    }
    if (tsan_fiber_ != nullptr) {
        tsan_outside_ = __tsan_get_current_fiber();
        __tsan_switch_to_fiber(tsan_fiber_, 0);
    }
    inside_ = jump_fcontext(inside_, this).fctx;
    if (__sanitizer_finish_switch_fiber != nullptr) {
        __sanitizer_finish_switch_fiber(outside_fake_stack_, nullptr, nullptr);
    }
    swap_handled_exceptions(handled_);
    running = nullptr;
    if (thrown_) {
        std::rethrow_exception(std::exchange(thrown_, nullptr));
    }
    return has_returned_;
}

// Nothing of the thread may be used after the jump: it may be another one.
void Fiber::switch_to_outside() {
    if (__sanitizer_start_switch_fiber != nullptr) {
        __sanitizer_start_switch_fiber(&fake_stack_, outside_stack_, outside_stack_bytes_);
    }
    if (tsan_fiber_ != nullptr) {
        __tsan_switch_to_fiber(tsan_outside_, 0);
    }
    outside_ = jump_fcontext(outside_, this).fctx;
    note_entry();
}

void Fiber::leave() {
    switch_to_outside();
    while (visitor_ != nullptr) {
        std::exchange(visitor_, nullptr)(argument_of_visitor_);
        switch_to_outside();
    }
}

void Fiber::visit(void (*body)(void*), void* argument) {
    visitor_ = body;
    argument_of_visitor_ = argument;
    enter();
}

void Fiber::forget() {
    // Code that was left may have been handling an exception.
    swap_handled_exceptions(handled_);
    if (__sanitizer_start_switch_fiber != nullptr) {
        __sanitizer_start_switch_fiber(nullptr, outside_stack_, outside_stack_bytes_);
        __sanitizer_finish_switch_fiber(outside_fake_stack_, nullptr, nullptr);
    }
    if (__asan_unpoison_memory_region != nullptr) {
        // Clears the marks of frames that the jump has skipped: the sanitizer did so only for those on the fiber.
        auto const* const here = static_cast<std::byte const*>(__builtin_frame_address(0));
        std::byte const* const end = outside_frame_ - kJumpedBytes;
        __asan_unpoison_memory_region(end, static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, here - end)));
    }
    if (tsan_fiber_ != nullptr) {
        __tsan_switch_to_fiber(tsan_outside_, 0);
    }
}

/// The code on it is suspended.
SavedFiber Fiber::save() {
    auto const* const from = static_cast<std::byte const*>(inside_);
    SavedFiber saved{
        .fiber = this,
        .goes_on_at = inside_,
        .stack = std::vector<std::byte>(static_cast<std::size_t>(std::to_address(stack_.bytes().end()) - from)),
        .exceptions = handled_};
    copy_program_bytes(saved.stack.data(), from, saved.stack.size());
    return saved;
}

void Fiber::restore(SavedFiber const& saved) {
    reset();
    inside_ = saved.goes_on_at;
    copy_program_bytes(static_cast<std::byte*>(inside_), saved.stack.data(), saved.stack.size());
    handled_ = saved.exceptions;
    has_returned_ = false;
}

FiberPool::FiberPool(std::size_t stack_bytes) : stack_bytes_(stack_bytes) {}

FiberPool::~FiberPool() = default;

Fiber& FiberPool::take() {
    std::lock_guard const lock(mutex_);
    if (unused_.empty()) {
        auto const purpose = [&] {
            return fmt::format(
                "the stack of one more robot that waits in the middle of its program, after {} "
                "(robot_stack_size: {:g} KiB; the system allows only so many: sysctl vm.max_map_count)",
                counted(all_.size(), "other"), static_cast<double>(stack_bytes_) / kBytesPerKib);
        };
        allocate_for(purpose, std::nullopt, [&] {
            all_.push_back(std::make_unique<Fiber>(stack_bytes_));
            unused_.reserve(all_.size());
        });
        return *all_.back();
    }
    Fiber& fiber = *unused_.back();
    unused_.pop_back();
    return fiber;
}

void FiberPool::discard(Fiber& fiber) {
    fiber.reset();
    put_back(fiber);
}

void FiberPool::put_back(Fiber& fiber) {
    std::lock_guard const lock(mutex_);
    unused_.push_back(&fiber);
}

std::vector<SavedFiber> FiberPool::save() const {
    std::lock_guard const lock(mutex_);
    std::vector<SavedFiber> saved;
    for (std::unique_ptr<Fiber> const& fiber : all_) {
        if (fiber->is_suspended()) {
            saved.push_back(fiber->save());
        }
    }
    return saved;
}

void FiberPool::restore(std::vector<SavedFiber> const& saved) {
    std::lock_guard const lock(mutex_);
    unused_.clear();
    for (std::unique_ptr<Fiber> const& fiber : all_) {
        auto const found = std::ranges::find(saved, fiber.get(), &SavedFiber::fiber);
        if (found != saved.end()) {
            fiber->restore(*found);
        } else {
            fiber->reset();
            unused_.push_back(fiber.get());
        }
    }
}

std::size_t FiberPool::deepest_bytes() const {
    std::lock_guard const lock(mutex_);
    auto const page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    std::vector<PageState> is_in_memory(stack_bytes_ / page + 1);
    std::size_t deepest = 0;
    for (std::unique_ptr<Fiber> const& fiber : all_) {
        std::span const stack = fiber->stack();
        auto* const begin = const_cast<std::byte*>(stack.data());
        if (mincore(begin, stack.size(), is_in_memory.data()) == 0) {
            auto const first = std::ranges::find_if(
                is_in_memory, [](PageState page) { return (static_cast<unsigned>(page) & 1U) != 0; });
            auto const unused = static_cast<std::size_t>(first - is_in_memory.begin()) * page;
            deepest = std::max(deepest, stack.size() - std::min(unused, stack.size()));
        }
    }
    return deepest;
}

bool run_on(Fiber& fiber, void (*body)(void*), void* argument) {
    fiber.call(body, argument);
    return fiber.enter();
}

bool resume(Fiber& fiber) {
    return fiber.enter();
}

void visit(Fiber& fiber, void (*body)(void*), void* argument) {
    fiber.visit(body, argument);
}

void leave_fiber() {
    running->leave();
}

Fiber* running_fiber() {
    return running;
}

void forget_running_fiber() {
    if (Fiber* const fiber = std::exchange(running, nullptr)) {
        fiber->forget();
    }
}

std::span<std::byte const> running_fiber_stack() {
    return running != nullptr ? running->stack() : std::span<std::byte const>();
}

}  // namespace pogosim
