#include "renderer/gpu_programs.h"

#include "engine/scene/program_frame.h"
#include "renderer/program/link_program.h"
#include "shaders/shared/scene_types.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace touchstone {

namespace {

/// What a program gets where a material does not say it: the hand's depends on the device.
constexpr float kPlainStiffness = 500.0f;

/// Rows of the map of vertices, which are relative to the mesh's centre, into the program's frame.
shared::ProgramObjectUniforms placeOf(const glm::dvec3& centre, const Instance& instance,
                                      const HapticMaterial& haptic) {
    const glm::dmat3 linear = programFromMesh(instance.sceneFromMesh);
    const glm::dvec3 origin = linear * centre;
    glm::dmat3 cofactor;
    for (int column = 0; column < 3; ++column)
        cofactor[column] = glm::cross(linear[(column + 1) % 3], linear[(column + 2) % 3]);
    double largest = 0.0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(cofactor[column][row]));
    const double scale = largest > 0.0 ? (glm::determinant(linear) < 0.0 ? -1.0 : 1.0) / largest : 0.0;
    shared::ProgramObjectUniforms place{};
    for (int row = 0; row < 3; ++row) {
        place.programFromMesh[row] =
            glm::vec4(glm::dvec4(linear[0][row], linear[1][row], linear[2][row], origin[row]));
        place.normalFromMesh[row] = glm::vec4(
            glm::dvec4(cofactor[0][row] * scale, cofactor[1][row] * scale, cofactor[2][row] * scale, 0.0));
    }
    place.material = {haptic.staticFriction.value.value_or(0.0f), haptic.dynamicFriction.value.value_or(0.0f),
                      haptic.stiffness.value.value_or(kPlainStiffness), haptic.damping.value.value_or(0.0f)};
    return place;
}

uint32_t alignedFor(const Gpu::Impl& gpu, size_t size) {
    const auto alignment =
        static_cast<size_t>(std::max<vk::DeviceSize>(gpu.limits.minUniformBufferOffsetAlignment, 16));
    return static_cast<uint32_t>((size + alignment - 1) / alignment * alignment);
}

} // namespace

GpuPrograms::GpuPrograms(const Gpu::Impl& gpu, const Pipelines& pipelines, const Scene& scene,
                         std::span<const glm::dvec3> centres, std::vector<MaterialProgram> programs,
                         GpuPrograms* before)
    : programs_(std::move(programs)), sets_(scene.materials.size()) {
    programs_.resize(scene.materials.size());
    const auto count =
        static_cast<uint32_t>(std::ranges::count_if(programs_, &MaterialProgram::operator bool));
    if (count == 0)
        return;
    placeTexels(gpu, scene, before);
    placeInstances(gpu, scene, centres);
    const std::array sizes{vk::DescriptorPoolSize{vk::DescriptorType::eUniformBuffer, count},
                           vk::DescriptorPoolSize{vk::DescriptorType::eUniformBufferDynamic, count},
                           vk::DescriptorPoolSize{vk::DescriptorType::eStorageBuffer, count}};
    pool_ = {gpu.device, vk::DescriptorPoolCreateInfo{
                             .maxSets = count, .poolSizeCount = sizes.size(), .pPoolSizes = sizes.data()}};
    constexpr size_t kBlock = 16 * kMaxProgramParameters; // parameterBlock's, at most
    const uint32_t block = alignedFor(gpu, kBlock);
    parameters_ = createBuffer(gpu, vk::DeviceSize{block} * count, vk::BufferUsageFlagBits::eUniformBuffer,
                               MemoryUse::Upload);
    std::memset(parameters_.mapped, 0, parameters_.size);
    vk::DeviceSize at = 0;
    for (size_t m = 0; m < programs_.size(); ++m) {
        if (!programs_[m])
            continue;
        const SurfaceProgram& program = *programs_[m].compiled;
        const std::vector<std::byte> values =
            program::parameterBlock(program.spirv, program.source.parameters, programs_[m].values);
        std::copy_n(values.begin(), std::min(values.size(), kBlock), parameters_.mapped + at);
        sets_[m] = makeSet(gpu, pipelines.programSet(), at, kBlock);
        at += block;
    }
}

