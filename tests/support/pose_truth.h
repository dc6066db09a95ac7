#pragma once
// Where the glTF 2.0 specification puts the triangles of a file that nothing animates, in long double: nodes,
// skins, morph targets and EXT_mesh_gpu_instancing. Reads JSON and buffers itself and shares no code with the
// importer. For valid files with triangle lists, without compression.

#include "engine/scene/scene.h"
#include "tests/support/affine.h"

#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace touchstone::test {

struct TruthCorner {
    Real3 position{}, normal{}; ///< scene frame; the normal is unit
    /// 0..1: how well the normal is determined. The rounding of the inputs turns it by as much over `steady`.
    Real steady = 1;
    std::array<Real, 2> uv0{};
    std::array<Real, 4> color{1, 1, 1, 1};
};

/// One primitive of one copy of the mesh of one node: corners counter-clockwise seen from outside.
struct TruthObject {
    std::string place; ///< "nodes[2] copy 0 primitives[1]"
    std::vector<std::array<TruthCorner, 3>> triangles;
};

/// A glTF file with its bytes.
struct TruthFile {
    nlohmann::json json;
    std::vector<std::vector<uint8_t>> buffers;
};

/// A .gltf with its buffers in files beside it, or a .glb. Throws std::runtime_error.
[[nodiscard]] TruthFile readTruthFile(const std::filesystem::path& path);

/// All numbers of an accessor, normalised integers divided.
[[nodiscard]] std::vector<Real> truthNumbers(const TruthFile& file, size_t accessor);

/// The file with its nodes as its animation `animation` has them at `time` (s, clamped to the keys of each
/// channel): section 3.11 and appendix C, in long double.
[[nodiscard]] TruthFile animated(const TruthFile& file, size_t animation, Real time);

/// Every object of the default scene (the first without one), in no order that counts.
[[nodiscard]] std::vector<TruthObject> evaluatePose(const TruthFile& file);

/// The scene as it is shown at `time` of an animation: poses and vertices.
[[nodiscard]] Scene sceneAt(const Scene& scene, const Animation* animation, double time);

/// The same objects as a loaded scene has them.
[[nodiscard]] std::vector<TruthObject> objectsOf(const Scene& scene);

/// How far a scene is off from the truth, each object against the one that is nearest to it.
struct PoseDifference {
    std::string problem; ///< empty, or why the two cannot be compared (other numbers of objects)
    std::string worst;   ///< the place of the largest difference
    Real size = 0;       ///< diagonal of the truth
    Real position = 0;   ///< largest distance of two corners over `size`
    Real normal = 0;     ///< largest distance of two unit normals times `steady`
    Real uv0 = 0, color = 0;
};
[[nodiscard]] PoseDifference compare(const std::vector<TruthObject>& truth,
                                     const std::vector<TruthObject>& found);

} // namespace touchstone::test
