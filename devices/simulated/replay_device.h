#pragma once

#include "devices/device/device.h"

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace touchstone {

/// A recorded or computed path: HIP.csv of the command line.
struct HipPath {
    std::vector<double> times;         ///< s, strictly increasing
    std::vector<glm::dvec3> positions; ///< m, one for each time
};

/// Reads a CSV file with a header line that names the columns t, x, y, z (any order, s and m; further columns
/// are ignored) and one sample per line. Throws Error with file, line and column if the file is missing, has
/// no sample, a value that is not a finite number, or times that do not increase.
[[nodiscard]] HipPath readHipPath(const std::filesystem::path& file);
/// The same from a stream; errors call it `name`.
[[nodiscard]] HipPath readHipPath(std::istream& in, const std::string& name);

/// Plays a path with linear interpolation; before the first and after the last sample the hand rests there.
class ReplayDevice final : public Device {
  public:
    /// `path` has at least one sample; sample(0) is its first position.
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
