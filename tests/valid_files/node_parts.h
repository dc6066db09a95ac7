#pragma once

#include "tests/valid_files/accessor_parts.h"

namespace touchstone::test {

/// Places the meshes: nodes, their transforms and nesting, skins, instances and scenes.
void addNodes(FileDraft& draft);

/// Animations of the nodes that may be animated.
void addAnimations(FileDraft& draft);

} // namespace touchstone::test
