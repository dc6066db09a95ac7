#pragma once
// Tangents where the file has none, by the rules of M. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited"
// (thesis, 2008, chapter 3), which glTF prescribes so that normal maps agree between programs.

#include "engine/core/progress.h"
#include "engine/scene/scene.h"

namespace touchstone {

/// Fills `mesh.tangents` from its normals and UV set `texCoord` (0 or 1, present, one per vertex). Vertices
/// at which several tangent frames meet (as with mirrored UVs) are split, so vertex arrays and indices may
/// change; the surface does not. Triangles whose UVs have no area take a neighbour's frame, else any
/// perpendicular one. The bitangent is w * cross(normal, tangent). Takes time n log n in the triangles,
/// however they meet. Throws Cancelled, which leaves the mesh incomplete; reports nothing.
void generateTangents(Mesh& mesh, int texCoord, const Progress& progress = {});

} // namespace touchstone
