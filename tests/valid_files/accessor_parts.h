#pragma once
// Arrays of numbers as accessors: every component type, layout and sparse form that glTF 2.0 allows for them.

#include "tests/support/gltf_maker.h"
#include "tests/valid_files/draw.h"
#include "tests/valid_files/recipe.h"

#include <map>
#include <string>
#include <vector>

namespace touchstone::test {

/// What all parts of a file are made with.
struct FileDraft {
    explicit FileDraft(const Recipe& from) : recipe(from), draw(from.seed) {}

    [[nodiscard]] bool has(Feature feature) const { return recipe.has(feature); }
    void use(const std::string& extension, bool required = false);

    const Recipe recipe;
    Draw draw;
    GltfMaker maker;
    bool tooWide = false;            ///< of QuantizedGeometry
    std::vector<size_t> materials;   ///< indices into json["materials"]
    std::vector<size_t> meshNodes;   ///< nodes with a mesh
    std::map<size_t, size_t> morphs; ///< mesh -> number of its morph targets
};

constexpr int kByte = 5120, kUByte = 5121, kShort = 5122, kUShort = 5123, kUInt = 5125, kFloat = 5126;

/// Numbers as an accessor stores them.
struct Column {
    std::string type = "SCALAR"; ///< SCALAR, VEC2, VEC3, VEC4, MAT4
    int componentType = kFloat;
    bool normalized = false;
    std::vector<double> values; ///< of the accessor, not as stored: 0..1 or -1..1 where normalized
    bool bounds = false;        ///< give min and max

    [[nodiscard]] size_t components() const;
    [[nodiscard]] size_t count() const { return values.size() / components(); }
};

/// Writes vertex attributes of equal count, in whichever layout the recipe asks for. Attribute -> accessor.
std::map<std::string, size_t> writeVertices(FileDraft& draft, const std::map<std::string, Column>& columns);

/// An accessor that is no vertex attribute: packed, possibly sparse.
size_t writeColumn(FileDraft& draft, const Column& column);

/// Indices of the narrowest type that may hold them, or of a wider one. None of them is the restart value.
size_t writeIndices(FileDraft& draft, const std::vector<uint32_t>& indices);

} // namespace touchstone::test
