#include "engine/import/geometry/accessor_values.h"

#include "engine/import/file/gltf_validation.h"
#include "engine/import/geometry/gltf_accessors.h"

#include <algorithm>
#include <cmath>

namespace touchstone {
namespace {

constexpr uint64_t kFreeElements = 1'000'000;

bool isMatrix(int type) {
    return type == TINYGLTF_TYPE_MAT2 || type == TINYGLTF_TYPE_MAT3 || type == TINYGLTF_TYPE_MAT4;
}

/// Many exporters print fewer digits than a float has; that is not worth a warning.
double slack(double declared) {
    return 1e-4 * std::abs(declared);
}

void warnOf(ImportContext& context, const GltfDocument& document, size_t index, const Progress& progress) {
    const tinygltf::Accessor& accessor = document.model.accessors[index];
    const std::string place = element("accessors", index);
    const auto [low, high, broken] = storedRange(context, document, static_cast<int>(index), progress);
    const size_t components = low.size();
    if (broken > 0)
        context.warn(place, std::to_string(broken) + " of its numbers are not finite");
    for (size_t c = 0; c < components; ++c) {
        if (accessor.minValues.size() == components &&
            low[c] < accessor.minValues[c] - slack(accessor.minValues[c]))
            context.warn(place + ".min", "does not hold: there are smaller values. It is not used");
        if (accessor.maxValues.size() == components &&
            high[c] > accessor.maxValues[c] + slack(accessor.maxValues[c]))
            context.warn(place + ".max", "does not hold: there are larger values. It is not used");
    }
}

} // namespace

void warnOfAccessorValues(ImportContext& context, const GltfDocument& document) {
    uint64_t left = std::max(kFreeElements, context.fileBytes());
    for (size_t i = 0; i < document.model.accessors.size(); ++i) {
        const tinygltf::Accessor& accessor = document.model.accessors[i];
        if (accessor.bufferView < 0 || isMatrix(accessor.type) ||
            !accessorHasData(document, static_cast<int>(i)))
            continue;
        if (accessor.count > left)
            return;
        left -= accessor.count;
        context.stopIfCancelled();
        const size_t all = document.model.accessors.size();
        warnOf(context, document, i, context.part().part(share(i, all), share(i + 1, all)));
    }
}

} // namespace touchstone
