#pragma once

#include "engine/math/similarity.h"

#include <span>

namespace touchstone {

/// The pose of one object at this tick and at the last, in the workspace.
struct ObjectMotion {
    Similarity workspaceFromObject;
    Similarity before;
    bool jumped = false; ///< it was placed here and did not move here from `before`

    [[nodiscard]] bool moves() const {
        return !jumped &&
               (before.translation != workspaceFromObject.translation ||
                before.rotation != workspaceFromObject.rotation || before.scale != workspaceFromObject.scale);
    }
};

/// Index = HapticScene::objects.
using ObjectMotions = std::span<const ObjectMotion>;

} // namespace touchstone
