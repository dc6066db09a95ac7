#include "haptics/servo/realtime_thread.h"

#include <linux/capability.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <ctime>

namespace touchstone {

namespace {

constexpr int kFifoPriority = 80; // above most IRQ threads (50), below the watchdogs (99)
constexpr uint64_t kSliceNs =
    100'000; // the kernel's minimum; reduced missed deadlines tenfold (docs/architecture.md, Threads)
constexpr size_t kStackToTouch = 256 * 1024; // far more than a tick uses

// Not in Debian 12's headers.
struct SchedAttr {
    uint32_t size, policy;
    uint64_t flags;
    int32_t nice;
    uint32_t priority;
    uint64_t runtime, deadline, period;
    uint32_t utilMin, utilMax;
};

bool askForFifo() {
    sched_param parameters{};
    parameters.sched_priority = kFifoPriority;
    return sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
}

/// Since Linux 6.12 sched_runtime of a normal thread is its EEVDF slice: the shorter, the sooner it runs
/// after a wake-up. Older kernels accept and ignore it, so the value is read back.
bool askForSlice(int nice) {
    SchedAttr attributes{};
    attributes.size = sizeof attributes;
    attributes.policy = SCHED_OTHER;
    attributes.nice = nice;
    attributes.runtime = kSliceNs;
    if (syscall(SYS_sched_setattr, 0, &attributes, 0) != 0)
        return false;
    SchedAttr granted{};
    return syscall(SYS_sched_getattr, 0, &granted, sizeof granted, 0) == 0 && granted.runtime == kSliceNs;
}

bool mayLockWithoutLimit() {
    rlimit limit{};
    if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY)
        return true;
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    __user_cap_data_struct data[2]{};
    return syscall(SYS_capget, &header, data) == 0 && (data[0].effective & (1u << CAP_IPC_LOCK)) != 0;
}

/// Locks pages as they are touched. Under a memory limit it is not attempted: once the limit is reached every
/// later mmap of the process would fail, including the loader's and the renderer's. Without ONFAULT it would
/// fill all reserved memory, thread stacks first.
bool lockMemory() {
    return mayLockWithoutLimit() && mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
}

/// Pins to the last CPU available to the process: the first one serves most interrupts.
int pinToLastCpu() {
    cpu_set_t allowed;
    if (sched_getaffinity(0, sizeof allowed, &allowed) != 0 || CPU_COUNT(&allowed) < 2)
        return -1;
    for (int cpu = CPU_SETSIZE - 1; cpu >= 0; --cpu) {
        if (!CPU_ISSET(cpu, &allowed))
            continue;
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(cpu, &one);
        return sched_setaffinity(0, sizeof one, &one) == 0 ? cpu : -1;
    }
    return -1;
}

[[gnu::noinline]] void touchStack() {
    unsigned char pages[kStackToTouch];
    for (size_t i = 0; i < kStackToTouch; i += 4096)
        pages[i] = 0;
    asm volatile("" : : "r"(pages) : "memory"); // keeps the stores
}

} // namespace

ServoScheduling enterRealtime() {
    ServoScheduling granted;
    prctl(PR_SET_TIMERSLACK, 1UL);
    if (askForFifo()) {
        granted.policy = "SCHED_FIFO " + std::to_string(kFifoPriority);
    } else {
        const std::string denied = std::string(" (SCHED_FIFO: ") + std::strerror(errno) + ")";
        constexpr int kNice = -11;
        if (askForSlice(kNice))
            granted.policy = "EEVDF slice 100 us, nice -11" + denied;
        else if (askForSlice(0))
            granted.policy = "EEVDF slice 100 us" + denied;
        else
            granted.policy = "normal" + denied;
    }
    granted.memoryLocked = lockMemory();
    granted.pinnedCpu = pinToLastCpu();
    touchStack();
    return granted;
}

long long monotonicNs() noexcept {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

void sleepUntil(long long deadlineNs) noexcept {
    timespec deadline{};
    deadline.tv_sec = static_cast<time_t>(deadlineNs / 1'000'000'000LL);
    deadline.tv_nsec = static_cast<long>(deadlineNs % 1'000'000'000LL);
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr) == EINTR) {
    }
}

} // namespace touchstone
