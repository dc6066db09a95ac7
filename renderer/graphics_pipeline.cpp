#include "renderer/graphics_pipeline.h"

#include <array>

namespace touchstone {

namespace {

vk::raii::ShaderModule shaderModule(const Gpu::Impl& gpu, std::span<const uint32_t> words) {
    return {gpu.device, vk::ShaderModuleCreateInfo{.codeSize = words.size_bytes(), .pCode = words.data()}};
}

vk::PipelineColorBlendAttachmentState blendState(const PipelineRecipe& recipe) {
    using Mask = vk::ColorComponentFlagBits;
    using Factor = vk::BlendFactor;
    // The image's alpha stays opaque under blending.
    return {.blendEnable = recipe.blend,
            .srcColorBlendFactor = recipe.twoSources ? Factor::eOne : Factor::eSrcAlpha,
            .dstColorBlendFactor = recipe.twoSources ? Factor::eSrc1Color : Factor::eOneMinusSrcAlpha,
            .colorBlendOp = vk::BlendOp::eAdd,
            .srcAlphaBlendFactor = vk::BlendFactor::eZero,
            .dstAlphaBlendFactor = vk::BlendFactor::eOne,
            .alphaBlendOp = vk::BlendOp::eAdd,
            .colorWriteMask = Mask::eR | Mask::eG | Mask::eB | Mask::eA};
}

} // namespace

vk::raii::Pipeline makePipeline(const Gpu::Impl& gpu, const vk::raii::PipelineCache& cache,
                                const PipelineRecipe& recipe) {
    const vk::raii::ShaderModule vertex = shaderModule(gpu, recipe.vertexCode);
    const vk::raii::ShaderModule fragment = shaderModule(gpu, recipe.fragmentCode);
    std::vector<vk::SpecializationMapEntry> entries;
    for (uint32_t i = 0; i < recipe.constants.size(); ++i)
        entries.push_back({i, i * 4, 4});
    const vk::SpecializationInfo constants{.mapEntryCount = static_cast<uint32_t>(entries.size()),
                                           .pMapEntries = entries.data(),
                                           .dataSize = recipe.constants.size() * 4,
                                           .pData = recipe.constants.data()};
    const auto stage = [&](vk::ShaderStageFlagBits which, const vk::raii::ShaderModule& code) {
        return vk::PipelineShaderStageCreateInfo{
            .stage = which, .module = *code, .pName = "main", .pSpecializationInfo = &constants};
    };
    const std::array stages{stage(vk::ShaderStageFlagBits::eVertex, vertex),
                            stage(vk::ShaderStageFlagBits::eFragment, fragment)};
    const vk::PipelineVertexInputStateCreateInfo input{
        .vertexBindingDescriptionCount = static_cast<uint32_t>(recipe.bindings.size()),
        .pVertexBindingDescriptions = recipe.bindings.data(),
        .vertexAttributeDescriptionCount = static_cast<uint32_t>(recipe.attributes.size()),
        .pVertexAttributeDescriptions = recipe.attributes.data()};
    const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = recipe.topology};
    const vk::PipelineViewportStateCreateInfo viewport{.viewportCount = 1, .scissorCount = 1};
    const vk::PipelineRasterizationStateCreateInfo rasterization{.polygonMode = recipe.fill,
                                                                 .lineWidth = 1.0f};
    const vk::PipelineMultisampleStateCreateInfo samples;
    const vk::PipelineDepthStencilStateCreateInfo depth{.depthTestEnable = recipe.depthTest,
                                                        .depthWriteEnable = recipe.depthWrite,
                                                        .depthCompareOp = recipe.depthCompare};
    std::array<vk::PipelineColorBlendAttachmentState, 1 + kLightImages> attachments;
    attachments.fill(blendState(recipe)); // not every device has different ones
    std::array<vk::Format, 1 + kLightImages> formats;
    formats.fill(kLightFormat);
    formats[0] = kSceneFormat;
    const uint32_t attachmentCount = recipe.keepsLight ? 1 + kLightImages : 1;
    const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = attachmentCount,
                                                      .pAttachments = attachments.data()};
    const std::array dynamic{vk::DynamicState::eViewport, vk::DynamicState::eScissor,
                             vk::DynamicState::eCullMode, vk::DynamicState::eFrontFace};
    const vk::PipelineDynamicStateCreateInfo dynamics{.dynamicStateCount = dynamic.size(),
                                                      .pDynamicStates = dynamic.data()};
    const vk::PipelineRenderingCreateInfo rendering{.colorAttachmentCount = attachmentCount,
                                                    .pColorAttachmentFormats = formats.data(),
                                                    .depthAttachmentFormat = kDepthFormat};
    return {gpu.device, cache,
            vk::GraphicsPipelineCreateInfo{.pNext = recipe.renderPass ? nullptr : &rendering,
                                           .stageCount = stages.size(),
                                           .pStages = stages.data(),
                                           .pVertexInputState = &input,
                                           .pInputAssemblyState = &assembly,
                                           .pViewportState = &viewport,
                                           .pRasterizationState = &rasterization,
                                           .pMultisampleState = &samples,
                                           .pDepthStencilState = &depth,
                                           .pColorBlendState = &blend,
                                           .pDynamicState = &dynamics,
                                           .layout = recipe.layout,
                                           .renderPass = recipe.renderPass}};
}

} // namespace touchstone