vk::DescriptorSet GpuPrograms::makeSet(const Gpu::Impl& gpu, vk::DescriptorSetLayout layout,
                                       vk::DeviceSize at, vk::DeviceSize size) const {
    const vk::DescriptorSet set =
        (*gpu.device)
            .allocateDescriptorSets(
                {.descriptorPool = *pool_, .descriptorSetCount = 1, .pSetLayouts = &layout},
                *gpu.device.getDispatcher())
            .front();
    const vk::DescriptorBufferInfo parameters{*parameters_.buffer, at, size};
    const vk::DescriptorBufferInfo texels{*texels_.buffer, 0, texels_.size};
    const vk::DescriptorBufferInfo instances{*instances_.buffer, 0, sizeof(shared::ProgramObjectUniforms)};
    gpu.device.updateDescriptorSets(
        {vk::WriteDescriptorSet{.dstSet = set,
                                .dstBinding = 0,
                                .descriptorCount = 1,
                                .descriptorType = vk::DescriptorType::eUniformBuffer,
                                .pBufferInfo = &parameters},
         vk::WriteDescriptorSet{.dstSet = set,
                                .dstBinding = 1,
                                .descriptorCount = 1,
                                .descriptorType = vk::DescriptorType::eUniformBufferDynamic,
                                .pBufferInfo = &instances},
         vk::WriteDescriptorSet{.dstSet = set,
                                .dstBinding = 2,
                                .descriptorCount = 1,
                                .descriptorType = vk::DescriptorType::eStorageBuffer,
                                .pBufferInfo = &texels}},
        {});
    return set;
}

/// Every texture at its initial value, or as `before` has it.
void GpuPrograms::placeTexels(const Gpu::Impl& gpu, const Scene& scene, GpuPrograms* before) {
    size_t floats = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        const MaterialProgram& program = programs_[static_cast<size_t>(mesh.material)];
        TexelBlock& block = blocks_.emplace_back();
        // As for the hand: a program that does not name the texture has none, and it needs coordinates.
        if (!program || program.texture.width == 0 || mesh.uv0.empty() ||
            program.compiled->text.find("persistent") == std::string::npos)
            continue;
        block = {program.texture, static_cast<uint32_t>(floats)};
        floats += size_t{block.size.width} * block.size.height;
    }
    if (before != nullptr && before->blocks_ == blocks_ && before->texels_.size > 0) {
        texels_ = std::move(before->texels_);
        return;
    }
    texels_ = createBuffer(gpu, std::max<size_t>(floats, 4) * sizeof(float),
                           vk::BufferUsageFlagBits::eStorageBuffer, MemoryUse::Upload);
    float* const all = reinterpret_cast<float*>(texels_.mapped);
    for (const TexelBlock& block : blocks_)
        std::fill_n(all + block.first, size_t{block.size.width} * block.size.height, block.size.initial);
}

bool GpuPrograms::setTexels(const PersistentTexels& texels) {
    const auto instance = static_cast<size_t>(texels.instance);
    if (instance >= blocks_.size())
        return false;
    const TexelBlock& block = blocks_[instance];
    if (block.size.width != texels.textureWidth || block.size.height != texels.textureHeight ||
        texels.x + texels.width > block.size.width || texels.y + texels.height > block.size.height)
        return false;
    for (uint32_t row = 0; row < texels.height; ++row)
        std::memcpy(texels_.mapped +
                        sizeof(float) * (block.first + size_t{texels.y + row} * block.size.width + texels.x),
                    texels.values + size_t{row} * texels.textureWidth, sizeof(float) * texels.width);
    return true;
}

void GpuPrograms::placeInstances(const Gpu::Impl& gpu, const Scene& scene,
                                 std::span<const glm::dvec3> centres) {
    stride_ = alignedFor(gpu, sizeof(shared::ProgramObjectUniforms));
    instances_ = createBuffer(gpu, vk::DeviceSize{stride_} * scene.instances.size(),
                              vk::BufferUsageFlagBits::eUniformBuffer, MemoryUse::Upload);
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const auto mesh = static_cast<size_t>(scene.instances[i].mesh);
        const auto material = static_cast<size_t>(scene.meshes[mesh].material);
        shared::ProgramObjectUniforms place =
            placeOf(centres[mesh], scene.instances[i], scene.materials[material].haptic);
        const PersistentTextureSize &size = blocks_[i].size, &declared = programs_[material].texture;
        place.texels = {size.width, size.height, blocks_[i].first, 0};
        place.persistent.x = declared.width > 0 ? declared.initial : 1.0f;
        std::memcpy(instances_.mapped + i * stride_, &place, sizeof place);
    }
}

std::vector<MaterialProgram> programsOf(const Scene& scene) {
    std::vector<MaterialProgram> programs;
    for (const Material& material : scene.materials)
        programs.push_back(material.haptic.program);
    return programs;
}

} // namespace touchstone
