#include "robot/without_effects.hpp"

#ifdef __linux__

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <vector>

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
constexpr std::uint32_t kWriting = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC;

/// Calls that open a file, and which of their arguments has the flags.
struct Opening {
    long number;
    std::uint32_t flags;
};
constexpr Opening kOpenings[] = {
#ifdef SYS_open
    {SYS_open, 1},
#endif
    {SYS_openat, 2},
};

constexpr long kForbidden[] = {
#ifdef SYS_creat
    SYS_creat,          SYS_unlink,    SYS_rename,  SYS_mkdir,    SYS_rmdir,     SYS_link,     SYS_symlink,
    SYS_mknod,          SYS_chmod,     SYS_chown,   SYS_utime,    SYS_utimes,    SYS_lchown,   SYS_futimesat,
#endif
#ifdef SYS_renameat
    SYS_renameat,
#endif
#ifdef SYS_openat2
    SYS_openat2,
#endif
#ifdef SYS_io_uring_setup
    SYS_io_uring_setup,
#endif
    SYS_unlinkat,       SYS_renameat2, SYS_mkdirat, SYS_linkat,   SYS_symlinkat, SYS_mknodat,  SYS_truncate,
    SYS_fchmod,         SYS_fchmodat,  SYS_fchown,  SYS_fchownat, SYS_utimensat, SYS_setxattr, SYS_removexattr,
    SYS_execve,         SYS_execveat,  SYS_socket,  SYS_kill,     SYS_mount,     SYS_umount2,  SYS_mq_open,
    SYS_shmget,         SYS_semget,    SYS_msgget,  SYS_ptrace,
};

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
    std::vector<sock_filter> filter{load(offsetof(seccomp_data, arch)), if_equal(kMachine, 1, 0), result(kRefuse)};
    filter.push_back(load(offsetof(seccomp_data, nr)));
    for (long const number : kForbidden) {
        filter.push_back(if_equal(static_cast<std::uint32_t>(number), 0, 1));
        filter.push_back(result(kRefuse));
    }
    for (auto const [number, flags] : kOpenings) {
        std::size_t const argument = offsetof(seccomp_data, args) + flags * sizeof(std::uint64_t) + low_word;
        filter.push_back(if_equal(static_cast<std::uint32_t>(number), 0, 4));
        filter.push_back(load(argument));
        filter.push_back({BPF_JMP | BPF_JSET | BPF_K, 0, 1, kWriting});
        filter.push_back(result(kRefuse));
        filter.push_back(result(SECCOMP_RET_ALLOW));
    }
    filter.push_back(result(SECCOMP_RET_ALLOW));
    return filter;
}

}  // namespace

bool forbid_effects_of_thread() {
    std::vector<sock_filter> filter = make_filter();
    sock_fprog const program{static_cast<unsigned short>(filter.size()), filter.data()};
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
