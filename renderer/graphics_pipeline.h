#pragma once
// Creation of graphics pipelines. Main thread only, private to renderer/.

#include "renderer/gpu_impl.h"

#include <span>
#include <vector>

namespace touchstone {

inline constexpr vk::Format kSceneFormat = vk::Format::eR8G8B8A8Srgb; ///< encoding of the shaders' linear
                                                                      ///< output
inline constexpr vk::Format kSceneByteFormat =
    vk::Format::eR8G8B8A8Unorm; ///< the same bytes, for copies and the window
inline constexpr vk::Format kDepthFormat = vk::Format::eD32Sfloat;
/// Of the light that is kept beside a picture (scene.frag, KEPT).
inline constexpr vk::Format kLightFormat = vk::Format::eR16G16B16A16Sfloat;
inline constexpr uint32_t kLightImages = 3;

/// The variable parts of our pipelines.
struct PipelineRecipe {
    std::span<const uint32_t> vertexCode, fragmentCode;
    std::vector<uint32_t> constants; ///< specialization constants 0, 1, ... of both stages
    std::vector<vk::VertexInputBindingDescription> bindings;
    std::vector<vk::VertexInputAttributeDescription> attributes;
    vk::PrimitiveTopology topology = vk::PrimitiveTopology::eTriangleList;
    vk::PolygonMode fill = vk::PolygonMode::eFill;
    bool depthTest = true, depthWrite = true, blend = false;
    bool twoSources = false; ///< with blend: output color 1 of the fragment shader is the factor of the
                             ///< destination
    bool keepsLight = false; ///< attachments of a kept picture: kLightImages of kLightFormat after the colour
    vk::CompareOp depthCompare = vk::CompareOp::eLessOrEqual;
    vk::PipelineLayout layout;
    vk::RenderPass renderPass; ///< null: dynamic rendering into kSceneFormat and kDepthFormat
};

/// Viewport and scissor, cull mode and front face are dynamic.
[[nodiscard]] vk::raii::Pipeline makePipeline(const Gpu::Impl& gpu, const vk::raii::PipelineCache& cache,
                                              const PipelineRecipe& recipe);

} // namespace touchstone
