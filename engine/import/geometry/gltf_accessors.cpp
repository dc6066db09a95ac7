#include "engine/import/geometry/gltf_accessors.h"

#include "engine/import/file/gltf_validation.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace touchstone {
namespace {

template <class T>
T loadUnaligned(const uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

// glTF 2.0, section 3.11 (animations) and KHR_mesh_quantization: f = c / max, signed ones clamped at -1.
template <class T>
float asFloat(const uint8_t* bytes, bool normalized) {
    const T value = loadUnaligned<T>(bytes);
    if constexpr (std::is_floating_point_v<T>)
        return value;
    else if (!normalized)
        return static_cast<float>(value);
    else
        return std::max(static_cast<float>(static_cast<double>(value) / std::numeric_limits<T>::max()),
                        -1.0f);
}

using Convert = float (*)(const uint8_t*, bool);

Convert converter(int componentType) {
    switch (componentType) {
    case 5120:
        return asFloat<int8_t>;
    case 5121:
        return asFloat<uint8_t>;
    case 5122:
        return asFloat<int16_t>;
    case 5123:
        return asFloat<uint16_t>;
    case 5125:
        return asFloat<uint32_t>;
    default:
        return asFloat<float>;
    }
}

uint32_t loadIndex(const uint8_t* bytes, int componentType) {
    if (componentType == 5121)
        return *bytes;
    if (componentType == 5123)
        return loadUnaligned<uint16_t>(bytes);
    return loadUnaligned<uint32_t>(bytes);
}

/// Calls store(element, bytes) for every element of the buffer view that no sparse value replaces, then for
/// every sparse value. The view may have a stride; sparse values and their indices are packed.
void visitElements(ImportContext& context, const GltfDocument& document, const tinygltf::Accessor& accessor,
                   const std::string& place, auto&& store) {
    const uint64_t bytes =
        componentBytes(accessor.componentType) *
        static_cast<uint64_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
    const auto& sparse = accessor.sparse;
    const uint64_t replacements = sparse.isSparse ? static_cast<uint64_t>(sparse.count) : 0;
    const auto bytesAt = [&](int view, uint64_t offset) {
        return document.buffers.view(static_cast<size_t>(view)).data() + offset;
    };
    const auto target = [&](uint64_t i) -> uint64_t {
        const int type = sparse.indices.componentType;
        return loadIndex(
            bytesAt(sparse.indices.bufferView, sparse.indices.byteOffset) + i * componentBytes(type), type);
    };
    const bool hasView = accessor.bufferView >= 0 && accessor.count > 0;
    std::vector<bool> replaced(hasView && replacements > 0 ? accessor.count : 0); // all are in the view
    uint64_t before = 0, falls = 0;
    for (uint64_t i = 0; i < replacements; ++i) {
        const uint64_t which = target(i);
        falls += i > 0 && which <= before ? 1 : 0;
        before = which;
        if (which >= accessor.count)
            context.fail(place + ".sparse.indices", "replaces element " + std::to_string(which) + " of " +
                                                        std::to_string(accessor.count));
        if (hasView)
            replaced[which] = true;
    }
    if (falls > 0)
        context.warn(place + ".sparse.indices", "do not increase; of values for one element the last counts");
    if (hasView) {
        const size_t byteStride =
            document.model.bufferViews[static_cast<size_t>(accessor.bufferView)].byteStride;
        const uint64_t stride = byteStride != 0 ? byteStride : bytes;
        const uint8_t* data = bytesAt(accessor.bufferView, accessor.byteOffset);
        for (uint64_t i = 0; i < accessor.count; ++i)
            if (replaced.empty() || !replaced[i])
                store(i, data + i * stride);
    }
    for (uint64_t i = 0; i < replacements; ++i)
        store(target(i), bytesAt(sparse.values.bufferView, sparse.values.byteOffset) + i * bytes);
}

} // namespace

size_t accessorCount(const GltfDocument& document, int accessor) {
    return document.model.accessors[static_cast<size_t>(accessor)].count;
}

bool accessorHasData(const GltfDocument& document, int index) {
    const tinygltf::Accessor& accessor = document.model.accessors[static_cast<size_t>(index)];
    const auto present = [&](int view) {
        return view < 0 || document.buffers.hasData(static_cast<size_t>(view));
    };
    return present(accessor.bufferView) &&
           (!accessor.sparse.isSparse ||
            (present(accessor.sparse.indices.bufferView) && present(accessor.sparse.values.bufferView)));
}

int accessorComponents(const GltfDocument& document, int accessor) {
    return tinygltf::GetNumComponentsInType(
        static_cast<uint32_t>(document.model.accessors[static_cast<size_t>(accessor)].type));
}

std::vector<float> readFloats(ImportContext& context, const GltfDocument& document, int index,
                              const std::string& place) {
    const tinygltf::Accessor& accessor = document.model.accessors[static_cast<size_t>(index)];
    const size_t components = static_cast<size_t>(accessorComponents(document, index));
    if (accessor.type == TINYGLTF_TYPE_MAT2 || accessor.type == TINYGLTF_TYPE_MAT3 ||
        accessor.type == TINYGLTF_TYPE_MAT4)
        context.fail(place, "should not be a matrix accessor");
    context.spendGeometry(accessor.count * components * sizeof(float), place);
    std::vector<float> values(accessor.count * components);
    const Convert convert = converter(accessor.componentType);
    const uint64_t step = componentBytes(accessor.componentType);
    visitElements(context, document, accessor, element("accessors", static_cast<size_t>(index)),
                  [&](uint64_t i, const uint8_t* bytes) {
                      for (size_t c = 0; c < components; ++c)
                          values[i * components + c] = convert(bytes + c * step, accessor.normalized);
                  });
    return values;
}

std::vector<glm::mat4> readMatrices(ImportContext& context, const GltfDocument& document, int index,
                                    size_t count, const std::string& place) {
    const tinygltf::Accessor& accessor = document.model.accessors[static_cast<size_t>(index)];
    if (accessor.type != TINYGLTF_TYPE_MAT4 || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
        context.fail(place, "should be a MAT4 accessor of floats");
    if (accessor.count < count)
        context.fail(place, "has " + std::to_string(accessor.count) + " matrices where " +
                                std::to_string(count) + " are needed");
    context.spendGeometry(count * sizeof(glm::mat4), place);
    std::vector<glm::mat4> matrices(count, glm::mat4(0.0f));
    visitElements(context, document, accessor, element("accessors", static_cast<size_t>(index)),
                  [&](uint64_t i, const uint8_t* bytes) {
                      if (i < count)
                          std::memcpy(&matrices[i], bytes, sizeof(glm::mat4));
                  });
    return matrices;
}

namespace {

template <class T>
void rangeOf(ImportContext& context, const GltfDocument& document, const tinygltf::Accessor& accessor,
             const std::string& place, const Progress& progress, StoredRange& range) {
    const size_t components = range.low.size();
    visitElements(context, document, accessor, place, [&](uint64_t i, const uint8_t* bytes) {
        if (i % kProgressWork == 0)
            progress.step(share(i, accessor.count), "looking at accessors");
        for (size_t c = 0; c < components; ++c) {
            const auto value = static_cast<double>(loadUnaligned<T>(bytes + c * sizeof(T)));
            if (!std::isfinite(value)) {
                ++range.broken;
                continue;
            }
            range.low[c] = std::min(range.low[c], value);
            range.high[c] = std::max(range.high[c], value);
        }
    });
}

} // namespace

StoredRange storedRange(ImportContext& context, const GltfDocument& document, int index,
                        const Progress& progress) {
    const tinygltf::Accessor& accessor = document.model.accessors[static_cast<size_t>(index)];
    const auto components = static_cast<size_t>(accessorComponents(document, index));
    StoredRange range{std::vector<double>(components, INFINITY), std::vector<double>(components, -INFINITY)};
    const std::string place = element("accessors", static_cast<size_t>(index));
    switch (accessor.componentType) {
    case 5120:
        rangeOf<int8_t>(context, document, accessor, place, progress, range);
        break;
    case 5121:
        rangeOf<uint8_t>(context, document, accessor, place, progress, range);
        break;
    case 5122:
        rangeOf<int16_t>(context, document, accessor, place, progress, range);
        break;
    case 5123:
        rangeOf<uint16_t>(context, document, accessor, place, progress, range);
        break;
    case 5125:
        rangeOf<uint32_t>(context, document, accessor, place, progress, range);
        break;
    default:
        rangeOf<float>(context, document, accessor, place, progress, range);
    }
    return range;
}

std::vector<uint32_t> readIndices(ImportContext& context, const GltfDocument& document, int index,
                                  const std::string& place) {
    const tinygltf::Accessor& accessor = document.model.accessors[static_cast<size_t>(index)];
    const int type = accessor.componentType;
    if (accessor.type != TINYGLTF_TYPE_SCALAR || (type != 5121 && type != 5123 && type != 5125))
        context.fail(place, "indices must be a SCALAR accessor of an unsigned integer type");
    context.spendGeometry(accessor.count * sizeof(uint32_t), place);
    std::vector<uint32_t> values(accessor.count);
    visitElements(context, document, accessor, element("accessors", static_cast<size_t>(index)),
                  [&](uint64_t i, const uint8_t* bytes) { values[i] = loadIndex(bytes, type); });
    return values;
}

uint32_t restartIndex(const GltfDocument& document, int index) {
    const int type = document.model.accessors[static_cast<size_t>(index)].componentType;
    return type == 5121 ? 0xFFu : type == 5123 ? 0xFFFFu : 0xFFFFFFFFu;
}

} // namespace touchstone
