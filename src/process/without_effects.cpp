#include "process/without_effects.hpp"

#ifdef __linux__

#include <dlfcn.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <bit>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "process/crash_handler_state.hpp"
#include "process/process.hpp"

namespace pogosim {

namespace {

#if defined(__x86_64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kMachine = 0;
#endif

constexpr std::uint32_t kRefuse = SECCOMP_RET_ERRNO | EPERM;
constexpr std::uint32_t kUnknown = SECCOMP_RET_ERRNO | ENOSYS;  // C libraries have another way for calls that are new
constexpr std::uint32_t kNewest = 469;                          // of the calls that were looked at for these tables
constexpr std::uint32_t kWriting = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC;
constexpr std::uint32_t kAll = UINT32_MAX;

// Calls since number 424 have the same numbers on all machines, and no names in older headers.
constexpr long kCachestat = 451;
constexpr long kMapShadowStack = 453;
constexpr long kFutexWake = 454;
constexpr long kFutexWait = 455;
constexpr long kFutexRequeue = 456;
constexpr long kMseal = 462;

/// Calls that read, compute, wait, or concern this process alone: its memory, its threads, and what it has open.
constexpr long kAllowed[] = {
    // files
    SYS_read, SYS_write, SYS_pread64, SYS_pwrite64, SYS_readv, SYS_writev, SYS_preadv, SYS_pwritev, SYS_preadv2,
    SYS_pwritev2, SYS_sendfile, SYS_splice, SYS_tee, SYS_vmsplice, SYS_copy_file_range, SYS_lseek, SYS_close,
    SYS_close_range, SYS_fstat, SYS_newfstatat, SYS_statx, SYS_statfs, SYS_fstatfs, SYS_faccessat, SYS_faccessat2,
    SYS_readlinkat, SYS_getdents64, SYS_getxattr, SYS_lgetxattr, SYS_fgetxattr, SYS_listxattr, SYS_llistxattr,
    SYS_flistxattr, SYS_getcwd, SYS_chdir, SYS_fchdir, SYS_umask, SYS_dup, SYS_dup3, SYS_pipe2, SYS_flock, SYS_fsync,
    SYS_fdatasync, SYS_sync_file_range, SYS_ftruncate, SYS_fallocate, SYS_fadvise64, SYS_readahead, kCachestat,
    SYS_memfd_create, SYS_inotify_init1, SYS_inotify_add_watch, SYS_inotify_rm_watch, SYS_epoll_create1, SYS_epoll_ctl,
    SYS_epoll_pwait, SYS_epoll_pwait2, SYS_pselect6, SYS_ppoll, SYS_eventfd2, SYS_signalfd4, SYS_timerfd_create,
    SYS_timerfd_settime, SYS_timerfd_gettime,
    // memory
    SYS_mmap, SYS_mprotect, SYS_munmap, SYS_mremap, SYS_brk, SYS_madvise, SYS_msync, SYS_mincore, SYS_mlock, SYS_mlock2,
    SYS_munlock, SYS_mlockall, SYS_munlockall, SYS_membarrier, SYS_pkey_mprotect, SYS_pkey_alloc, SYS_pkey_free,
    SYS_mbind, SYS_get_mempolicy, SYS_set_mempolicy, kMapShadowStack, kMseal,
    // signals that come, threads and children
    SYS_rt_sigaction, SYS_rt_sigprocmask, SYS_rt_sigreturn, SYS_rt_sigpending, SYS_rt_sigsuspend, SYS_rt_sigtimedwait,
    SYS_sigaltstack, SYS_exit, SYS_wait4, SYS_waitid, SYS_futex, SYS_futex_waitv, kFutexWake, kFutexWait, kFutexRequeue,
    SYS_set_tid_address, SYS_set_robust_list, SYS_get_robust_list, SYS_rseq, SYS_prctl, SYS_personality,
    SYS_restart_syscall, SYS_setrlimit, SYS_getrlimit,
    // time
    SYS_nanosleep, SYS_clock_nanosleep, SYS_clock_gettime, SYS_clock_getres, SYS_gettimeofday, SYS_getitimer,
    SYS_setitimer, SYS_timer_create, SYS_timer_settime, SYS_timer_gettime, SYS_timer_getoverrun, SYS_timer_delete,
    // what there is
    SYS_getpid, SYS_getppid, SYS_gettid, SYS_getuid, SYS_geteuid, SYS_getgid, SYS_getegid, SYS_getresuid, SYS_getresgid,
    SYS_getgroups, SYS_getpgid, SYS_getsid, SYS_capget, SYS_uname, SYS_sysinfo, SYS_times, SYS_getrusage, SYS_getrandom,
    SYS_getcpu, SYS_getpriority, SYS_ioprio_get, SYS_sched_yield, SYS_sched_getaffinity, SYS_sched_getparam,
    SYS_sched_getscheduler, SYS_sched_getattr, SYS_sched_get_priority_max, SYS_sched_get_priority_min,
    SYS_sched_rr_get_interval};

#ifdef SYS_open
constexpr long kAllowedOnOldMachines[] = {
    SYS_stat,       SYS_lstat,        SYS_access,     SYS_readlink,     SYS_getdents, SYS_poll,    SYS_select,
    SYS_pipe,       SYS_dup2,         SYS_pause,      SYS_alarm,        SYS_fork,     SYS_getpgrp, SYS_time,
    SYS_arch_prctl, SYS_epoll_create, SYS_epoll_wait, SYS_inotify_init, SYS_signalfd, SYS_eventfd};
#else
constexpr std::array<long, 0> kAllowedOnOldMachines{};
#endif

/// Calls that are allowed if some bits of an argument have a value.
struct Rule {
    long number = 0;
    unsigned argument = 0;  // 0: the first one
    std::uint32_t bits = kAll;
    std::uint32_t value = 0;
};

std::vector<Rule> rules() {
    auto const self = static_cast<std::uint32_t>(getpid());
    std::vector<Rule> made{
#ifdef SYS_open
        {SYS_open, 1, kWriting, 0},
#endif
        {SYS_openat, 2, kWriting, 0},
        {SYS_kill, 0, kAll, self},
        {SYS_tgkill, 0, kAll, self},
        {SYS_rt_sigqueueinfo, 0, kAll, self},
        {SYS_rt_tgsigqueueinfo, 0, kAll, self},
        {SYS_prlimit64, 0, kAll, 0},
        {SYS_prlimit64, 0, kAll, self},
        {SYS_sched_setaffinity, 0, kAll, 0},
        {SYS_clone, 0, CLONE_THREAD, CLONE_THREAD},
        {SYS_clone, 0, CLONE_VM, 0},  // a fork; vfork() is of use only to start another program
        {SYS_exit_group, 0, ~kExitCodeBits, kOwnEnd},
    };
    for (auto const request : {TCGETS, TIOCGWINSZ, TIOCGPGRP, FIONREAD, FIONBIO, FIOCLEX, FIONCLEX}) {
        made.push_back({SYS_ioctl, 1, kAll, static_cast<std::uint32_t>(request)});
    }
    constexpr std::uint32_t kTcgets2 = 0x802c542a;
    made.push_back({SYS_ioctl, 1, kAll, kTcgets2});
    for (int const command : {F_DUPFD, F_DUPFD_CLOEXEC, F_GETFD, F_SETFD, F_GETFL, F_SETFL, F_GETLK, F_SETLK, F_SETLKW,
                              F_GETPIPE_SZ, F_SETPIPE_SZ, F_GET_SEALS, F_ADD_SEALS}) {
        made.push_back({SYS_fcntl, 1, kAll, static_cast<std::uint32_t>(command)});
    }
    return made;
}

sock_filter load(std::size_t offset) {
    return {BPF_LD | BPF_W | BPF_ABS, 0, 0, static_cast<std::uint32_t>(offset)};
}

sock_filter result(std::uint32_t value) {
    return {BPF_RET | BPF_K, 0, 0, value};
}

/// Skips so many instructions if the loaded word is the value, or else.
sock_filter if_equal(std::uint32_t value, std::uint8_t skip_if, std::uint8_t skip_else) {
    return {BPF_JMP | BPF_JEQ | BPF_K, skip_if, skip_else, value};
}

std::vector<sock_filter> make_filter() {
    constexpr std::size_t low_word = std::endian::native == std::endian::little ? 0 : sizeof(std::uint32_t);
    sock_filter const load_number = load(offsetof(seccomp_data, nr));
    std::vector<sock_filter> filter{load(offsetof(seccomp_data, arch)), if_equal(kMachine, 1, 0), result(kRefuse),
                                    load_number};
    auto const decide = [&](long number, std::uint32_t decision) {
        filter.push_back(if_equal(static_cast<std::uint32_t>(number), 0, 1));
        filter.push_back(result(decision));
    };
    for (long const number : kAllowed) {
        decide(number, SECCOMP_RET_ALLOW);
    }
    for (long const number : kAllowedOnOldMachines) {
        decide(number, SECCOMP_RET_ALLOW);
    }
    for (Rule const& rule : rules()) {
        filter.push_back(if_equal(static_cast<std::uint32_t>(rule.number), 0, 4));
        filter.push_back(load(offsetof(seccomp_data, args) + rule.argument * sizeof(std::uint64_t) + low_word));
        filter.push_back({BPF_ALU | BPF_AND | BPF_K, 0, 0, rule.bits});
        filter.push_back(if_equal(rule.value, 0, 1));
        filter.push_back(result(SECCOMP_RET_ALLOW));
        filter.push_back(load_number);
    }
    decide(SYS_exit_group, SECCOMP_RET_TRAP);
    decide(SYS_clone3, kUnknown);  // its flags are out of sight; C libraries call clone() then
    filter.push_back({BPF_JMP | BPF_JGT | BPF_K, 0, 1, kNewest});
    filter.push_back(result(kUnknown));
    filter.push_back(result(kRefuse));
    return filter;
}

pid_t checked_process = 0;
bool has_sanitizer = false;
std::atomic<bool> has_exit_begun = false;
struct sigaction trap_before = {};

int first_argument(void const* signal_context) {
    auto const& registers = static_cast<ucontext_t const*>(signal_context)->uc_mcontext;
#if defined(__x86_64__)
    return static_cast<int>(registers.gregs[REG_RDI]);
#elif defined(__aarch64__)
    return static_cast<int>(registers.regs[0]);
#else
    return static_cast<void>(registers), 0;
#endif
}

/// The program ends its process, or a child of it does.
void on_trapped_call(int signal, siginfo_t* info, void* signal_context) {
    constexpr int kFromFilter = 1;  // SYS_SECCOMP, which has no name in some C libraries
    if (info->si_code != kFromFilter) {
        if ((trap_before.sa_flags & SA_SIGINFO) != 0) {
            trap_before.sa_sigaction(signal, info, signal_context);
        }
        return;
    }
    int const status = first_argument(signal_context);
    bool const is_report = has_sanitizer && status != 0;  // which has said why
    if (getpid() != checked_process || is_report) {
        end_process(status);
    }
    leave_ending_process(status, has_exit_begun, signal_context);
}

void catch_trapped_calls() {
    checked_process = getpid();
    has_sanitizer = dlsym(RTLD_DEFAULT, "__sanitizer_set_death_callback") != nullptr;
    std::atexit([] { has_exit_begun = true; });
    struct sigaction action = {};
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_SIGINFO | SA_NODEFER | SA_ONSTACK;
    action.sa_sigaction = on_trapped_call;
    sigaction(SIGSYS, &action, &trap_before);
}

}  // namespace

bool forbid_effects_of_thread() {
    std::vector<sock_filter> filter = make_filter();
    sock_fprog const program{static_cast<unsigned short>(filter.size()), filter.data()};
    catch_trapped_calls();
    unshare(CLONE_FS);  // the working folder stays that of the other threads
    return kMachine != 0 && prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

}  // namespace pogosim

#else

namespace pogosim {

bool forbid_effects_of_thread() {
    return false;
}

}  // namespace pogosim

#endif
