#include "renderer/gpu_environment.h"

namespace touchstone {

GpuEnvironment uploadEnvironment(const Gpu::Impl& gpu, std::shared_ptr<const Environment> source) {
    using Layout = vk::ImageLayout;
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    constexpr vk::ImageAspectFlags kColor = vk::ImageAspectFlagBits::eColor;
    GpuEnvironment result;
    const uint32_t side = source ? Environment::kSide : 1, levels = source ? Environment::kLevels : 1;
    result.cube =
        createImage(gpu, {.format = vk::Format::eR16G16B16A16Sfloat,
                          .extent = {side, side},
                          .levels = levels,
                          .usage = vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst,
                          .cube = true});
    runOnce(gpu, [&](const vk::raii::CommandBuffer& commands) {
        transition(commands, *result.cube.image, kColor, Layout::eUndefined, Layout::eTransferDstOptimal,
                   Stage::eNone, Access::eNone, Stage::eCopy, Access::eTransferWrite);
    });
    const std::vector<uint16_t> black(4, 0);
    Uploader uploader(gpu);
    for (uint32_t level = 0; level < levels; ++level) {
        const uint32_t width = side >> level;
        const size_t faceBytes = size_t{8} * width * width;
        for (uint32_t face = 0; face < 6; ++face) {
            const auto texels = std::as_bytes(std::span(source ? source->levels[level] : black));
            uploader.imageRows(result.cube, level, {width, width}, 0,
                               texels.subspan(source ? face * faceBytes : 0, faceBytes), face);
        }
    }
    runOnce(gpu, [&](const vk::raii::CommandBuffer& commands) {
        transition(commands, *result.cube.image, kColor, Layout::eTransferDstOptimal,
                   Layout::eShaderReadOnlyOptimal, Stage::eCopy, Access::eTransferWrite,
                   Stage::eFragmentShader, Access::eShaderSampledRead);
    });
    result.sampler = vk::raii::Sampler(
        gpu.device, vk::SamplerCreateInfo{.magFilter = vk::Filter::eLinear,
                                          .minFilter = vk::Filter::eLinear,
                                          .mipmapMode = vk::SamplerMipmapMode::eLinear,
                                          .addressModeU = vk::SamplerAddressMode::eClampToEdge,
                                          .addressModeV = vk::SamplerAddressMode::eClampToEdge,
                                          .addressModeW = vk::SamplerAddressMode::eClampToEdge,
                                          .maxLod = VK_LOD_CLAMP_NONE});
    result.source = std::move(source);
    return result;
}

} // namespace touchstone
