#include "renderer/gpu_scene.h"

#include "renderer/false_color.h"
#include "renderer/haptic_quantity.h"
#include "renderer/material_features.h"
#include "shaders/shared/scene_types.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace touchstone {

namespace {

constexpr size_t kSlice = 2u << 20; ///< bytes copied in one step

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

vk::DeviceSize alignedTo(vk::DeviceSize size, vk::DeviceSize alignment) {
    return (size + alignment - 1) / alignment * alignment;
}

/// The affine map of TextureRef::transform, from its images of three points.
void setUv(const TextureRef& reference, glm::vec4& linear, glm::vec4& offset) {
    const glm::vec2 origin = reference.transform(glm::vec2(0.0f));
    const glm::vec2 u = reference.transform(glm::vec2(1.0f, 0.0f)) - origin;
    const glm::vec2 v = reference.transform(glm::vec2(0.0f, 1.0f)) - origin;
    linear = {u.x, v.x, u.y, v.y};
    offset = {origin.x, origin.y, static_cast<float>(reference.texCoord), 0.0f};
}

vk::raii::DescriptorPool makePool(const Gpu::Impl& gpu, size_t sets, size_t texturesEach) {
    const auto count = static_cast<uint32_t>(sets);
    const std::array sizes{vk::DescriptorPoolSize{vk::DescriptorType::eUniformBuffer, count},
                           vk::DescriptorPoolSize{vk::DescriptorType::eCombinedImageSampler,
                                                  count * static_cast<uint32_t>(texturesEach)}};
    return {gpu.device, vk::DescriptorPoolCreateInfo{
                            .maxSets = count, .poolSizeCount = sizes.size(), .pPoolSizes = sizes.data()}};
}

/// `count` sets of one layout; valid as long as the pool.
std::vector<vk::DescriptorSet> allocateSets(const Gpu::Impl& gpu, const vk::raii::DescriptorPool& pool,
                                            vk::DescriptorSetLayout layout, size_t count) {
    const std::vector<vk::DescriptorSetLayout> layouts(count, layout);
    return (*gpu.device)
        .allocateDescriptorSets(
            vk::DescriptorSetAllocateInfo{.descriptorPool = *pool,
                                          .descriptorSetCount = static_cast<uint32_t>(count),
                                          .pSetLayouts = layouts.data()},
            *gpu.device.getDispatcher());
}

void writeSet(const Gpu::Impl& gpu, vk::DescriptorSet set, const vk::DescriptorBufferInfo& uniforms,
              const std::vector<vk::DescriptorImageInfo>& images) {
    std::vector<vk::WriteDescriptorSet> writes{{.dstSet = set,
                                                .dstBinding = 0,
                                                .descriptorCount = 1,
                                                .descriptorType = vk::DescriptorType::eUniformBuffer,
                                                .pBufferInfo = &uniforms}};
    for (uint32_t i = 0; i < images.size(); ++i)
        writes.push_back({.dstSet = set,
                          .dstBinding = i + 1,
                          .descriptorCount = 1,
                          .descriptorType = vk::DescriptorType::eCombinedImageSampler,
                          .pImageInfo = &images[i]});
    gpu.device.updateDescriptorSets(writes, {});
}

vk::Format formatOf(TexelFormat format) {
    switch (format) {
    case TexelFormat::Srgb8:
        return vk::Format::eR8G8B8A8Srgb;
    case TexelFormat::Half16:
        return vk::Format::eR16G16B16A16Sfloat;
    case TexelFormat::Unorm8:
        break;
    }
    return vk::Format::eR8G8B8A8Unorm;
}

vk::SamplerAddressMode addressMode(Wrap wrap) {
    switch (wrap) {
    case Wrap::MirroredRepeat:
        return vk::SamplerAddressMode::eMirroredRepeat;
    case Wrap::ClampToEdge:
        return vk::SamplerAddressMode::eClampToEdge;
    case Wrap::Repeat:
        break;
    }
    return vk::SamplerAddressMode::eRepeat;
}

} // namespace

