#include "renderer/gpu_scene.h"

#include "renderer/false_color.h"
#include "renderer/haptic_quantity.h"
#include "shaders/shared/scene_types.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace touchstone {

namespace {

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

vk::DeviceSize alignedTo(vk::DeviceSize size, vk::DeviceSize alignment) {
    return (size + alignment - 1) / alignment * alignment;
}

/// The affine map of TextureRef::transform, read off its images of three points.
void setUv(const TextureRef& reference, glm::vec4& linear, glm::vec4& offset) {
    const glm::vec2 origin = reference.transform(glm::vec2(0.0f));
    const glm::vec2 u = reference.transform(glm::vec2(1.0f, 0.0f)) - origin;
    const glm::vec2 v = reference.transform(glm::vec2(0.0f, 1.0f)) - origin;
    linear = {u.x, v.x, u.y, v.y};
    offset = {origin.x, origin.y, static_cast<float>(reference.texCoord), 0.0f};
}

bool transformed(const TextureRef& reference) {
    return reference && (reference.texCoord != 0 || reference.offset != glm::vec2(0.0f) ||
                         reference.rotation != 0.0f || reference.scale != glm::vec2(1.0f));
}

bool sameLookup(const TextureRef& a, const TextureRef& b) {
    return a.image == b.image && a.texCoord == b.texCoord && a.offset == b.offset &&
           a.rotation == b.rotation && a.scale == b.scale && a.wrapS == b.wrapS && a.wrapT == b.wrapT &&
           a.nearest == b.nearest;
}

bool usable(const Scene& scene, const TextureRef& reference) {
    if (!reference || static_cast<size_t>(reference.image) >= scene.images.size())
        return false;
    const PixelData& pixels = scene.images[static_cast<size_t>(reference.image)].pixels;
    return pixels.width > 0 && pixels.height > 0 && !pixels.bytes.empty();
}

SceneVertex packVertex(const Mesh& mesh, size_t i, const glm::dvec3& centre) {
    SceneVertex vertex{};
    vertex.position = glm::vec3(glm::dvec3(mesh.positions[i]) - centre);
    vertex.normal = mesh.normals.empty() ? glm::vec3(0.0f, 0.0f, 1.0f) : mesh.normals[i];
    vertex.tangent = mesh.tangents.empty() ? glm::vec4(1.0f, 0.0f, 0.0f, 1.0f) : mesh.tangents[i];
    if (!mesh.uv0.empty())
        vertex.uv0 = mesh.uv0[i];
    if (!mesh.uv1.empty())
        vertex.uv1 = mesh.uv1[i];
    const glm::vec4 color = mesh.colors.empty() ? glm::vec4(1.0f) : glm::clamp(mesh.colors[i], 0.0f, 1.0f);
    for (int c = 0; c < 4; ++c)
        vertex.color[static_cast<size_t>(c)] = static_cast<uint16_t>(std::lround(65535.0f * color[c]));
    return vertex;
}

vk::raii::DescriptorPool makePool(const Gpu::Impl& gpu, size_t sets, size_t texturesEach) {
    const auto count = static_cast<uint32_t>(sets);
    const std::array sizes{vk::DescriptorPoolSize{vk::DescriptorType::eUniformBuffer, count},
                           vk::DescriptorPoolSize{vk::DescriptorType::eCombinedImageSampler,
                                                  count * static_cast<uint32_t>(texturesEach)}};
    return {gpu.device, vk::DescriptorPoolCreateInfo{
                            .maxSets = count, .poolSizeCount = sizes.size(), .pPoolSizes = sizes.data()}};
}

/// `count` sets of one layout; they live as long as the pool.
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

GpuScene::GpuScene(const Gpu::Impl& gpu, const Pipelines& pipelines, ScenePtr scene)
    : gpu_(gpu), pipelines_(pipelines), scene_(std::move(scene)) {
    Uploader uploader(gpu);
    uploadMeshes(uploader);
    uploadMaterials(uploader);
}

uint32_t GpuScene::materialFeatures(const Material& material) const {
    using namespace shared;
    uint32_t features = 0;
    if (material.baseColorTexture)
        features |= kHasBaseColorTexture; // a broken one is drawn grey
    if (usable(*scene_, material.metallicRoughnessTexture))
        features |= kHasMetallicRoughnessTexture;
    if (usable(*scene_, material.normalTexture))
        features |= kHasNormalTexture;
    if (usable(*scene_, material.occlusionTexture))
        features |= kHasOcclusionTexture;
    if (usable(*scene_, material.emissiveTexture))
        features |= kHasEmissiveTexture;
    const bool emissive = material.emissive != glm::vec3(0.0f);
    const bool emissionKnown = !material.emissiveTexture || (features & kHasEmissiveTexture) != 0;
    if (emissive && emissionKnown)
        features |= kHasEmission;
    else
        features &= ~kHasEmissiveTexture;
    const uint32_t both = kHasMetallicRoughnessTexture | kHasOcclusionTexture;
    if ((features & both) == both && sameLookup(material.metallicRoughnessTexture, material.occlusionTexture))
        features |= kSharesOcclusion;
    for (const TextureRef* reference :
         {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture,
          &material.occlusionTexture, &material.emissiveTexture})
        if (transformed(*reference))
            features |= kHasUvTransform;
    if (material.alphaMode == AlphaMode::Mask)
        features |= kIsMasked;
    if (material.alphaMode == AlphaMode::Blend)
        features |= kIsBlended;
    return features;
}

void GpuScene::uploadMeshes(Uploader& uploader) {
    size_t vertexCount = 0, indexCount = 0;
    for (const Mesh& mesh : scene_->meshes) {
        MeshRange range;
        range.firstVertex = static_cast<int32_t>(vertexCount);
        range.firstIndex = static_cast<uint32_t>(indexCount);
        range.indexCount = static_cast<uint32_t>(mesh.indices.size());
        Bounds bounds;
        for (const glm::vec3& position : mesh.positions)
            bounds.include(glm::dvec3(position));
        if (!bounds.empty())
            range.centre = bounds.centre();
        const Material& material = scene_->materials[static_cast<size_t>(mesh.material)];
        range.features = materialFeatures(material);
        if (!mesh.colors.empty())
            range.features |= shared::kHasVertexColor;
        if (!mesh.tangents.empty() && (range.features & shared::kHasNormalTexture) != 0)
            range.features |= shared::kHasTangents;
        meshes_.push_back(range);
        vertexCount += mesh.positions.size();
        indexCount += mesh.indices.size();
    }
    using Usage = vk::BufferUsageFlagBits;
    vertices_ = createBuffer(gpu_, vertexCount * sizeof(SceneVertex),
                             Usage::eVertexBuffer | Usage::eTransferDst, MemoryUse::Device);
    indices_ = createBuffer(gpu_, indexCount * sizeof(uint32_t), Usage::eIndexBuffer | Usage::eTransferDst,
                            MemoryUse::Device);
    deviceBytes_ += vertices_.size + indices_.size;
    std::vector<SceneVertex> packed;
    for (size_t m = 0; m < scene_->meshes.size(); ++m) {
        const Mesh& mesh = scene_->meshes[m];
        packed.clear();
        packed.reserve(mesh.positions.size());
        for (size_t i = 0; i < mesh.positions.size(); ++i)
            packed.push_back(packVertex(mesh, i, meshes_[m].centre));
        uploader.buffer(vertices_, static_cast<vk::DeviceSize>(meshes_[m].firstVertex) * sizeof(SceneVertex),
                        bytesOf(packed));
        uploader.buffer(indices_, meshes_[m].firstIndex * sizeof(uint32_t), bytesOf(mesh.indices));
    }
}

void GpuScene::uploadMaterials(Uploader& uploader) {
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
        const std::array<const TextureRef*, kTextureSlots> references{
            &material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture,
            &material.occlusionTexture, &material.emissiveTexture};
        MaterialUniforms uniforms{};
        uniforms.baseColor = material.baseColor;
        uniforms.emissiveCutoff = glm::vec4(material.emissive, material.alphaCutoff);
        uniforms.factors = {material.metallic, material.roughness, material.normalScale,
                            material.occlusionStrength};
        std::vector<vk::DescriptorImageInfo> images;
        for (size_t slot = 0; slot < kTextureSlots; ++slot) {
            const bool color = slot == kBaseColorSlot || slot == kEmissiveSlot;
            const Neutral neutral = slot == kBaseColorSlot ? Neutral::Grey
                                    : slot == kNormalSlot  ? Neutral::FlatNormal
                                                           : Neutral::White;
            setUv(*references[slot], uniforms.uvLinear[slot], uniforms.uvOffset[slot]);
            images.push_back({sampler(*references[slot]),
                              texture(uploader, *references[slot],
                                      color ? TextureRole::Color : TextureRole::Data, neutral),
                              vk::ImageLayout::eShaderReadOnlyOptimal});
        }
        std::memcpy(materialUniforms_.mapped + m * stride, &uniforms, sizeof uniforms);
        writeSet(gpu_, materialSets_[m], {*materialUniforms_.buffer, m * stride, sizeof uniforms}, images);
    }
}

