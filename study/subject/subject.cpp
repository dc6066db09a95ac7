#include "study/subject/subject.h"

#include "assets/shapes.h"
#include "devices/stroke/stroke_path.h"
#include "engine/core/error.h"
#include "engine/load/scene_loader.h"
#include "engine/scene/animation.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone::study {

namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kDepth = 1e-3;                    // m below the surface
constexpr double kApproach = 0.02, kDescent = 0.1; // m, m/s
constexpr double kRing = 0.060, kTube = 0.025;     // m, the torus of the issues
constexpr double kBall = 0.050, kRod = 0.025;      // m, radii
constexpr double kSheet = 0.2;                     // m, side of the flat shapes
constexpr double kAmplitude = 1e-3, kWave = 0.02;  // m
constexpr double kSlope = kPi / 6.0;               // of the wedge: 120 degrees between its faces
constexpr const char* kStroke = "stroke 1 mm deep, 0.1 m/s";

/// The side of a square of cells that yields about the given number of triangles.
uint32_t sideFor(size_t triangles, double perCell = 2.0) {
    return static_cast<uint32_t>(
        std::max(3L, std::lround(std::sqrt(static_cast<double>(triangles) / perCell))));
}

Subject subjectOf(std::string_view shape, assets::Shape mesh, BenchStroke stroke,
                  truth::SmoothShapePtr smooth) {
    const std::string name = std::string(shape) + " " + grouped(mesh.triangleCount());
    Subject subject;
    subject.bench = shapeScene(name, std::move(mesh), std::move(stroke));
    subject.shape = shape;
    subject.path = kStroke;
    subject.smooth = std::move(smooth);
    return subject;
}

/// A grid over the sheet's square with its own heights and normals, vertices on the surface.
template <class Height>
assets::Shape sheet(uint32_t columns, uint32_t rows, Height height) {
    assets::Shape shape;
    for (uint32_t j = 0; j <= rows; ++j)
        for (uint32_t i = 0; i <= columns; ++i) {
            const double x = kSheet * (static_cast<double>(i) / columns - 0.5);
            const double z = kSheet * (static_cast<double>(j) / rows - 0.5);
            const auto [y, slope] = height(x);
            shape.positions.emplace_back(x, y, z);
            shape.normals.emplace_back(glm::normalize(glm::dvec3(-slope, 1.0, 0.0)));
        }
    const auto at = [columns](uint32_t i, uint32_t j) { return j * (columns + 1) + i; };
    for (uint32_t j = 0; j < rows; ++j)
        for (uint32_t i = 0; i < columns; ++i)
            for (const uint32_t corner :
                 {at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i + 1, j)})
                shape.indices.push_back(corner);
    return shape;
}

/// A triangle wave between -1 and 1, of period 4.
double backAndForth(double way) {
    const double turn = way - 4.0 * std::floor(0.25 * way);
    return turn < 1.0 ? turn : turn < 3.0 ? 2.0 - turn : turn - 4.0;
}

Subject planeSubject(size_t triangles) {
    constexpr double kCircle = 0.03;
    const uint32_t side = triangles <= 2 ? 1 : sideFor(triangles);
    return subjectOf(
        "plane", assets::plane(kSheet, kSheet, side, side),
        [](double metres, double lift) {
            const double a = metres / kCircle;
            return glm::dvec3(kCircle * std::cos(a), lift - kDepth, kCircle * std::sin(a));
        },
        truth::smoothPlane());
}

/// The plane with a height map of two crossed waves, 32 texels long: filters and gradients are compared with
/// the waves themselves.
Subject reliefSubject(size_t triangles) {
    constexpr int kTexels = 256, kWaves = 8;
    constexpr double kScale = 0.5e-3; // m, from the lowest point to the highest
    // A texel's centre lies on every crest and in every trough, so that the map contains the minimum.
    const auto phase = [](double u) { return 2.0 * kPi * kWaves * (u - 0.5 / kTexels); };
    const uint32_t side = triangles <= 2 ? 1 : sideFor(triangles);
    Subject subject = planeSubject(triangles);
    subject.shape = "relief";
    assets::Shape sheetOfWaves = assets::plane(kSheet, kSheet, side, side);
    const std::string name = "relief " + grouped(sheetOfWaves.triangleCount());
    subject.bench = reliefScene(
        name, std::move(sheetOfWaves), subject.bench.stroke, kTexels, kScale,
        [phase](double u, double v) { return 0.5 + 0.25 * (std::cos(phase(u)) + std::cos(phase(v))); });
    subject.bump = [phase](const glm::dvec3& place) {
        const double a = phase(place.x / kSheet + 0.5), b = phase(place.z / kSheet + 0.5);
        const double rise = 0.25 * kScale * 2.0 * kPi * kWaves / kSheet;
        return truth::BumpAt{kScale * (0.5 + 0.25 * (std::cos(a) + std::cos(b))),
                             glm::dvec3(-rise * std::sin(a), 0.0, -rise * std::sin(b))};
    };
    return subject;
}

/// Around the ball, slowly up and down between the 34th degrees of latitude.
Subject sphereSubject(size_t triangles) {
    const uint32_t side = sideFor(triangles);
    return subjectOf(
        "sphere", assets::sphere(kBall, side, side),
        [](double metres, double lift) {
            const double a = metres / kBall, tilt = 0.6 * std::sin(0.37 * a);
            return (kBall - kDepth + lift) *
                   glm::dvec3(std::cos(a) * std::cos(tilt), std::sin(tilt), std::sin(a) * std::cos(tilt));
        },
        truth::smoothSphere(kBall));
}

