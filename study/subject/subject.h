#pragma once
// The subject of a study: a scene, a path of the hand over it and, where known, its shape in closed form.

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
    double speed = 0.1;           ///< m/s, along bench.stroke
    truth::SmoothShapePtr smooth; ///< null: no closed form
    truth::Bump bump;             ///< closed form of its height map; empty: none, or none beyond its texels
    std::vector<std::string> notes;

    /// Position of the hand at `time`, s; it descends from above.
    [[nodiscard]] glm::dvec3 hand(double time) const;
};

/// A closed-form shape with arbitrary tessellation.
struct ShapeKind {
    std::string_view name, what;
    size_t triangles; ///< default
    bool round;       ///< curved: more triangles approximate it better
    Subject (*make)(size_t triangles);
};
[[nodiscard]] std::span<const ShapeKind> shapeKinds();

/// A glTF file, fitted to the workspace and stroked as in `run`. Throws Error where it cannot be loaded or
/// touched. Moving objects stay in rest pose. `name`: its name in the results; empty: the file's name.
[[nodiscard]] Subject loadSubject(const std::filesystem::path& file, const std::string& name = "");

/// 64800 as "64,800".
[[nodiscard]] std::string grouped(size_t value);

} // namespace touchstone::study
