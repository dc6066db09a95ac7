#pragma once
// A model whose objects can be picked up, whatever its file says of bodies.

#include "engine/scene/scene.h"

namespace touchstone {

/// Makes a rigid body of every node that shows a mesh, with the nodes below it: 100 g, its convex hull, no
/// weight, and a drag that brings it to rest, so that it stays where it is put. Bodies and colliders that the
/// file states keep what it states; what an animation moves or deforms stays with the animation.
/// Physics::loose says that it was done. Nodes beyond kMaxBodies stay where they are. A scene with soft
/// bodies stays as it is, with a warning: no scene has both.
void loosen(Scene& scene);

} // namespace touchstone
