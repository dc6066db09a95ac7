#pragma once
// Runs a program's SPIR-V on a Vulkan device at many places, linked and guarded as for the picture.

#include "haptics/program/executor.h"
#include "renderer/gpu.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace touchstone::program {

/// Outputs by location, and whether there is a result.
struct EyeResult {
    std::array<PortValue, 6> out{};
    bool done = false;
};

/// On lavapipe.
class EyePoints {
  public:
    EyePoints();
    /// `parameters`: parameterBlock's. Throws std::runtime_error where the program cannot be linked.
    [[nodiscard]] std::vector<EyeResult> run(std::span<const uint32_t> program,
                                             std::span<const std::byte> parameters,
                                             std::span<const std::array<PortValue, kMaxLocations>> inputs);

  private:
    std::unique_ptr<Gpu> gpu_;
};

} // namespace touchstone::program
