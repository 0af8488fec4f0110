#include "process/backtrace.hpp"

#include <dlfcn.h>
#include <unwind.h>

#include <csetjmp>
#include <cstdint>

#include "process/crash_name.hpp"

namespace pogosim {

namespace {

constexpr int kMostFrames = 200;

struct Search {
    void const* program_base;
    int callees;
    void const* found = nullptr;
    int frames = 0;
};

// State of the search in this thread.
constinit thread_local bool is_searching = false;
thread_local sigjmp_buf way_back;

bool is_code_of(void const* program_base, void const* place) {
    Dl_info object;
    return place != nullptr && dladdr(place, &object) != 0 && object.dli_fbase == program_base;
}

bool is_code(void const* place) {
    Dl_info object;
    return place != nullptr && dladdr(place, &object) != 0;
}

/// A call through a bad pointer leaves no frame to unwind; its caller is found on the stack or in a register.
void const* caller_by_bad_pointer(Search const& search, void const* signal_context) {
    auto const* const next = static_cast<char const*>(return_address(signal_context));
    return is_code_of(search.program_base, next) ? next - 1 : nullptr;
}

_Unwind_Reason_Code look_at_frame(_Unwind_Context* frame, void* of_search) {
    auto& search = *static_cast<Search*>(of_search);
    int is_before_instruction = 0;
    std::uintptr_t const next = _Unwind_GetIPInfo(frame, &is_before_instruction);
    // After a call, the next instruction may be of another line, or another function.
    std::uintptr_t const place = is_before_instruction != 0 || next == 0 ? next : next - 1;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the unwinder hands out an address
    auto const* const code = reinterpret_cast<void const*>(place);
    if (is_code_of(search.program_base, code) && search.callees-- == 0) {
        search.found = code;
        return _URC_END_OF_STACK;
    }
    return ++search.frames < kMostFrames ? _URC_NO_REASON : _URC_END_OF_STACK;
}

struct FunctionSearch {
    void const* function;
    bool found = false;
    int frames = 0;
};

_Unwind_Reason_Code look_at_function(_Unwind_Context* frame, void* of_search) {
    auto& search = *static_cast<FunctionSearch*>(of_search);
    search.found = _Unwind_GetRegionStart(frame) == reinterpret_cast<std::uintptr_t>(search.function);
    return !search.found && ++search.frames < kMostFrames ? _URC_NO_REASON : _URC_END_OF_STACK;
}

}  // namespace

void const* object_of(void const* code) {
    Dl_info object;
    return code != nullptr && dladdr(code, &object) != 0 ? object.dli_fbase : nullptr;
}

bool is_being_called(void const* function) {
    static thread_local FunctionSearch search;  // where a jump does not lose it
    search = {.function = function};
    is_searching = true;
    if (sigsetjmp(way_back, 0) == 0) {
        _Unwind_Backtrace(look_at_function, &search);
    }
    is_searching = false;
    return search.found;
}

void const* place_in_program(void const* program_base, void const* signal_context, int callees) {
    static thread_local Search search;  // where a jump does not lose it
    search = {.program_base = program_base, .callees = callees};
    if (program_base == nullptr || is_searching) {
        return nullptr;
    }
    is_searching = true;
    if (sigsetjmp(way_back, 0) == 0) {
        if (signal_context != nullptr && !is_code(program_counter(signal_context))) {
            search.found = caller_by_bad_pointer(search, signal_context);
        } else {
            _Unwind_Backtrace(look_at_frame, &search);
        }
    }
    is_searching = false;
    return search.found;
}

void go_on_after_crash_of_backtrace() {
    if (is_searching) {
        siglongjmp(way_back, 1);
    }
}

}  // namespace pogosim