GpuScene::GpuScene(const Gpu::Impl& gpu, const Pipelines& pipelines,
                   std::shared_ptr<const PreparedScene> prepared)
    : gpu_(gpu), pipelines_(pipelines), scene_(prepared->scene), prepared_(std::move(prepared)),
      uploader_(gpu) {
    planMeshes();
    for (const auto& [key, levels] : prepared_->textures)
        planTexture(levels, textures_[key]);
    steps_.push_back([this] {
        uploadMaterials();
        setPrograms(programsOf(*scene_));
    });
    deviceBytes_ += vertices_.size + indices_.size;
}

bool GpuScene::uploadNext() {
    if (!steps_.empty()) {
        steps_.front()();
        steps_.pop_front();
    }
    if (steps_.empty())
        prepared_.reset();
    return steps_.empty();
}

void GpuScene::planMeshes() {
    for (size_t m = 0; m < scene_->meshes.size(); ++m) {
        const Mesh& mesh = scene_->meshes[m];
        const Material& material = scene_->materials[static_cast<size_t>(mesh.material)];
        meshes_.push_back({prepared_->meshes[m], drawFeatures(*scene_, mesh, material)});
    }
    using Usage = vk::BufferUsageFlagBits;
    const auto vertices = bytesOf(prepared_->vertices), indices = bytesOf(prepared_->indices);
    vertices_ =
        createBuffer(gpu_, vertices.size(), Usage::eVertexBuffer | Usage::eTransferDst, MemoryUse::Device);
    indices_ =
        createBuffer(gpu_, indices.size(), Usage::eIndexBuffer | Usage::eTransferDst, MemoryUse::Device);
    const auto plan = [this](const GpuBuffer& target, std::span<const std::byte> bytes) {
        for (size_t at = 0; at < bytes.size(); at += kSlice)
            steps_.push_back(
                [this, &target, at, part = bytes.subspan(at, std::min(kSlice, bytes.size() - at))] {
                    uploader_.buffer(target, at, part);
                });
    };
    plan(vertices_, vertices);
    plan(indices_, indices);
}

void GpuScene::reshape(int index, const ReshapedMesh& reshaped) {
    DrawnMesh& drawn = meshes_[static_cast<size_t>(index)];
    Reshaped& own = reshaped_[index];
    own.current = (own.current + 1) % kGenerations;
    Reshaped::Buffers& buffers = own.buffers[own.current];
    using Usage = vk::BufferUsageFlagBits;
    // Some room, so that a mesh that grows does not need another buffer each time.
    const auto fill = [&](GpuBuffer& buffer, std::span<const std::byte> bytes, Usage usage) {
        if (buffer.size < bytes.size())
            buffer = createBuffer(gpu_, bytes.size() + bytes.size() / 4, usage, MemoryUse::Upload);
        std::ranges::copy(bytes, buffer.mapped);
    };
    fill(buffers.vertices, bytesOf(reshaped.vertices), Usage::eVertexBuffer);
    fill(buffers.indices, bytesOf(reshaped.indices), Usage::eIndexBuffer);
    // What a false-colour view shows of the mesh's vertices is not known here: not stated, grey.
    const std::vector<float> scalars(reshaped.vertices.size(), -1.0f);
    fill(buffers.scalars, bytesOf(scalars), Usage::eVertexBuffer);
    if (reshaped.hasColors)
        drawn.features |= shared::kHasVertexColor;
    PreparedMesh& mesh = drawn.mesh;
    mesh.firstVertex = 0;
    mesh.centre = reshaped.centre;
    mesh.halfSize = reshaped.halfSize;
    mesh.radius = reshaped.radius;
    mesh.levels = {{0, static_cast<uint32_t>(reshaped.indices.size()), 0.0, reshaped.meanEdge}};
}

