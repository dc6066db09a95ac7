#pragma once

#include "engine/math/similarity.h"

#include <span>

namespace touchstone {

/// The pose of one object at this tick and at the last, in the workspace.
struct ObjectMotion {
    Similarity workspaceFromObject;
    Similarity before;
    bool jumped = false; ///< it was placed here and did not move here from `before`
};

/// Index = HapticScene::objects.
using ObjectMotions = std::span<const ObjectMotion>;

} // namespace touchstone
