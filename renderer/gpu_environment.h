#pragma once
// An Environment in device memory. Main thread only, private to renderer/.

#include "renderer/environment.h"
#include "renderer/gpu_memory.h"

namespace touchstone {

struct GpuEnvironment {
    std::shared_ptr<const Environment>
        source; ///< null: the cube is one black texel per face, which no shader reads
    GpuImage cube;
    vk::raii::Sampler sampler{nullptr};
};

[[nodiscard]] GpuEnvironment uploadEnvironment(const Gpu::Impl& gpu,
                                               std::shared_ptr<const Environment> source);

} // namespace touchstone
