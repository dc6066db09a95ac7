#pragma once
// What is studied: a scene, a path of the hand over it and, where there is one, its shape in closed form.

#include "study/timing/bench_scene.h"
#include "study/truth/truth_path.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::study {

struct Subject {
    BenchScene bench; ///< its name is the scene's
    std::string shape, path;
    double speed = 0.1;           ///< m/s, with which bench.stroke is taken
    truth::SmoothShapePtr smooth; ///< null: the mesh is all there is
    truth::Bump bump;             ///< what its height map means; empty: none, or no more than its texels say
    std::vector<std::string> notes;

    /// Where the hand is at `time`, s: it comes down from above.
    [[nodiscard]] glm::dvec3 hand(double time) const;
};

/// A shape in closed form that can be cut into any number of triangles.
struct ShapeKind {
    std::string_view name, what;
    size_t triangles; ///< by default
    bool round;       ///< so that more triangles come nearer to it
    Subject (*make)(size_t triangles);
};
[[nodiscard]] std::span<const ShapeKind> shapeKinds();

/// A glTF file, fitted to the workspace and stroked as `run` strokes it. Throws Error where it cannot be
/// loaded or touched. Moving objects stay in rest pose. `name`: what the results call it; empty: the file's
/// name.
[[nodiscard]] Subject loadSubject(const std::filesystem::path& file, const std::string& name = "");

/// 64800 as "64,800".
[[nodiscard]] std::string grouped(size_t value);

} // namespace touchstone::study
