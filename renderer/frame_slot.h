#pragma once
// One of the frames in flight. Main thread only, private to renderer/.

#include "renderer/gpu_environment.h"
#include "renderer/gpu_memory.h"
#include "renderer/scene_renderer.h"

#include <array>

namespace touchstone {

/// Resources that the device may still be using.
struct FrameSlot {
    vk::raii::CommandBuffer commands{nullptr};
    vk::raii::Fence done{nullptr};
    vk::raii::QueryPool timestamps{nullptr};
    GpuBuffer uniforms, overlay, deformed;
    vk::raii::DescriptorPool pool{nullptr};
    vk::DescriptorSet frameSet;
    GpuImage color, depth;
    vk::raii::ImageView colorBytes{nullptr}; ///< the colour image without sRGB decoding
    bool timed = false;
};

/// Frames in flight.
struct FrameRing {
    std::array<FrameSlot, 2> slots;
    size_t next = 0;
};

/// `layout`: of the descriptor set for the frame's uniforms and its environment, which setEnvironment sets.
void createSlot(const Gpu::Impl& gpu, vk::DescriptorSetLayout layout, FrameSlot& slot);
/// No frame of this slot may be in flight.
void setEnvironment(const Gpu::Impl& gpu, const GpuEnvironment& environment, FrameSlot& slot);
/// Recreates the images; waits for the device.
void resizeSlot(const Gpu::Impl& gpu, vk::Extent2D extent, FrameSlot& slot);
/// Begins the slot's commands, and its time.
void beginCommands(FrameSlot& slot);
/// Waits until the slot's last frame is finished and records the times of waiting and of the frame.
void waitFor(const Gpu::Impl& gpu, FrameSlot& slot, SceneRenderer::Statistics& statistics);

} // namespace touchstone