bool GpuScene::bindReshaped(const vk::raii::CommandBuffer& commands, int index, ViewMode mode) const {
    const auto found = reshaped_.find(index);
    if (found == reshaped_.end())
        return false;
    const Reshaped::Buffers& buffers = found->second.buffers[found->second.current];
    commands.bindIndexBuffer(*buffers.indices.buffer, 0, vk::IndexType::eUint32);
    commands.bindVertexBuffers(0, *buffers.vertices.buffer, vk::DeviceSize{0});
    if (mode != ViewMode::Shaded)
        commands.bindVertexBuffers(1, *buffers.scalars.buffer, vk::DeviceSize{0});
    return true;
}

void GpuScene::uploadMaterials() {
    using namespace shared;
    const size_t count = scene_->materials.size();
    const vk::DeviceSize stride =
        alignedTo(sizeof(MaterialUniforms), gpu_.limits.minUniformBufferOffsetAlignment);
    materialUniforms_ =
        createBuffer(gpu_, stride * count, vk::BufferUsageFlagBits::eUniformBuffer, MemoryUse::Upload);
    pool_ = makePool(gpu_, std::max<size_t>(count, 1), kTextureSlots);
    materialSets_ = allocateSets(gpu_, pool_, pipelines_.materialSet(), count);
    for (size_t m = 0; m < count; ++m) {
        const Material& material = scene_->materials[m];
        const auto references = material.lookTextures();
        MaterialUniforms uniforms = materialUniforms(material);
        std::vector<vk::DescriptorImageInfo> images;
        for (size_t slot = 0; slot < kTextureSlots; ++slot) {
            const Neutral neutral = slot == kBaseColorSlot ? Neutral::Grey
                                    : slot == kNormalSlot  ? Neutral::FlatNormal
                                                           : Neutral::White;
            setUv(*references[slot], uniforms.uvLinear[slot], uniforms.uvOffset[slot]);
            images.push_back({sampler(*references[slot]),
                              texture(*references[slot], kSlotRoles[slot], neutral),
                              vk::ImageLayout::eShaderReadOnlyOptimal});
        }
        std::memcpy(materialUniforms_.mapped + m * stride, &uniforms, sizeof uniforms);
        writeSet(gpu_, materialSets_[m], {*materialUniforms_.buffer, m * stride, sizeof uniforms}, images);
    }
}

void GpuScene::setPrograms(std::vector<MaterialProgram> programs) {
    std::vector<glm::dvec3> centres;
    for (const DrawnMesh& drawn : meshes_)
        centres.push_back(drawn.mesh.centre);
    GpuPrograms made(gpu_, pipelines_, *scene_, centres, std::move(programs),
                     programs_ ? &*programs_ : nullptr);
    programs_ = std::move(made);
}

void GpuScene::planTexture(const TextureLevels& levels, GpuImage& image) {
    const auto extentOf = [](const TextureLevels::Level& level) {
        return vk::Extent2D{static_cast<uint32_t>(level.width), static_cast<uint32_t>(level.height)};
    };
    const auto largest = static_cast<int>(gpu_.limits.maxImageDimension2D);
    size_t first = 0;
    while (first + 1 < levels.levels.size() &&
           std::max(levels.levels[first].width, levels.levels[first].height) > largest)
        ++first;
    using Layout = vk::ImageLayout;
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    constexpr vk::ImageAspectFlags kColor = vk::ImageAspectFlagBits::eColor;
    steps_.push_back([this, &levels, &image, first, extentOf] {
        image = createImage(
            gpu_, {.format = formatOf(levels.format),
                   .extent = extentOf(levels.levels[first]),
                   .levels = static_cast<uint32_t>(levels.levels.size() - first),
                   .usage = vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst});
        deviceBytes_ += image.size;
        runOnce(gpu_, [&](const vk::raii::CommandBuffer& commands) {
            transition(commands, *image.image, kColor, Layout::eUndefined, Layout::eTransferDstOptimal,
                       Stage::eNone, Access::eNone, Stage::eCopy, Access::eTransferWrite);
        });
    });
    for (size_t i = first; i < levels.levels.size(); ++i) {
        const TextureLevels::Level& level = levels.levels[i];
        const size_t rowBytes = static_cast<size_t>(level.width) * bytesPerTexel(levels.format);
        const auto rowsAtOnce = static_cast<uint32_t>(std::max<size_t>(1, kSlice / rowBytes));
        for (uint32_t row = 0; row < static_cast<uint32_t>(level.height); row += rowsAtOnce) {
            const uint32_t rows = std::min(rowsAtOnce, static_cast<uint32_t>(level.height) - row);
            steps_.push_back(
                [this, &image, to = static_cast<uint32_t>(i - first), extent = extentOf(level), row, rows,
                 part = std::span(levels.bytes).subspan(level.offset + row * rowBytes, rows * rowBytes)] {
                    uploader_.imageRows(image, to, {extent.width, rows}, row, part);
                });
        }
    }
    steps_.push_back([this, &image] {
        runOnce(gpu_, [&](const vk::raii::CommandBuffer& commands) {
            transition(commands, *image.image, kColor, Layout::eTransferDstOptimal,
                       Layout::eShaderReadOnlyOptimal, Stage::eCopy, Access::eTransferWrite,
                       Stage::eFragmentShader, Access::eShaderSampledRead);
        });
    });
}

