#include "haptics/friction/stiction.h"

#include "haptics/proxy/neighbourhood_watch.h"

namespace touchstone {

template <class Model>
void applyStiction(const SurfaceFeel& feel, const glm::dvec3& held, double workspacePerAnchor, Model& proxy,
                   DeviceState& state) noexcept {
    if (!feel.touching || !(feel.staticFriction > 0.0)) {
        state.friction = FrictionState::Free;
        return;
    }
    const glm::dvec3 frictionless = state.proxy;
    if (state.friction == FrictionState::Free) {
        // First touch: the stiction point is where the surface was met.
        state.friction = FrictionState::Sticking;
        state.stictionPoint = frictionless;
        return;
    }
    const double depth = feel.depth / workspacePerAnchor;
    const glm::dvec3 stretch = held - frictionless;
    const double length = glm::length(stretch);
    if (length <= feel.staticFriction * depth) {
        state.friction = FrictionState::Sticking;
        proxy.placeAt(held);
        state.stictionPoint = held;
        return;
    }
    // The rest of a HIP moved along by the stretch that is kept. A target on the chord between two places of
    // the surface would stand off it wherever the surface is hollow.
    state.friction = FrictionState::Sliding;
    const glm::dvec3 kept = feel.dynamicFriction * depth / length * stretch;
    proxy.moveTowards(frictionless + kept - depth * feel.normal);
    state.stictionPoint = state.proxy;
}

template void applyStiction(const SurfaceFeel&, const glm::dvec3&, double, MeshProxy&, DeviceState&) noexcept;
template void applyStiction(const SurfaceFeel&, const glm::dvec3&, double, NeighbourhoodWatch&,
                            DeviceState&) noexcept;

} // namespace touchstone
