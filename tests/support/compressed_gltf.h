#pragma once
// Files compressed with Draco and meshopt, made with the libraries' own encoders.

#include "tests/support/gltf_maker.h"

#include <glm/glm.hpp>

#include <vector>

namespace touchstone::test {

struct Wave {
    std::vector<glm::vec3> positions, normals;
    std::vector<uint32_t> indices;
};

/// A wavy sheet of n x n squares, z = 0.1 sin 6x over the unit square, with its exact normals.
Wave wave(uint32_t n);

enum class DracoMethod { Sequential, Edgebreaker };

struct DracoFile {
    GltfMaker maker;
    size_t view = 0; ///< the buffer view with the stream
};

DracoFile dracoFile(const Wave& wave, DracoMethod method);

/// Positions, octahedral normals and triangles, each a view compressed with EXT_meshopt_compression.
GltfMaker meshoptFile(const Wave& sheet);

} // namespace touchstone::test
