#include "renderer/pipelines.h"

#include "renderer/graphics_pipeline.h"
#include "renderer/overlay_geometry.h"
#include "renderer/program/link_program.h"
#include "renderer/shader_code.h"
#include "shaders/shared/scene_types.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>

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
        .stageFlags = kObjectStages, .offset = 0, .size = sizeof(shared::ObjectConstants)};
    return {gpu.device, vk::PipelineLayoutCreateInfo{.setLayoutCount = static_cast<uint32_t>(sets.size()),
                                                     .pSetLayouts = sets.begin(),
                                                     .pushConstantRangeCount = withObject ? 1u : 0u,
                                                     .pPushConstantRanges = &object}};
}

vk::raii::DescriptorSetLayout makeKeptSetLayout(const Gpu::Impl& gpu) {
    std::array<vk::DescriptorSetLayoutBinding, 1 + kLightImages> bindings;
    for (uint32_t i = 0; i < bindings.size(); ++i)
        bindings[i] = {.binding = i,
                       .descriptorType = vk::DescriptorType::eCombinedImageSampler,
                       .descriptorCount = 1,
                       .stageFlags = vk::ShaderStageFlagBits::eFragment};
    return {gpu.device,
            vk::DescriptorSetLayoutCreateInfo{.bindingCount = bindings.size(), .pBindings = bindings.data()}};
}

vk::raii::DescriptorSetLayout makeProgramSetLayout(const Gpu::Impl& gpu) {
    constexpr vk::ShaderStageFlags kFragment = vk::ShaderStageFlagBits::eFragment;
    const std::array<vk::DescriptorSetLayoutBinding, 3> bindings{
        {{.binding = 0,
          .descriptorType = vk::DescriptorType::eUniformBuffer,
          .descriptorCount = 1,
          .stageFlags = kFragment},
         {.binding = 1,
          .descriptorType = vk::DescriptorType::eUniformBufferDynamic,
          .descriptorCount = 1,
          .stageFlags = kObjectStages},
         {.binding = 2,
          .descriptorType = vk::DescriptorType::eStorageBuffer,
          .descriptorCount = 1,
          .stageFlags = kFragment}}};
    return {gpu.device,
            vk::DescriptorSetLayoutCreateInfo{.bindingCount = bindings.size(), .pBindings = bindings.data()}};
}

std::vector<vk::VertexInputAttributeDescription> sceneAttributes(uint32_t first) {
    return {{first, 0, Format::eR32G32B32Sfloat, offsetof(SceneVertex, position)},
            {first + 1, 0, Format::eR32G32B32Sfloat, offsetof(SceneVertex, normal)},
            {first + 2, 0, Format::eR32G32B32A32Sfloat, offsetof(SceneVertex, tangent)},
            {first + 3, 0, Format::eR32G32Sfloat, offsetof(SceneVertex, uv0)},
            {first + 4, 0, Format::eR32G32Sfloat, offsetof(SceneVertex, uv1)},
            {first + 5, 0, Format::eR16G16B16A16Unorm, offsetof(SceneVertex, color)}};
}

void describeSceneVertices(PipelineRecipe& recipe) {
    recipe.bindings = {{0, sizeof(SceneVertex), vk::VertexInputRate::eVertex}};
    recipe.attributes = sceneAttributes(0);
}

/// Lines and points: one instance each, of two vertices or one, expanded to a quad by the shader.
void describeStrokes(PipelineRecipe& recipe, bool lines) {
    recipe.vertexCode = lines ? std::span<const uint32_t>(shaders::scene_lines_vert)
                              : std::span<const uint32_t>(shaders::scene_points_vert);
    recipe.topology = vk::PrimitiveTopology::eTriangleStrip;
    recipe.bindings = {
        {0, (lines ? 2u : 1u) * static_cast<uint32_t>(sizeof(SceneVertex)), vk::VertexInputRate::eInstance}};
    recipe.attributes = sceneAttributes(0);
    if (lines)
        for (vk::VertexInputAttributeDescription end : sceneAttributes(6)) {
            end.offset += sizeof(SceneVertex);
            recipe.attributes.push_back(end);
        }
    // No tangents: no shader reads them.
    std::erase_if(recipe.attributes, [](const auto& each) { return each.location % 6 == 2; });
}

