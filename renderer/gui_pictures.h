#pragma once
// Small pictures in Dear ImGui's windows. Main thread only, private to renderer/.

#include "renderer/gpu_memory.h"
#include "renderer/window_target.h"

#include <array>
#include <deque>

struct ImDrawCmd;
struct ImDrawList;

namespace touchstone {

class WindowDevice;

/// Dear ImGui 1.86 draws with one texture, its font. So these pictures are drawn from a callback within its
/// draw list, by the pipeline for scene images. All of them are slots of one image, which bounds their
/// memory. The pixels are also kept here for upload to the next device.
class GuiPictures {
  public:
    void takeDevice(WindowDevice& device);
    /// The device is idle or lost.
    void leaveDevice();

    void set(size_t place, const PixelData& pixels);
    /// Into the current ImGui window, corners in its coordinates.
    void show(size_t place, const glm::vec2& from, const glm::vec2& to);
    /// Before the frame is recorded.
    void upload();
    /// The frame's list has been drawn.
    void forgetShown() { shown_.clear(); }

  private:
    static constexpr size_t kColumns = 8, kRows = WindowTarget::kPictures / kColumns;
    static_assert(kColumns * kRows == WindowTarget::kPictures);

    struct Shown {
        GuiPictures* pictures;
        size_t place;
        glm::vec2 from, to;
    };
    struct Place {
        std::vector<std::byte> bytes; ///< RGBA; empty: not set
        bool uploaded = false;
    };

    static void drawCommand(const ImDrawList* list, const ImDrawCmd* command);
    void draw(const Shown& shown, const ImDrawCmd& command) const;
    void createImage();

    std::array<Place, WindowTarget::kPictures> places_;
    std::deque<Shown> shown_; // in this frame; ImGui's draw list points to them
    WindowDevice* device_ = nullptr;
    GpuImage image_;
    GpuBuffer staging_;
    vk::DescriptorSet set_;
};

} // namespace touchstone
