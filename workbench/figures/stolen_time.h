#pragma once

#include <optional>
#include <string_view>

namespace touchstone {

/// Time that the machine under this one took away (steal in /proc/stat), of all processors together: what no
/// thread of ours could use, however it was scheduled. One thread.
class StolenTime {
  public:
    StolenTime() : start_(now()) {}

    /// s since construction; nothing where the kernel does not tell.
    [[nodiscard]] std::optional<double> seconds() const;

    /// From the text of /proc/stat, in ticks of the kernel's clock.
    [[nodiscard]] static std::optional<unsigned long long> parse(std::string_view stat);

  private:
    [[nodiscard]] static std::optional<double> now();
    std::optional<double> start_;
};

} // namespace touchstone
