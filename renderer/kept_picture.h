#pragma once
// The picture of what rests, kept between frames. Main thread only, private to renderer/.

#include "renderer/frame_slot.h"
#include "renderer/picture_key.h"
#include "renderer/pipelines.h"
#include "renderer/step_size.h"

#include <array>

namespace touchstone {

/// Images of the resting objects and the background at full resolution: colour, depth and (shaded view) the
/// light that the probe may take away. Drawn in steps: bands of rows, and in each band so many triangles at a
/// time, in the order of a whole drawing, so that the pixels are the same.
class KeptPicture {
  public:
    KeptPicture(const Gpu::Impl& gpu, const Pipelines& pipelines);

    /// Nothing of it is valid from now on; it is to show `key`.
    void restart(const PictureKey& key);
    /// Before the first step: haptic programs are drawn, whose pixels may take a thousand times as long as
    /// others.
    void expectPrograms();
    [[nodiscard]] const PictureKey& key() const { return key_; }
    [[nodiscard]] bool begun() const { return begun_; }
    [[nodiscard]] bool complete() const { return complete_; }
    [[nodiscard]] bool keepsLight() const { return key_.view.mode == ViewMode::Shaded; }
    [[nodiscard]] vk::Extent2D extent() const {
        return {static_cast<uint32_t>(key_.size.x), static_cast<uint32_t>(key_.size.y)};
    }

    /// Whether the last step is finished, so that the next may be recorded; learns how long it took.
    [[nodiscard]] bool idle();
    /// Units of StepSize that the next step may do: triangles, and what else takes as long.
    [[nodiscard]] double stepWork() const { return step_.work(); }

    /// Begins the commands of a step and its rendering, with a viewport. Makes the images where they have
    /// another size, and waits for the device then.
    void beginStep();
    /// Ends them, after so much work. `last`: the picture is complete when the commands are executed.
    void endStep(double work, bool last);

    /// In a frame after the last step: copies colour and depth to its images, which are attachments then.
    void copyTo(const vk::raii::CommandBuffer& commands, const FrameSlot& target) const;
    /// Depth and light, for Pipelines::keptShadow.
    [[nodiscard]] vk::DescriptorSet lightSet() const { return set_; }

    FrameSlot slot; ///< commands, uniforms, colour and depth

    /// Where the next step goes on.
    struct Place {
        int band = 0;
        size_t item = 0;    ///< of the resting objects' draws
        uint32_t index = 0; ///< of the item's indices
    } place;
    static constexpr int kBandPixels = 400'000, kProgramBandPixels = 40'000;
    [[nodiscard]] int bands() const { return (key_.size.y + bandRows() - 1) / bandRows(); }
    [[nodiscard]] int bandRows() const {
        return std::max(1, (programs_ ? kProgramBandPixels : kBandPixels) / std::max(1, key_.size.x));
    }

  private:
    void makeImages();

    const Gpu::Impl& gpu_;
    PictureKey key_;
    StepSize step_;
    double lastWork_ = 0.0; ///< of the last step; 0: its time is known
    bool begun_ = false, complete_ = false, programs_ = false;
    std::array<GpuImage, kLightImages> lights_;
    vk::raii::Sampler sampler_{nullptr};
    vk::raii::DescriptorPool pool_{nullptr};
    vk::DescriptorSet set_;
};

/// With the viewport turned over, for clip space with y up as in the camera (core since Vulkan 1.1), and the
/// scissor on all of it.
void setViewport(const vk::raii::CommandBuffer& commands, vk::Extent2D extent);

} // namespace touchstone
