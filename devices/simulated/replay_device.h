#pragma once

#include "devices/device/device.h"

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace touchstone {

/// A path that somebody recorded or computed: HIP.csv of the command line.
struct HipPath {
    std::vector<double> times;         ///< s, strictly increasing
    std::vector<glm::dvec3> positions; ///< m, one for each time
};

/// Reads a CSV file with a header line that names the columns t, x, y, z (any order, s and m; further columns
/// are ignored) and one line a sample. Throws Error that names file, line and column when it is missing, has
/// no sample, a number that is none or not finite, or times that do not increase.
[[nodiscard]] HipPath readHipPath(const std::filesystem::path& file);
/// The same from a stream; `name` is what errors call it.
[[nodiscard]] HipPath readHipPath(std::istream& in, const std::string& name);

/// Plays a path back, straight between its samples; before the first and after the last the hand rests there.
class ReplayDevice final : public Device {
  public:
    /// `path` has at least one sample. The path starts at its first time: sample(0) is its first position.
    explicit ReplayDevice(HipPath path);

    [[nodiscard]] std::string name() const override { return "replay"; }
    [[nodiscard]] DeviceLimits limits() const override { return {}; }
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    void apply(const DeviceCommand&) noexcept override {}

    [[nodiscard]] double duration() const { return path_.times.back() - path_.times.front(); } ///< s

  private:
    HipPath path_;
};

} // namespace touchstone
