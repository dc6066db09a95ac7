#pragma once
// The source of a false-colour view's quantity; private to renderer/.

#include "engine/scene/scene.h"
#include "renderer/view.h"

#include <optional>
#include <vector>

namespace touchstone {

/// value = (vertex value, else `base`) * (offset + gain * R), R the red channel of `texture`, 0 without one.
struct HapticQuantity {
    std::optional<float> base; ///< empty: not stated by the material
    TextureRef texture;
    float offset = 1.0f, gain = 0.0f;
};
[[nodiscard]] HapticQuantity hapticQuantity(const Material& material, ViewMode mode);

/// The mesh's own values of this quantity, one per vertex; null if it has none.
[[nodiscard]] const std::vector<float>* vertexValues(const Mesh& mesh, const Material& material,
                                                     ViewMode mode);

} // namespace touchstone
