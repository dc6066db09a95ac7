#include "renderer/gui_pictures.h"

#include "renderer/window_device.h"

#include <imgui.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace touchstone {

namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
using Layout = vk::ImageLayout;

constexpr int kWidth = WindowTarget::kPictureWidth, kHeight = WindowTarget::kPictureHeight;

} // namespace

void GuiPictures::takeDevice(WindowDevice& device) {
    device_ = &device;
    for (Place& place : places_)
        place.uploaded = false;
}

void GuiPictures::leaveDevice() {
    set_ = nullptr; // freed with the pool
    image_ = {};
    staging_ = {};
    device_ = nullptr;
    shown_.clear();
}

void GuiPictures::set(size_t place, const PixelData& pixels) {
    if (pixels.width != kWidth || pixels.height != kHeight || pixels.channels != 4 ||
        pixels.type != ComponentType::U8)
        throw std::invalid_argument("a picture of another size");
    places_.at(place) = {pixels.bytes, false};
}

void GuiPictures::show(size_t place, const glm::vec2& from, const glm::vec2& to) {
    if (places_.at(place).bytes.empty())
        return;
    shown_.push_back({this, place, from, to});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddCallback(&GuiPictures::drawCommand, &shown_.back());
    list.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
}

/// At first use; windows without pictures do not need it.
void GuiPictures::createImage() {
    const Gpu::Impl& gpu = device_->gpu();
    image_ = touchstone::createImage(
        gpu, {.extent = {static_cast<uint32_t>(kColumns) * kWidth, static_cast<uint32_t>(kRows) * kHeight},
              .usage = vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst});
    staging_ = createBuffer(gpu, vk::DeviceSize{4} * kWidth * kHeight, vk::BufferUsageFlagBits::eTransferSrc,
                            MemoryUse::Upload);
    runOnce(gpu, [&](const vk::raii::CommandBuffer& commands) {
        transition(commands, *image_.image, vk::ImageAspectFlagBits::eColor, Layout::eUndefined,
                   Layout::eShaderReadOnlyOptimal, Stage::eNone, Access::eNone, Stage::eFragmentShader,
                   Access::eShaderSampledRead);
    });
    set_ = device_->makeSet(*image_.view);
}

void GuiPictures::upload() {
    for (const Shown& shown : shown_) {
        Place& place = places_[shown.place];
        if (place.uploaded)
            continue;
        if (!set_)
            createImage();
        place.uploaded = true;
        std::memcpy(staging_.mapped, place.bytes.data(), place.bytes.size());
        const vk::Offset3D offset{static_cast<int32_t>(shown.place % kColumns) * kWidth,
                                  static_cast<int32_t>(shown.place / kColumns) * kHeight, 0};
        runOnce(device_->gpu(), [&](const vk::raii::CommandBuffer& commands) {
            const vk::ImageAspectFlags color = vk::ImageAspectFlagBits::eColor;
            transition(commands, *image_.image, color, Layout::eShaderReadOnlyOptimal,
                       Layout::eTransferDstOptimal, Stage::eFragmentShader, Access::eShaderSampledRead,
                       Stage::eCopy, Access::eTransferWrite);
            commands.copyBufferToImage(*staging_.buffer, *image_.image, Layout::eTransferDstOptimal,
                                       vk::BufferImageCopy{.imageSubresource = {color, 0, 0, 1},
                                                           .imageOffset = offset,
                                                           .imageExtent = {kWidth, kHeight, 1}});
            transition(commands, *image_.image, color, Layout::eTransferDstOptimal,
                       Layout::eShaderReadOnlyOptimal, Stage::eCopy, Access::eTransferWrite,
                       Stage::eFragmentShader, Access::eShaderSampledRead);
        });
    }
}

void GuiPictures::drawCommand(const ImDrawList*, const ImDrawCmd* command) {
    const Shown& shown = *static_cast<const Shown*>(command->UserCallbackData);
    shown.pictures->draw(shown, *command);
}

/// The whole image is scaled so that the slot fills its rectangle; the rest is clipped. When magnified, a
/// border of less than half a texel is cut off, which the filter would mix with the neighbour: the outermost
/// pixels then show the centres of the outermost texels.
void GuiPictures::draw(const Shown& shown, const ImDrawCmd& command) const {
    const ImDrawData& data = *ImGui::GetDrawData();
    const auto pixels = [&](const glm::vec2& at) {
        return (at - glm::vec2(data.DisplayPos.x, data.DisplayPos.y)) *
               glm::vec2(data.FramebufferScale.x, data.FramebufferScale.y);
    };
    const glm::vec2 from = pixels(shown.from), to = pixels(shown.to);
    const glm::vec2 clipFrom = glm::max(from, pixels({command.ClipRect.x, command.ClipRect.y})),
                    clipTo = glm::min(to, pixels({command.ClipRect.z, command.ClipRect.w}));
    if (!(clipTo.x > clipFrom.x && clipTo.y > clipFrom.y))
        return;
    const glm::vec2 texels(kWidth, kHeight);
    const glm::vec2 rim = glm::max(glm::vec2(0.0f), 0.5f - 0.5f * texels / (to - from)); // texels
    const glm::vec2 texel = (to - from) / (texels - 2.0f * rim);                         // pixels each
    const glm::vec2 corner = from - texel * (glm::vec2(static_cast<float>(shown.place % kColumns * kWidth),
                                                       static_cast<float>(shown.place / kColumns * kHeight)) +
                                             rim);
    const auto rounded = [](float x) { return static_cast<int>(x + 0.5f); };
    device_->drawImage(set_,
                       {.x = corner.x,
                        .y = corner.y,
                        .width = texel.x * static_cast<float>(kColumns * kWidth),
                        .height = texel.y * static_cast<float>(kRows * kHeight),
                        .maxDepth = 1.0f},
                       {.x = rounded(clipFrom.x),
                        .y = rounded(clipFrom.y),
                        .width = rounded(clipTo.x) - rounded(clipFrom.x),
                        .height = rounded(clipTo.y) - rounded(clipFrom.y)});
}

} // namespace touchstone