void GpuScene::uploadNow(const TextureLevels& levels, GpuImage& image) {
    // At the end of the plan, or within a step: the steps already queued wait.
    std::deque<std::function<void()>> later = std::exchange(steps_, {});
    planTexture(levels, image);
    for (const std::function<void()>& step : steps_)
        step();
    steps_ = std::move(later);
}

vk::ImageView GpuScene::texture(const TextureRef& reference, TextureRole role, Neutral neutral) {
    if (!usableTexture(*scene_, reference))
        return neutralTexture(neutral);
    const auto [entry, fresh] = textures_.try_emplace({reference.image, role});
    if (fresh)
        uploadNow(buildTextureLevels(scene_->images[static_cast<size_t>(reference.image)].pixels, role,
                                     static_cast<int>(gpu_.limits.maxImageDimension2D)),
                  entry->second);
    return *entry->second.view;
}

vk::ImageView GpuScene::neutralTexture(Neutral neutral) {
    const auto [entry, fresh] = neutrals_.try_emplace(neutral);
    if (fresh) {
        // Grey is 0.5 in sRGB, FlatNormal is +z, 127.5 rounded up.
        const std::array<std::array<int, 4>, 4> texels{
            {{255, 255, 255, 255}, {128, 128, 128, 255}, {0, 0, 0, 255}, {128, 128, 255, 255}}};
        TextureLevels levels;
        levels.format = neutral == Neutral::Grey ? TexelFormat::Srgb8 : TexelFormat::Unorm8;
        levels.levels = {{1, 1, 0}};
        for (const int c : texels[static_cast<size_t>(neutral)])
            levels.bytes.push_back(static_cast<std::byte>(c));
        uploadNow(levels, entry->second);
    }
    return *entry->second.view;
}

vk::Sampler GpuScene::sampler(const TextureRef& reference) {
    const std::tuple key{reference.wrapS, reference.wrapT, reference.nearest};
    auto found = samplers_.find(key);
    if (found == samplers_.end()) {
        // Trilinear filtering doubles the texels read; a software device uses the nearest level.
        const vk::SamplerCreateInfo info{
            .magFilter = reference.nearest ? vk::Filter::eNearest : vk::Filter::eLinear,
            .minFilter = vk::Filter::eLinear,
            .mipmapMode = gpu_.software ? vk::SamplerMipmapMode::eNearest : vk::SamplerMipmapMode::eLinear,
            .addressModeU = addressMode(reference.wrapS),
            .addressModeV = addressMode(reference.wrapT),
            .maxLod = VK_LOD_CLAMP_NONE};
        found = samplers_.emplace(key, vk::raii::Sampler(gpu_.device, info)).first;
    }
    return *found->second;
}