void applyPass(PipelineRecipe& recipe, OverlayPass pass) {
    recipe.constants = {pass == OverlayPass::Hidden ? 1u : 0u};
    recipe.blend = pass != OverlayPass::Opaque;
    recipe.depthWrite = pass == OverlayPass::Opaque;
    if (pass == OverlayPass::Hidden)
        recipe.depthCompare = vk::CompareOp::eGreater;
}

} // namespace

Pipelines::Pipelines(const Gpu::Impl& gpu)
    : gpu_(gpu),
      frameSet_(makeSetLayout(gpu, 1, vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment)),
      materialSet_(makeSetLayout(gpu, shared::kTextureSlots, vk::ShaderStageFlagBits::eFragment)),
      falseColorSet_(makeSetLayout(gpu, 1, vk::ShaderStageFlagBits::eFragment)),
      keptSet_(makeKeptSetLayout(gpu)), programSet_(makeProgramSetLayout(gpu)),
      sceneLayout_(makeLayout(gpu, {*frameSet_, *materialSet_}, true)),
      programLayout_(makeLayout(gpu, {*frameSet_, *materialSet_, *programSet_}, true)),
      falseColorLayout_(makeLayout(gpu, {*frameSet_, *falseColorSet_}, true)),
      overlayLayout_(makeLayout(gpu, {*frameSet_}, false)),
      keptLayout_(makeLayout(gpu, {*frameSet_, *keptSet_}, false)),
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

void Pipelines::describeScene(PipelineRecipe& recipe, uint32_t features, bool keepsLight) const {
    const bool points = (features & shared::kIsPoints) != 0;
    recipe.vertexCode = shaders::scene_vert;
    recipe.fragmentCode = shaders::scene_frag;
    recipe.constants = {features};
    describeSceneVertices(recipe);
    recipe.blend = (features & shared::kIsBlended) != 0;
    recipe.depthWrite = !recipe.blend;
    if ((features & (shared::kIsLines | shared::kIsPoints)) != 0)
        describeStrokes(recipe, !points);
    if (points) {
        recipe.fragmentCode = shaders::scene_points_frag;
    } else if ((features & shared::kIsTransmissive) != 0 && gpu_.dualSourceBlending) {
        recipe.fragmentCode = shaders::scene_glass_frag;
        recipe.twoSources = true;
    }
    if (keepsLight) {
        recipe.fragmentCode = points ? std::span<const uint32_t>(shaders::scene_kept_points_frag)
                                     : std::span<const uint32_t>(shaders::scene_kept_frag);
        recipe.keepsLight = true;
    }
    recipe.layout = *sceneLayout_;
}

vk::Pipeline Pipelines::scene(uint32_t features, bool keepsLight) {
    return cached({Kind::Scene, features, keepsLight, 0},
                  [&](PipelineRecipe& recipe) { describeScene(recipe, features, keepsLight); });
}

Pipelines::LinkedShaders& Pipelines::linked(const std::shared_ptr<const SurfaceProgram>& program) {
    const auto [found, added] = programs_.try_emplace(program);
    LinkedShaders& shaders = found->second;
    if (!added)
        return shaders;
    shaders.number = ++programNumbers_;
    constexpr uint32_t kProgramSet = 2;
    for (const bool kept : {false, true}) {
        const std::span<const uint32_t> host =
            kept ? std::span<const uint32_t>(shaders::scene_program_kept_frag)
                 : std::span<const uint32_t>(shaders::scene_program_frag);
        program::LinkedProgram result = program::linkProgram(host, program->spirv, kProgramSet);
        (kept ? shaders.kept : shaders.plain) = std::move(result.words);
        if (!result.problem.empty())
            shaders.problem = result.problem;
    }
    return shaders;
}

