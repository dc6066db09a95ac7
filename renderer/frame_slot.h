#pragma once
// One of the frames in flight. Main thread only, private to renderer/.

#include "renderer/gpu_environment.h"
#include "renderer/gpu_memory.h"
#include "renderer/scene_renderer.h"

#include <array>

namespace touchstone {

/// Everything that the device may still be reading or writing.
struct FrameSlot {
    vk::raii::CommandBuffer commands{nullptr};
    vk::raii::Fence done{nullptr};
    vk::raii::QueryPool timestamps{nullptr};
    GpuBuffer uniforms, overlay;
    vk::raii::DescriptorPool pool{nullptr};
    vk::DescriptorSet frameSet;
    GpuImage color, depth;
    vk::raii::ImageView colorBytes{nullptr}; ///< the colour image without sRGB decoding
    bool timed = false;
};

/// The frames in flight of one picture.
struct FrameRing {
    std::array<FrameSlot, 2> slots;
    size_t next = 0;
    FrameSlot* last = nullptr;
};

/// `layout`: of the set that holds the frame's uniforms and its environment, which setEnvironment sets.
void createSlot(const Gpu::Impl& gpu, vk::DescriptorSetLayout layout, FrameSlot& slot);
/// No frame of this slot may be in flight.
void setEnvironment(const Gpu::Impl& gpu, const GpuEnvironment& environment, FrameSlot& slot);
/// Makes the images anew; waits for the device.
void resizeSlot(const Gpu::Impl& gpu, vk::Extent2D extent, FrameSlot& slot);
/// Waits until the slot's last frame is finished and notes how long that and the frame took.
void waitFor(const Gpu::Impl& gpu, FrameSlot& slot, SceneRenderer::Statistics& statistics);

} // namespace touchstone
