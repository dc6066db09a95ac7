#include "engine/import/materials/gltf_images.h"

#include "engine/import/file/gltf_uri.h"
#include "engine/import/file/image_decode.h"
#include "engine/import/materials/gltf_haptics.h"

#include <filesystem>
#include <set>

namespace touchstone {
namespace {

using nlohmann::json;

struct Encoded {
    std::vector<uint8_t> owned;
    ByteSpan bytes;
    std::string declaredType;
};

/// Reads the encoded bytes of images and accounts for their cost: a file that is read repeatedly counts
/// against the pixels' memory, so that no list of images makes the loader read for hours.
class ImageSource {
  public:
    ImageSource(ImportContext& context, const GltfFile& file, const GltfDocument& document)
        : context_(context), file_(file), document_(document) {}

    /// Sets `image.problem` when there is nothing to decode. A flaw of an image costs only that image.
    Encoded fetch(const json& gltf, const std::string& place, Image& image) {
        Encoded encoded;
        encoded.declaredType = gltf.value("mimeType", "");
        const bool hasView = gltf.contains("bufferView"), hasUri = gltf.contains("uri");
        if (hasView && hasUri)
            context_.warn(place, "has both a uri and a bufferView; the bufferView is read");
        if (hasView)
            readView(gltf["bufferView"], place, encoded, image);
        else if (!hasUri)
            image.problem = "it has neither a uri nor a bufferView";
        else
            try {
                readUri(gltf["uri"], place, encoded, image);
            } catch (const Error& error) {
                context_.stopIfCancelled();
                image.problem = error.problem();
            }
        return encoded;
    }

  private:
    void readView(size_t view, const std::string& place, Encoded& encoded, Image& image) {
        if (encoded.declaredType.empty())
            context_.warn(place, "has a bufferView but no mimeType");
        if (document_.json["bufferViews"][view].contains("byteStride"))
            context_.warn(place + ".bufferView",
                          "has a byteStride, which the buffer view of an image must not have");
        encoded.bytes = document_.buffers.view(view);
        if (encoded.bytes.empty())
            image.problem = "its buffer has no data";
    }

    void readUri(const std::string& uri, const std::string& place, Encoded& encoded, Image& image) {
        if (isDataUri(uri)) {
            DataUri data = decodeDataUri(context_, place + ".uri", uri);
            if (encoded.declaredType.empty())
                encoded.declaredType = data.mediaType;
            encoded.owned = std::move(data.bytes);
            context_.countFileBytes(encoded.owned.size());
        } else {
            if (image.name.empty())
                image.name = uri.substr(0, 200);
            readFile(resolveUri(context_, place + ".uri", file_.folder, uri), uri.substr(0, 200), encoded,
                     image);
        }
        encoded.bytes = encoded.owned;
    }

    void readFile(const std::filesystem::path& path, const std::string& uri, Encoded& encoded, Image& image) {
        if (exhausted_) {
            image.problem = kTooManyPixels;
            return;
        }
        try {
            encoded.owned = readWholeFile(path, path.string());
        } catch (const Error& error) {
            image.problem = "\"" + uri + "\": " + error.problem();
            return;
        }
        if (read_.insert(path).second)
            context_.countFileBytes(encoded.owned.size());
        else
            exhausted_ = !context_.spendPixels(encoded.owned.size());
    }

    ImportContext& context_;
    const GltfFile& file_;
    const GltfDocument& document_;
    std::set<std::filesystem::path> read_;
    bool exhausted_ = false;
};

void warnOfType(ImportContext& context, const Encoded& encoded, const std::string& place) {
    const std::string format = sniffImageFormat(encoded.bytes);
    if (!encoded.declaredType.empty() && !format.empty() && encoded.declaredType != "image/" + format)
        context.warn(place, "is declared as " + encoded.declaredType.substr(0, 60) + " but holds " + format);
}

/// Marks the images that are used for drawing or touch.
class UsedImages {
  public:
    explicit UsedImages(size_t count) : used(count, false) {}
    std::vector<bool> used;

