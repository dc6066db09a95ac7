#pragma once

#include "engine/math/similarity.h"

#include <span>

namespace touchstone {

/// Where one object stands at this tick and where it stood at the last, in the workspace.
struct ObjectMotion {
    Similarity workspaceFromObject;
    Similarity before;
    bool jumped = false; ///< it was put here and did not come here from `before`
};

/// Index = HapticScene::objects.
using ObjectMotions = std::span<const ObjectMotion>;

} // namespace touchstone