vk::Pipeline Pipelines::programmed(uint32_t features, bool keepsLight,
                                   const std::shared_ptr<const SurfaceProgram>& program) {
    if ((features & (shared::kIsLines | shared::kIsPoints | shared::kIsTransmissive)) != 0)
        return {};
    const LinkedShaders& code = linked(program);
    if (!code.problem.empty())
        return {};
    return cached({Kind::Programmed, features, keepsLight, code.number}, [&](PipelineRecipe& recipe) {
        describeScene(recipe, features, keepsLight);
        recipe.vertexCode = shaders::scene_program_vert;
        recipe.fragmentCode = keepsLight ? code.kept : code.plain;
        recipe.layout = *programLayout_;
    });
}

std::string Pipelines::programProblem(const std::shared_ptr<const SurfaceProgram>& program) const {
    const auto found = programs_.find(program);
    return found == programs_.end() ? "" : found->second.problem;
}

void Pipelines::keepPrograms(std::span<const MaterialProgram> programs) {
    std::erase_if(programs_, [&](const auto& each) {
        if (std::ranges::find(programs, each.first, &MaterialProgram::compiled) != programs.end())
            return false;
        std::erase_if(pipelines_, [&](const auto& pipeline) {
            return std::get<0>(pipeline.first) == Kind::Programmed &&
                   std::get<3>(pipeline.first) == each.second.number;
        });
        return true;
    });
}

vk::Pipeline Pipelines::falseColor(uint32_t features, ViewMode mode) {
    const uint32_t view = mode == ViewMode::Normals   ? shared::kShowsNormals
                          : mode == ViewMode::Uv      ? shared::kShowsUv
                          : mode == ViewMode::Tilt    ? shared::kShowsTilt
                          : mode == ViewMode::Effects ? shared::kShowsFlat
                                                      : shared::kShowsMap;
    // The UV transform here implies the second UV set: the shader reads both.
    features &=
        shared::kHasNormalTexture | shared::kHasTangents | shared::kIsClipped; // sufficient for false colour
    features |= shared::kHasUvTransform;
    return cached({Kind::FalseColor, features, view, 0}, [&](PipelineRecipe& recipe) {
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

vk::Pipeline Pipelines::wireframe(bool clipped) {
    return cached({Kind::Wireframe, clipped ? 1u : 0u, 0, 0}, [&](PipelineRecipe& recipe) {
        recipe.vertexCode = shaders::wireframe_vert;
        recipe.fragmentCode = shaders::wireframe_frag;
        recipe.constants = {clipped ? shared::kIsClipped : 0u};
        describeSceneVertices(recipe);
        recipe.fill = vk::PolygonMode::eLine;
        recipe.blend = true;
        recipe.depthWrite = false;
        recipe.layout = *sceneLayout_;
    });
}

vk::Pipeline Pipelines::background(bool keepsLight) {
    return cached({Kind::Background, keepsLight, 0, 0}, [&](PipelineRecipe& recipe) {
        recipe.vertexCode = shaders::full_screen_vert;
        recipe.fragmentCode = shaders::background_frag;
        recipe.depthWrite = false;
        if (keepsLight)
            recipe.fragmentCode = shaders::background_kept_frag;
        recipe.keepsLight = keepsLight;
        recipe.layout = *overlayLayout_;
    });
}

vk::Pipeline Pipelines::keptShadow() {
    return cached({Kind::KeptShadow, 0, 0, 0}, [&](PipelineRecipe& recipe) {
        recipe.vertexCode = shaders::full_screen_vert;
        recipe.fragmentCode = shaders::kept_shadow_frag;
        recipe.depthTest = recipe.depthWrite = false;
        recipe.layout = *keptLayout_;
    });
}

vk::Pipeline Pipelines::shapes(OverlayPass pass) {
    return cached({Kind::Shapes, static_cast<uint32_t>(pass), 0, 0}, [&](PipelineRecipe& recipe) {
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
    return cached({Kind::Lines, static_cast<uint32_t>(pass), 0, 0}, [&](PipelineRecipe& recipe) {
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