    void seen(const Material& material) {
        for (const TextureRef* texture : material.lookTextures())
            mark(*texture);
    }
    void felt(const Material& material, const CoordinateSets& sets) {
        const HapticMaterial& haptic = material.haptic;
        const auto map = [&](const TextureRef& texture) {
            if (sets[texture.texCoord & 1])
                mark(texture);
        };
        if (haptic.normalTextureInfluence.value.value_or(1.0f) > 0.0f && material.normalScale != 0.0f)
            map(material.normalTexture);
        if (haptic.height.value && haptic.height.value->scale != 0.0f)
            map(haptic.height.value->texture);
        for (const auto* factor : {&haptic.friction, &haptic.stiffnessMap, &haptic.dampingMap})
            if (factor->value)
                map(factor->value->texture);
        // Derived friction also reads the roughness texture.
        if (!haptic.staticFriction.value || !haptic.dynamicFriction.value)
            mark(material.metallicRoughnessTexture);
    }

  private:
    void mark(const TextureRef& texture) {
        if (texture)
            used[static_cast<size_t>(texture.image)] = true;
    }
};

std::vector<bool> usedImages(size_t count, const Scene& scene, const ImageUse& use) {
    UsedImages images(count);
    const std::vector<MaterialPlacement> placements = materialPlacements(scene);
    for (size_t m = 0; m < scene.materials.size(); ++m) {
        if (use.visual && placements[m].drawn)
            images.seen(scene.materials[m]);
        if (use.haptic && placements[m].placed)
            images.felt(scene.materials[m], placements[m].sets);
    }
    return images.used;
}

void dropIfBroken(const std::vector<Image>& images, TextureRef& texture) {
    if (texture && !images[static_cast<size_t>(texture.image)].problem.empty())
        texture = {};
}

} // namespace

std::vector<Image> readImages(ImportContext& context, const GltfFile& file, const GltfDocument& document,
                              const Scene& scene, const ImageUse& use) {
    if (!file.json.contains("images"))
        return {};
    const json& gltf = file.json["images"];
    std::vector<Image> images(gltf.size());
    const std::vector<bool> used = usedImages(images.size(), scene, use);
    ImageSource source(context, file, document);
    for (size_t i = 0; i < images.size(); ++i) {
        context.step(0.85 + 0.15 * static_cast<double>(i) / static_cast<double>(images.size()),
                     "reading images");
        Image& image = images[i];
        const std::string place = element("images", i);
        image.name = gltf[i].value("name", "");
        const Encoded encoded = source.fetch(gltf[i], place, image);
        if (image.name.empty())
            image.name = place;
        image.encodedBytes = encoded.bytes.size();
        if (image.problem.empty()) {
            warnOfType(context, encoded, place);
            DecodedImage decoded = decodeImage(encoded.bytes, !used[i],
                                               [&](uint64_t bytes) { return context.spendPixels(bytes); });
            image.problem = std::move(decoded.problem);
            image.width = decoded.pixels.width;
            image.height = decoded.pixels.height;
            image.channels = decoded.pixels.channels;
            if (used[i] && image.problem.empty()) {
                image.pixels = std::move(decoded.pixels);
                image.decoded = true;
            }
        }
        if (!image.problem.empty())
            context.warn(place, "the image cannot be used: " + image.problem);
    }
    return images;
}

void dropBrokenImages(const std::vector<Image>& images, std::vector<Material>& materials) {
    for (Material& material : materials) {
        const bool hadColor = static_cast<bool>(material.baseColorTexture);
        for (TextureRef* texture : material.lookTextures())
            dropIfBroken(images, *texture);
        if (hadColor && !material.baseColorTexture)
            material.baseColor = glm::vec4(glm::vec3(material.baseColor) * 0.5f, material.baseColor.w);
    }
}

std::optional<float> statedRoughness(const Material& material, const std::vector<Image>& images) {
    if (!material.metallicRoughnessTexture)
        return material.roughnessStated ? std::optional(material.roughness) : std::nullopt;
    const PixelData& pixels = images[static_cast<size_t>(material.metallicRoughnessTexture.image)].pixels;
    if (pixels.bytes.empty())
        return std::nullopt;
    const int channel = pixels.channels >= 3 ? 1 : 0;
    double sum = 0.0;
    for (int y = 0; y < pixels.height; ++y)
        for (int x = 0; x < pixels.width; ++x)
            sum += static_cast<double>(pixels.value(x, y, channel));
    return static_cast<float>(static_cast<double>(material.roughness) * sum /
                              (static_cast<double>(pixels.width) * pixels.height));
}

} // namespace touchstone
