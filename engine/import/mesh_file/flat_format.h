#pragma once
// The form in which touchstone_mesh_reader, the child process, answers: little-endian words, then arrays.
// Numbers only, and nothing that refers to anything outside of it. Shared by both processes; includes nothing
// of the engine.
//
//   kFlatMagic, number of materials, number of meshes                        uint32 each
//   for each material: length of its name in bytes, the name padded with zeros to a multiple of four
//   for each mesh: the same for its name, then FlatCounts
//   for each mesh: positions (3 floats a vertex); normals (3), texture coordinates (2), colours (4), each
//   where `has` says so; corners (3 uint32 a triangle)
//
// and nothing after that.

#include <cstdint>

namespace touchstone {

inline constexpr uint32_t kFlatMagic = 0x31464D54; // "TMF1"

enum FlatArray : uint32_t { kFlatNormals = 1, kFlatTextureCoordinates = 2, kFlatColors = 4, kFlatAll = 7 };

struct FlatCounts {
    uint32_t material = 0; ///< index
    uint32_t vertices = 0, triangles = 0;
    uint32_t has = 0; ///< FlatArrays
};

inline constexpr uint32_t kMaxFlatParts = 20'000;  ///< meshes, and materials
inline constexpr uint32_t kMaxFlatNameBytes = 256; ///< longer names are cut by the writer

} // namespace touchstone
