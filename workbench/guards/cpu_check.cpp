// Compiled for any x86-64 and run before all other static initialisers: the rest is built for x86-64-v3 and
// would crash with an illegal instruction before it could report the reason.

#include <unistd.h>

namespace {

[[gnu::constructor(101)]] void requireCpu() {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
        return;
    constexpr char kMessage[] =
        "touchstone: this CPU lacks AVX2, FMA or BMI2, which the haptic loop is built for (x86-64-v3)\n"
        "  remedy: run it on an Intel CPU from 2013 (Haswell) or an AMD CPU from 2015 (Excavator) on; in a\n"
        "  virtual machine, pass the host's CPU through\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
    _exit(1);
}

} // namespace
