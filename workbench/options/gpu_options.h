#pragma once

#include "renderer/gpu.h"

#include <string>

namespace touchstone {

/// Options for a Vulkan device chosen by a part of its name (empty: the best).
[[nodiscard]] inline GpuOptions gpuOptions(const std::string& name) {
    GpuOptions options;
    options.device = name;
    return options;
}

} // namespace touchstone
