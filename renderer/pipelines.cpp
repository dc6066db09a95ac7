#include "renderer/pipelines.h"

#include "renderer/overlay_geometry.h"
#include "renderer/shader_code.h"
#include "shaders/shared/scene_types.h"

namespace touchstone {

namespace {

using vk::Format;

vk::raii::DescriptorSetLayout makeSetLayout(const Gpu::Impl& gpu, uint32_t textures,
                                            vk::ShaderStageFlags stages) {
    std::vector<vk::DescriptorSetLayoutBinding> bindings{
        {.binding = 0,
         .descriptorType = vk::DescriptorType::eUniformBuffer,
         .descriptorCount = 1,
         .stageFlags = stages}};
    for (uint32_t i = 1; i <= textures; ++i)
        bindings.push_back({.binding = i,
                            .descriptorType = vk::DescriptorType::eCombinedImageSampler,
                            .descriptorCount = 1,
                            .stageFlags = vk::ShaderStageFlagBits::eFragment});
    return {gpu.device,
            vk::DescriptorSetLayoutCreateInfo{.bindingCount = static_cast<uint32_t>(bindings.size()),
                                              .pBindings = bindings.data()}};
}

vk::raii::PipelineLayout makeLayout(const Gpu::Impl& gpu, std::initializer_list<vk::DescriptorSetLayout> sets,
                                    bool withObject) {
    const vk::PushConstantRange object{
        .stageFlags = vk::ShaderStageFlagBits::eVertex, .offset = 0, .size = sizeof(shared::ObjectConstants)};
    return {gpu.device, vk::PipelineLayoutCreateInfo{.setLayoutCount = static_cast<uint32_t>(sets.size()),
                                                     .pSetLayouts = sets.begin(),
                                                     .pushConstantRangeCount = withObject ? 1u : 0u,
                                                     .pPushConstantRanges = &object}};
}

/// What differs between our pipelines.
struct PipelineRecipe {
    std::span<const uint32_t> vertexCode, fragmentCode;
    std::vector<uint32_t> constants; ///< specialization constants 0, 1, ... of both stages
    std::vector<vk::VertexInputBindingDescription> bindings;
    std::vector<vk::VertexInputAttributeDescription> attributes;
    vk::PrimitiveTopology topology = vk::PrimitiveTopology::eTriangleList;
    bool depthTest = true, depthWrite = true, blend = false;
    vk::CompareOp depthCompare = vk::CompareOp::eLessOrEqual;
    vk::PipelineLayout layout;
};

vk::PipelineColorBlendAttachmentState blendState(bool blend) {
    using Mask = vk::ColorComponentFlagBits;
    // The image stays opaque whatever is blended into it.
    return {.blendEnable = blend,
            .srcColorBlendFactor = vk::BlendFactor::eSrcAlpha,
            .dstColorBlendFactor = vk::BlendFactor::eOneMinusSrcAlpha,
            .colorBlendOp = vk::BlendOp::eAdd,
            .srcAlphaBlendFactor = vk::BlendFactor::eZero,
            .dstAlphaBlendFactor = vk::BlendFactor::eOne,
            .alphaBlendOp = vk::BlendOp::eAdd,
            .colorWriteMask = Mask::eR | Mask::eG | Mask::eB | Mask::eA};
}

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
    const vk::PipelineRasterizationStateCreateInfo rasterization{.lineWidth = 1.0f};
    const vk::PipelineMultisampleStateCreateInfo samples;
    const vk::PipelineDepthStencilStateCreateInfo depth{.depthTestEnable = recipe.depthTest,
                                                        .depthWriteEnable = recipe.depthWrite,
                                                        .depthCompareOp = recipe.depthCompare};
    const vk::PipelineColorBlendAttachmentState attachment = blendState(recipe.blend);
    const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = 1, .pAttachments = &attachment};
    const std::array dynamic{vk::DynamicState::eViewport, vk::DynamicState::eScissor,
                             vk::DynamicState::eCullMode, vk::DynamicState::eFrontFace};
    const vk::PipelineDynamicStateCreateInfo dynamics{.dynamicStateCount = dynamic.size(),
                                                      .pDynamicStates = dynamic.data()};
    const vk::PipelineRenderingCreateInfo rendering{.colorAttachmentCount = 1,
                                                    .pColorAttachmentFormats = &kSceneFormat,
                                                    .depthAttachmentFormat = kDepthFormat};
    return {gpu.device, cache,
            vk::GraphicsPipelineCreateInfo{.pNext = &rendering,
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
                                           .layout = recipe.layout}};
}

void describeSceneVertices(PipelineRecipe& recipe) {
    recipe.bindings = {{0, sizeof(SceneVertex), vk::VertexInputRate::eVertex}};
    recipe.attributes = {{0, 0, Format::eR32G32B32Sfloat, offsetof(SceneVertex, position)},
                         {1, 0, Format::eR32G32B32Sfloat, offsetof(SceneVertex, normal)},
                         {2, 0, Format::eR32G32B32A32Sfloat, offsetof(SceneVertex, tangent)},
                         {3, 0, Format::eR32G32Sfloat, offsetof(SceneVertex, uv0)},
                         {4, 0, Format::eR32G32Sfloat, offsetof(SceneVertex, uv1)},
                         {5, 0, Format::eR16G16B16A16Unorm, offsetof(SceneVertex, color)}};
}

