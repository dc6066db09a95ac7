#include "renderer/false_color.h"

#include "renderer/haptic_quantity.h"
#include "shaders/shared/false_color.h"

#include <algorithm>

namespace touchstone {

const std::vector<float>* vertexValues(const Mesh& mesh, ViewMode mode) {
    const std::vector<float>* values = nullptr;
    if (mode == ViewMode::Friction)
        values = &mesh.friction;
    if (mode == ViewMode::Stiffness)
        values = &mesh.stiffness;
    if (mode == ViewMode::Damping)
        values = &mesh.damping;
    return values != nullptr && !values->empty() ? values : nullptr;
}

HapticQuantity hapticQuantity(const Material& material, ViewMode mode) {
    const HapticMaterial& haptic = material.haptic;
    HapticQuantity quantity;
    const auto factor = [&](const HapticMaterial::Field<float>& value,
                            const HapticMaterial::Field<FactorMap>& map) {
        quantity.base = value.value;
        if (map.value && map.value->texture) {
            quantity.texture = map.value->texture;
            quantity.offset = map.value->min;
            quantity.gain = map.value->max - map.value->min;
        }
    };
    switch (mode) {
    case ViewMode::Friction:
        factor(haptic.staticFriction, haptic.friction);
        break;
    case ViewMode::Stiffness:
        factor(haptic.stiffness, haptic.stiffnessMap);
        break;
    case ViewMode::Damping:
        factor(haptic.damping, haptic.dampingMap);
        break;
    case ViewMode::Height:
        if (haptic.height.value && haptic.height.value->texture) {
            const HeightMap& height = *haptic.height.value;
            quantity = {1.0f, height.texture, -height.midLevel * height.scale, height.scale};
        }
        break;
    case ViewMode::Shaded:
    case ViewMode::Normals:
    case ViewMode::Uv:
        break;
    }
    return quantity;
}

FalseColorScale falseColorScale(const Scene& scene, ViewMode mode) {
    FalseColorScale scale;
    switch (mode) {
    case ViewMode::Height:
        scale.unit = "m";
        break;
    case ViewMode::Friction:
        scale.unit = "1";
        break;
    case ViewMode::Stiffness:
        scale.unit = "N/m";
        break;
    case ViewMode::Damping:
        scale.unit = "N·s/m";
        break;
    case ViewMode::Shaded:
    case ViewMode::Normals:
    case ViewMode::Uv:
        return scale;
    }
    double low = 1e300, high = -1e300;
    for (const Mesh& mesh : scene.meshes) {
        const HapticQuantity quantity =
            hapticQuantity(scene.materials[static_cast<size_t>(mesh.material)], mode);
        const auto include = [&](float value) {
            for (const float map : {quantity.offset, quantity.offset + quantity.gain}) {
                low = std::min(low, static_cast<double>(value * map));
                high = std::max(high, static_cast<double>(value * map));
            }
        };
        if (const std::vector<float>* values = vertexValues(mesh, mode))
            for (const float value : *values)
                include(value);
        else if (quantity.base)
            include(*quantity.base);
    }
    if (low > high)
        return scale;
    scale.meaningful = true;
    // One value everywhere still wants a scale with two ends; it starts at nothing.
    if (low == high)
        low = std::min(0.0, low);
    if (low == high)
        high = low + 1.0;
    scale.low = low;
    scale.high = high;
    return scale;
}

glm::vec3 falseColor(double t) {
    return shared::falseColorAt(static_cast<float>(t));
}

} // namespace touchstone
