#pragma once

#include <optional>
#include <string_view>

namespace touchstone {

/// Time taken by the hypervisor (steal in /proc/stat), over all processors: unavailable to our threads
/// whatever their scheduling. One thread.
class StolenTime {
  public:
    StolenTime() : start_(now()) {}

    /// s since construction; nullopt where the kernel does not report it.
    [[nodiscard]] std::optional<double> seconds() const;

    /// From the text of /proc/stat, in kernel clock ticks.
    [[nodiscard]] static std::optional<unsigned long long> parse(std::string_view stat);

  private:
    [[nodiscard]] static std::optional<double> now();
    std::optional<double> start_;
};

} // namespace touchstone