void applyPass(PipelineRecipe& recipe, OverlayPass pass) {
    recipe.constants = {pass == OverlayPass::Hidden ? 1u : 0u};
    recipe.blend = pass != OverlayPass::Opaque;
    recipe.depthWrite = pass == OverlayPass::Opaque;
    if (pass == OverlayPass::Hidden)
        recipe.depthCompare = vk::CompareOp::eGreater;
}

} // namespace

vk::raii::ShaderModule shaderModule(const Gpu::Impl& gpu, std::span<const uint32_t> words) {
    return {gpu.device, vk::ShaderModuleCreateInfo{.codeSize = words.size_bytes(), .pCode = words.data()}};
}

Pipelines::Pipelines(const Gpu::Impl& gpu)
    : gpu_(gpu),
      frameSet_(makeSetLayout(gpu, 0, vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment)),
      materialSet_(makeSetLayout(gpu, shared::kTextureSlots, vk::ShaderStageFlagBits::eFragment)),
      falseColorSet_(makeSetLayout(gpu, 1, vk::ShaderStageFlagBits::eFragment)),
      sceneLayout_(makeLayout(gpu, {*frameSet_, *materialSet_}, true)),
      falseColorLayout_(makeLayout(gpu, {*frameSet_, *falseColorSet_}, true)),
      overlayLayout_(makeLayout(gpu, {*frameSet_}, false)),
      cache_(gpu.device, vk::PipelineCacheCreateInfo{}) {}

template <class Make>
vk::Pipeline Pipelines::cached(const Key& key, Make&& make) {
    auto found = pipelines_.find(key);
    if (found == pipelines_.end()) {
        PipelineRecipe recipe;
        make(recipe);
        found = pipelines_.emplace(key, makePipeline(gpu_, cache_, recipe)).first;
    }
    return *found->second;
}

vk::Pipeline Pipelines::scene(uint32_t features) {
    return cached({Kind::Scene, features, 0}, [&](PipelineRecipe& recipe) {
        recipe.vertexCode = shaders::scene_vert;
        recipe.fragmentCode = shaders::scene_frag;
        recipe.constants = {features};
        describeSceneVertices(recipe);
        recipe.blend = (features & shared::kIsBlended) != 0;
        recipe.depthWrite = !recipe.blend;
        recipe.layout = *sceneLayout_;
    });
}

vk::Pipeline Pipelines::falseColor(uint32_t features, ViewMode mode) {
    const uint32_t view = mode == ViewMode::Normals ? shared::kShowsNormals
                          : mode == ViewMode::Uv    ? shared::kShowsUv
                                                    : shared::kShowsMap;
    // The UV transform stands for the second UV set here: the shader reads both.
    features &= shared::kHasNormalTexture | shared::kHasTangents;
    features |= shared::kHasUvTransform;
    return cached({Kind::FalseColor, features, view}, [&](PipelineRecipe& recipe) {
        recipe.vertexCode = shaders::false_color_vert;
        recipe.fragmentCode = shaders::false_color_frag;
        recipe.constants = {features, view};
        describeSceneVertices(recipe);
        recipe.attributes.pop_back(); // no vertex colours here
        recipe.bindings.push_back({1, sizeof(float), vk::VertexInputRate::eVertex});
        recipe.attributes.push_back({6, 1, Format::eR32Sfloat, 0});
        recipe.layout = *falseColorLayout_;
    });
}

vk::Pipeline Pipelines::background() {
    return cached({Kind::Background, 0, 0}, [&](PipelineRecipe& recipe) {
        recipe.vertexCode = shaders::full_screen_vert;
        recipe.fragmentCode = shaders::background_frag;
        recipe.depthWrite = false;
        recipe.layout = *overlayLayout_;
    });
}

vk::Pipeline Pipelines::shapes(OverlayPass pass) {
    return cached({Kind::Shapes, static_cast<uint32_t>(pass), 0}, [&](PipelineRecipe& recipe) {
        recipe.vertexCode = shaders::overlay_vert;
        recipe.fragmentCode = shaders::overlay_frag;
        recipe.bindings = {{0, sizeof(ShapeVertex), vk::VertexInputRate::eVertex},
                           {1, sizeof(ShapeInstance), vk::VertexInputRate::eInstance}};
        recipe.attributes = {{0, 0, Format::eR32G32B32Sfloat, offsetof(ShapeVertex, position)},
                             {1, 0, Format::eR32G32B32Sfloat, offsetof(ShapeVertex, normal)}};
        for (uint32_t i = 0; i < 4; ++i)
            recipe.attributes.push_back({2 + i, 1, Format::eR32G32B32A32Sfloat, 16 * i});
        applyPass(recipe, pass);
        recipe.layout = *overlayLayout_;
    });
}

vk::Pipeline Pipelines::lines(OverlayPass pass) {
    return cached({Kind::Lines, static_cast<uint32_t>(pass), 0}, [&](PipelineRecipe& recipe) {
        recipe.vertexCode = shaders::overlay_line_vert;
        recipe.fragmentCode = shaders::overlay_line_frag;
        recipe.bindings = {{0, sizeof(LineInstance), vk::VertexInputRate::eInstance}};
        for (uint32_t i = 0; i < 3; ++i)
            recipe.attributes.push_back({i, 0, Format::eR32G32B32A32Sfloat, 16 * i});
        recipe.topology = vk::PrimitiveTopology::eTriangleStrip;
        applyPass(recipe, pass);
        recipe.layout = *overlayLayout_;
    });
}

} // namespace touchstone
