#include "engine/import/reader_child/sandbox.h"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace touchstone {

namespace {

constexpr uint32_t kAllowed[] = {
    SYS_read,        SYS_write,        SYS_writev,        SYS_close,           SYS_fstat,
    SYS_lseek,       SYS_mmap,         SYS_munmap,        SYS_mremap,          SYS_mprotect,
    SYS_madvise,     SYS_brk,          SYS_futex,         SYS_getpid,          SYS_gettid,
    SYS_tgkill,      SYS_rt_sigaction, SYS_sigaltstack,   SYS_rt_sigprocmask,  SYS_rt_sigreturn,
    SYS_sched_yield, SYS_nanosleep,    SYS_clock_gettime, SYS_clock_nanosleep, SYS_getrandom,
    SYS_exit,        SYS_exit_group,
};
constexpr size_t kCount = std::size(kAllowed);

} // namespace

void enterSandbox() {
    // Loads the architecture and refuses others, whose numbers mean other calls; loads the number and jumps
    // from the allowed ones to the last instruction. x32 numbers have bit 30 set and are on no list.
    std::array<sock_filter, kCount + 6> program{};
    size_t at = 0;
    const auto add = [&](sock_filter instruction) { program[at++] = instruction; };
    add(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)));
    add(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, AUDIT_ARCH_X86_64, 1, 0));
    add(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS));
    add(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)));
    for (size_t i = 0; i < kCount; ++i)
        add(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kAllowed[i], static_cast<uint8_t>(kCount - i), 0));
    add(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM));
    add(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
    const sock_fprog filter{static_cast<unsigned short>(at), program.data()};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
        prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter, 0, 0) != 0)
        throw std::runtime_error("this system offers no sandbox (seccomp) to work in");
}

} // namespace touchstone