void GpuScene::upload(Uploader& uploader, const TextureLevels& levels, GpuImage& image) {
    const auto extentOf = [](const TextureLevels::Level& level) {
        return vk::Extent2D{static_cast<uint32_t>(level.width), static_cast<uint32_t>(level.height)};
    };
    image =
        createImage(gpu_, {.format = formatOf(levels.format),
                           .extent = extentOf(levels.levels.front()),
                           .levels = static_cast<uint32_t>(levels.levels.size()),
                           .usage = vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst});
    deviceBytes_ += image.size;
    using Layout = vk::ImageLayout;
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    const vk::ImageAspectFlags color = vk::ImageAspectFlagBits::eColor;
    runOnce(gpu_, [&](const vk::raii::CommandBuffer& commands) {
        transition(commands, *image.image, color, Layout::eUndefined, Layout::eTransferDstOptimal,
                   Stage::eNone, Access::eNone, Stage::eCopy, Access::eTransferWrite);
    });
    for (size_t i = 0; i < levels.levels.size(); ++i) {
        const TextureLevels::Level& level = levels.levels[i];
        const size_t size = static_cast<size_t>(level.width) * static_cast<size_t>(level.height) *
                            bytesPerTexel(levels.format);
        uploader.imageLevel(image, static_cast<uint32_t>(i), extentOf(level),
                            std::span(levels.bytes).subspan(level.offset, size));
    }
    runOnce(gpu_, [&](const vk::raii::CommandBuffer& commands) {
        transition(commands, *image.image, color, Layout::eTransferDstOptimal, Layout::eShaderReadOnlyOptimal,
                   Stage::eCopy, Access::eTransferWrite, Stage::eFragmentShader, Access::eShaderSampledRead);
    });
}