/// A helix that turns back before the ends.
Subject cylinderSubject(size_t triangles) {
    constexpr double kLength = 0.12;
    // Of 2 * rows * sides on the lateral surface; squares at 2 pi radius : length.
    const uint32_t sides = sideFor(triangles, 2.0 * kLength / (2.0 * kPi * kRod));
    const uint32_t rows = std::max(1u, static_cast<uint32_t>(triangles / (2 * static_cast<size_t>(sides))));
    return subjectOf(
        "cylinder", assets::prism(sides, kRod, kLength, true, rows),
        [](double metres, double lift) {
            const double a = metres / kRod, r = kRod - kDepth + lift;
            return glm::dvec3(r * std::cos(a), 0.3 * kLength * std::sin(0.13 * a), r * std::sin(a));
        },
        truth::smoothCylinder(kRod));
}

Subject torusSubject(size_t triangles) {
    Subject subject;
    subject.bench = torusScene(triangles);
    subject.bench.name = "torus " + grouped(subject.bench.triangles());
    subject.shape = "torus";
    subject.path = kStroke;
    subject.smooth = truth::smoothTorus(kRing, kTube);
    return subject;
}

/// Across the waves at constant depth, drifting along the crests.
Subject wavesSubject(size_t triangles) {
    const double wave = 2.0 * kPi / kWave;
    // Cells four times as long along the crests as across.
    const uint32_t rows = sideFor(triangles, 8.0), columns = 4 * rows;
    return subjectOf(
        "waves",
        sheet(columns, rows,
              [&](double x) {
                  return std::pair{kAmplitude * std::cos(wave * x), -kAmplitude * wave * std::sin(wave * x)};
              }),
        [wave](double metres, double lift) {
            constexpr double kHalf = 0.06;
            const double x = kHalf * backAndForth(metres / kHalf + 1.0);
            return glm::dvec3(x, kAmplitude * std::cos(wave * x) - kDepth + lift,
                              kHalf * std::sin(0.37 * metres / kHalf));
        },
        truth::smoothWaves(kAmplitude, kWave));
}

/// Over the ridge and back, 1 mm below either face, drifting along it.
Subject wedgeSubject(size_t triangles) {
    const double fall = std::tan(kSlope);
    const uint32_t side = sideFor(triangles, 2.0), columns = side + side % 2; // the ridge is an edge of the
                                                                              // mesh
    assets::Shape mesh = sheet(columns, side, [&](double x) { return std::pair{-std::fabs(x) * fall, 0.0}; });
    mesh.normals.clear(); // a ridge is not smooth
    return subjectOf(
        "wedge", std::move(mesh),
        [fall](double metres, double lift) {
            constexpr double kHalf = 0.03;
            const double x = kHalf * backAndForth(metres / kHalf + 1.0);
            return glm::dvec3(x, -std::fabs(x) * fall - kDepth / std::cos(kSlope) + lift,
                              kHalf * std::sin(0.37 * metres / kHalf));
        },
        truth::smoothWedge(kSlope));
}

constexpr std::array kKinds{
    ShapeKind{"plane", "a level sheet of 0.2 m", 2, false, planeSubject},
    ShapeKind{"sphere", "radius 50 mm", 1800, true, sphereSubject},
    ShapeKind{"cylinder", "radius 25 mm", 2048, true, cylinderSubject},
    ShapeKind{"torus", "ring 60 mm, tube 25 mm", 64800, true, torusSubject},
    ShapeKind{"waves", "a cosine of 1 mm every 20 mm", 12800, true, wavesSubject},
    ShapeKind{"relief", "the sheet with a height map of waves, 0.5 mm every 25 mm", 2, false, reliefSubject},
    ShapeKind{"wedge", "a ridge of 120 degrees", 512, false, wedgeSubject},
};

} // namespace

glm::dvec3 Subject::hand(double time) const {
    return bench.stroke(speed * time, std::max(0.0, kApproach - kDescent * time));
}

std::span<const ShapeKind> shapeKinds() {
    return kKinds;
}

Subject loadSubject(const std::filesystem::path& file, const std::string& name) {
    LoadOptions options;
    options.images.visual = false;
    const ScenePtr scene = loadScene(file, options);
    if (!scene->touchable())
        throw Error(file.string(), "", "nothing in it can be touched", "study a model that has triangles");
    const Similarity fit = workspaceFromScene(*scene, Fit::Workspace);
    Subject subject;
    const StrokeOptions stroke;
    subject.speed = stroke.speed;
    subject.shape = subject.bench.name = name.empty() ? file.filename().string() : name;
    subject.path = kStroke;
    subject.bench.haptic = compileHapticScene(*scene, fit);
    if (subject.bench.haptic->objects.empty())
        throw Error(file.string(), "", "nothing in it can be touched", "study a model that has triangles");
    auto path = std::make_shared<const StrokePath>(strokeOver(*scene, fit, stroke));
    subject.bench.stroke = [path, speed = stroke.speed](double metres, double) {
        return path->position(metres / speed); // the path includes its descent
    };
    if (playedAnimation(*scene) != nullptr)
        subject.notes.emplace_back("what moves stays in rest pose: so it has a truth");
    return subject;
}

std::string grouped(size_t value) {
    std::string text = std::to_string(value);
    for (size_t at = text.size(); at > 3; at -= 3)
        text.insert(at - 3, ",");
    return text;
}

} // namespace touchstone::study
