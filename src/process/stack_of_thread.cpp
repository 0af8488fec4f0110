#include "process/backtrace.hpp"

#ifdef POGOSIM_HAS_LIBDW

#include <dlfcn.h>
#include <elfutils/libdwfl.h>
#include <fcntl.h>
#include <unistd.h>

namespace pogosim {

namespace {

// The unwinder of the compiler's library only knows the thread that calls it, so this is that of elfutils, which needs
// no more than memory and registers. The kernel shows two registers; frames of library functions need no others.
#if defined(__x86_64__)
constexpr int kStackPointer = 7;  // its number in DWARF
#elif defined(__aarch64__)
constexpr int kStackPointer = 31;
#else
constexpr int kStackPointer = -1;
#endif

struct Search {
    ThreadPlace thread;
    void const* program_base;
    int memory;  // descriptor of /proc/self/mem: an address that is none is an error, not a crash
    void const* found = nullptr;
};

pid_t next_thread(Dwfl* /*dwfl*/, void* of_search, void** thread_argument) {
    if (*thread_argument != nullptr) {
        return 0;
    }
    *thread_argument = of_search;
    return static_cast<Search*>(of_search)->thread.thread;
}

bool read_memory(Dwfl* /*dwfl*/, Dwarf_Addr address, Dwarf_Word* word, void* of_search) {
    auto const& search = *static_cast<Search*>(of_search);
    return pread(search.memory, word, sizeof(*word), static_cast<off_t>(address)) == sizeof(*word);
}

bool set_registers(Dwfl_Thread* thread, void* of_search) {
    auto const& search = *static_cast<Search*>(of_search);
    Dwarf_Word const stack_pointer = search.thread.stack_pointer;
    dwfl_thread_state_register_pc(thread, search.thread.program_counter);
    return dwfl_thread_state_registers(thread, kStackPointer, 1, &stack_pointer);
}

int look_at_frame(Dwfl_Frame* frame, void* of_search) {
    auto& search = *static_cast<Search*>(of_search);
    Dwarf_Addr address = 0;
    bool is_running_here = false;
    if (!dwfl_frame_pc(frame, &address, &is_running_here)) {
        return DWARF_CB_ABORT;
    }
    // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the unwinder hands out an address
    auto const* const place = reinterpret_cast<void const*>(is_running_here ? address : address - 1);
    if (object_of(place) != search.program_base) {
        return DWARF_CB_OK;
    }
    search.found = place;
    return DWARF_CB_ABORT;
}

/// Only the frames are of interest, which each file describes itself.
int find_no_debug_information(Dwfl_Module* /*module*/, void** /*user*/, char const* /*name*/, Dwarf_Addr /*base*/,
                              char const* /*file*/, char const* /*link*/, GElf_Word /*checksum*/, char** /*found*/) {
    return -1;
}

void search_stack(Search& search) {
    static Dwfl_Callbacks const files{.find_elf = dwfl_linux_proc_find_elf,
                                      .find_debuginfo = find_no_debug_information,
                                      .section_address = nullptr,
                                      .debuginfo_path = nullptr};
    static Dwfl_Thread_Callbacks const state{.next_thread = next_thread,
                                             .get_thread = nullptr,
                                             .memory_read = read_memory,
                                             .set_initial_registers = set_registers,
                                             .detach = nullptr,
                                             .thread_detach = nullptr};
    Dwfl* const dwfl = dwfl_begin(&files);
    if (dwfl != nullptr && dwfl_linux_proc_report(dwfl, getpid()) == 0 &&
        dwfl_report_end(dwfl, nullptr, nullptr) == 0 && dwfl_attach_state(dwfl, nullptr, getpid(), &state, &search)) {
        dwfl_getthread_frames(dwfl, search.thread.thread, look_at_frame, &search);
    }
    dwfl_end(dwfl);
}

}  // namespace

void const* place_in_stack(ThreadPlace const& thread, void const* program_base) {
    Search search{
        .thread = thread, .program_base = program_base, .memory = open("/proc/self/mem", O_RDONLY | O_CLOEXEC)};
    if (program_base != nullptr && search.memory >= 0 && kStackPointer >= 0) {
        search_stack(search);
    }
    if (search.memory >= 0) {
        close(search.memory);
    }
    return search.found;
}

}  // namespace pogosim

#else

namespace pogosim {

void const* place_in_stack(ThreadPlace const& /*thread*/, void const* /*program_base*/) {
    return nullptr;
}

}  // namespace pogosim

#endif