vk::ImageView GpuScene::texture(Uploader& uploader, const TextureRef& reference, TextureRole role,
                                Neutral neutral) {
    if (!usable(*scene_, reference))
        return neutralTexture(uploader, neutral);
    const auto [entry, fresh] = textures_.try_emplace({reference.image, role});
    if (fresh) {
        const PixelData& pixels = scene_->images[static_cast<size_t>(reference.image)].pixels;
        upload(uploader, buildTextureLevels(pixels, role, static_cast<int>(gpu_.limits.maxImageDimension2D)),
               entry->second);
    }
    return *entry->second.view;
}

vk::ImageView GpuScene::neutralTexture(Uploader& uploader, Neutral neutral) {
    const auto [entry, fresh] = neutrals_.try_emplace(neutral);
    if (fresh) {
        // Grey is 0.5 as seen, FlatNormal is +z, 127.5 rounded up.
        const std::array<std::array<int, 4>, 4> texels{
            {{255, 255, 255, 255}, {128, 128, 128, 255}, {0, 0, 0, 255}, {128, 128, 255, 255}}};
        TextureLevels levels;
        levels.format = neutral == Neutral::Grey ? TexelFormat::Srgb8 : TexelFormat::Unorm8;
        levels.levels = {{1, 1, 0}};
        for (const int c : texels[static_cast<size_t>(neutral)])
            levels.bytes.push_back(static_cast<std::byte>(c));
        upload(uploader, levels, entry->second);
    }
    return *entry->second.view;
}