void GpuScene::uploadScalars(FalseColor& target) {
    size_t vertexCount = 0;
    for (const Mesh& mesh : scene_->meshes)
        vertexCount += mesh.positions.size();
    target.scalars = createBuffer(
        gpu_, vertexCount * sizeof(float),
        vk::BufferUsageFlagBits::eVertexBuffer | vk::BufferUsageFlagBits::eTransferDst, MemoryUse::Device);
    for (size_t m = 0; m < scene_->meshes.size(); ++m) {
        const Mesh& mesh = scene_->meshes[m];
        if (mesh.indices.empty())
            continue; // lines and points: no haptics, not shown here
        const vk::DeviceSize place = static_cast<vk::DeviceSize>(meshes_[m].mesh.firstVertex) * sizeof(float);
        if (target.mode == ViewMode::Dihedral || target.mode == ViewMode::Perception) {
            uploader_.buffer(
                target.scalars, place,
                bytesOf(target.mode == ViewMode::Dihedral ? dihedralAngles(mesh) : feltSteps(mesh)));
            continue;
        }
        // A negative scalar is drawn grey: the quantity is not stated. So heights, which may be negative,
        // count from the lowest one.
        const Material& material = scene_->materials[static_cast<size_t>(mesh.material)];
        if (const std::vector<float>* values = vertexValues(mesh, material, target.mode)) {
            std::vector<float> shown = *values;
            if (target.mode == ViewMode::Height)
                for (float& height : shown)
                    height = std::max(0.0f, height - static_cast<float>(target.scale.low));
            uploader_.buffer(target.scalars, place, bytesOf(shown));
            continue;
        }
        const std::vector<float> same(mesh.positions.size(),
                                      hapticQuantity(material, target.mode).base.value_or(-1.0f));
        uploader_.buffer(target.scalars, place, bytesOf(same));
    }
}

void GpuScene::prepareFalseColor(ViewMode mode, const std::vector<glm::vec3>& materialColors) {
    if (falseColorReady(mode))
        return;
    FalseColor fresh;
    fresh.mode = mode;
    fresh.scale = falseColorScale(*scene_, mode);
    uploadScalars(fresh);
    const size_t count = scene_->materials.size();
    const vk::DeviceSize stride =
        alignedTo(sizeof(shared::FalseColorUniforms), gpu_.limits.minUniformBufferOffsetAlignment);
    fresh.uniforms =
        createBuffer(gpu_, stride * count, vk::BufferUsageFlagBits::eUniformBuffer, MemoryUse::Upload);
    fresh.pool = makePool(gpu_, std::max<size_t>(count, 1), 1);
    fresh.sets = allocateSets(gpu_, fresh.pool, pipelines_.falseColorSet(), count);
    const FalseColorScale& scale = fresh.scale;
    const double range = scale.high - scale.low;
    for (size_t m = 0; m < count; ++m) {
        const Material& material = scene_->materials[m];
        const HapticQuantity quantity = hapticQuantity(material, mode);
        const TextureRef reference = mode == ViewMode::Normals ? material.normalTexture : quantity.texture;
        shared::FalseColorUniforms uniforms{};
        uniforms.map = {quantity.offset, quantity.gain, static_cast<float>(1.0 / range),
                        static_cast<float>(-scale.low / range)};
        if (mode == ViewMode::Height && !quantity.base)
            uniforms.map.w = 0.0f; // of vertices, which count from the lowest height
        if (mode == ViewMode::Normals)
            uniforms.map.x = material.normalScale;
        if (mode == ViewMode::Effects)
            uniforms.map = glm::vec4(m < materialColors.size() ? materialColors[m] : glm::vec3(0.5f), 1.0f);
        setUv(reference, uniforms.uvLinear, uniforms.uvOffset);
        std::memcpy(fresh.uniforms.mapped + m * stride, &uniforms, sizeof uniforms);
        const bool normals = mode == ViewMode::Normals || (mode == ViewMode::Tilt && quantity.gain == 0.0f);
        const Neutral neutral = normals ? Neutral::FlatNormal : Neutral::Black;
        writeSet(gpu_, fresh.sets[m], {*fresh.uniforms.buffer, m * stride, sizeof uniforms},
                 {{sampler(reference), texture(reference, TextureRole::Data, neutral),
                   vk::ImageLayout::eShaderReadOnlyOptimal}});
    }
    falseColor_ = std::move(fresh);
}

} // namespace touchstone