vk::Sampler GpuScene::sampler(const TextureRef& reference) {
    const std::tuple key{reference.wrapS, reference.wrapT, reference.nearest};
    auto found = samplers_.find(key);
    if (found == samplers_.end()) {
        // Trilinear doubles the texels read, which a software device feels; it takes the nearest level.
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

void GpuScene::uploadScalars(Uploader& uploader, FalseColor& target) const {
    size_t vertexCount = 0;
    for (const Mesh& mesh : scene_->meshes)
        vertexCount += mesh.positions.size();
    target.scalars = createBuffer(
        gpu_, vertexCount * sizeof(float),
        vk::BufferUsageFlagBits::eVertexBuffer | vk::BufferUsageFlagBits::eTransferDst, MemoryUse::Device);
    for (size_t m = 0; m < scene_->meshes.size(); ++m) {
        const Mesh& mesh = scene_->meshes[m];
        const vk::DeviceSize place = static_cast<vk::DeviceSize>(meshes_[m].firstVertex) * sizeof(float);
        if (target.mode == ViewMode::Dihedral) {
            uploader.buffer(target.scalars, place, bytesOf(dihedralAngles(mesh)));
            continue;
        }
        if (const std::vector<float>* values = vertexValues(mesh, target.mode)) {
            uploader.buffer(target.scalars, place, bytesOf(*values));
            continue;
        }
        // A negative scalar is drawn grey: nobody states the quantity.
        const Material& material = scene_->materials[static_cast<size_t>(mesh.material)];
        const std::vector<float> same(mesh.positions.size(),
                                      hapticQuantity(material, target.mode).base.value_or(-1.0f));
        uploader.buffer(target.scalars, place, bytesOf(same));
    }
}

void GpuScene::prepareFalseColor(ViewMode mode, const std::vector<glm::vec3>& materialColors) {
    if (falseColorReady(mode))
        return;
    Uploader uploader(gpu_);
    FalseColor fresh;
    fresh.mode = mode;
    uploadScalars(uploader, fresh);
    const size_t count = scene_->materials.size();
    const vk::DeviceSize stride =
        alignedTo(sizeof(shared::FalseColorUniforms), gpu_.limits.minUniformBufferOffsetAlignment);
    fresh.uniforms =
        createBuffer(gpu_, stride * count, vk::BufferUsageFlagBits::eUniformBuffer, MemoryUse::Upload);
    fresh.pool = makePool(gpu_, std::max<size_t>(count, 1), 1);
    fresh.sets = allocateSets(gpu_, fresh.pool, pipelines_.falseColorSet(), count);
    fresh.scale = falseColorScale(*scene_, mode);
    const FalseColorScale& scale = fresh.scale;
    const double range = scale.high - scale.low;
    for (size_t m = 0; m < count; ++m) {
        const Material& material = scene_->materials[m];
        const HapticQuantity quantity = hapticQuantity(material, mode);
        const TextureRef reference = mode == ViewMode::Normals ? material.normalTexture : quantity.texture;
        shared::FalseColorUniforms uniforms{};
        uniforms.map = {quantity.offset, quantity.gain, static_cast<float>(1.0 / range),
                        static_cast<float>(-scale.low / range)};
        if (mode == ViewMode::Normals)
            uniforms.map.x = material.normalScale;
        if (mode == ViewMode::Effects)
            uniforms.map = glm::vec4(m < materialColors.size() ? materialColors[m] : glm::vec3(0.5f), 1.0f);
        setUv(reference, uniforms.uvLinear, uniforms.uvOffset);
        std::memcpy(fresh.uniforms.mapped + m * stride, &uniforms, sizeof uniforms);
        const bool normals = mode == ViewMode::Normals || (mode == ViewMode::Tilt && material.normalTexture);
        const Neutral neutral = normals ? Neutral::FlatNormal : Neutral::Black;
        writeSet(gpu_, fresh.sets[m], {*fresh.uniforms.buffer, m * stride, sizeof uniforms},
                 {{sampler(reference), texture(uploader, reference, TextureRole::Data, neutral),
                   vk::ImageLayout::eShaderReadOnlyOptimal}});
    }
    falseColor_ = std::move(fresh);
}

} // namespace touchstone
