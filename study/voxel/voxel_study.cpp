#include "study/voxel/voxel_study.h"

#include "engine/core/error.h"
#include "engine/time/seconds_now.h"
#include "haptics/scene/built_for.h"
#include "haptics/scene/shape_object.h"
#include "haptics/shape/field/mesh_to_field.h"
#include "study/ablation/ablation.h"
#include "study/errors/compare.h"
#include "study/errors/feel.h"
#include "study/timing/clock_cost.h"
#include "study/timing/configurations.h"
#include "study/timing/step_figures.h"
#include "study/voxel/tricubic_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace touchstone::study {

namespace {

constexpr double kVoxelTick = 1e-3, kHandSpeed = 0.1;   // s, m/s
constexpr double kHandAbove = 0.02, kHandDescent = 0.1; // m, m/s
constexpr double kPlainStiffness = 600.0;               // N/m, as in kPlainSettings
constexpr size_t kMeshOracleWork = 100'000'000;         // truth::oraclePath
constexpr int kTorusAcross = 256;                       // VoxelOptions::torusTriangles
constexpr const char* kPlainSettings =
    "texture=off friction=off stiffness=600 damping=0 proxyRadius=0 forceShading=off contact=sweep";

/// A way to touch. `fields`: fields only.
struct VoxelMethod {
    const char *name, *settings;
    bool fields, tricubic;
};
constexpr VoxelMethod kVoxelMethods[]{
    {"sweep", "", false, false},
    {"sweep, two-pass", "forceShading=twoPass", false, false},
    {"virtual point", "contact=virtualPoint", true, false},
    {"virtual point, tricubic", "contact=virtualPoint", true, true},
};
constexpr const char* kOnMesh = "mesh"; ///< before the method's name

/// A configuration to be felt and timed.
struct VoxelCase {
    VoxelResult result;
    BenchScene scene;
    HapticSettings settings;
    std::shared_ptr<const std::vector<truth::FeltTick>> truth;
};

HapticSettings voxelSettings(const VoxelMethod& method) {
    HapticSettings settings;
    applySettings(settings, kPlainSettings);
    applySettings(settings, method.settings);
    return settings;
}

/// m, the grid's frame: the box of the turned shape.
glm::dvec3 halfInGrid(const VoxelShape& shape) {
    const glm::dmat3 turn = glm::mat3_cast(glm::conjugate(shape.gridTurn));
    glm::dvec3 half(0.0);
    for (int axis = 0; axis < 3; ++axis)
        half += glm::abs(turn[axis]) * shape.half[axis];
    return half;
}

/// The unit of the object is the shape's diagonal.
std::shared_ptr<const FieldGrid> gridOfShape(const VoxelShape& shape, int across) {
    const double diagonal = shape.diagonal(), voxel = 1.0 / across;
    const FieldDepths depths = fieldDepths();
    // As fieldObject: proxies of any size, and clamped values away from the surface's cells.
    const double outside = std::max(depths.outside / diagonal, 2.0 * voxel),
                 inside = std::max(depths.inside / diagonal, 2.0 * voxel);
    const glm::dvec3 room = halfInGrid(shape) / diagonal + outside + 2.0 * voxel;
    FieldLayout layout{.origin = -room, .voxel = voxel};
    layout.cells = glm::ivec3(glm::ceil(2.0 * room / voxel));
    return std::make_shared<const FieldGrid>(
        gridOfDistance(layout, inside, outside, [&](const glm::dvec3& p) {
            return shape.distance(shape.gridTurn * (diagonal * p)) / diagonal;
        }));
}

/// The shape's study: cases first, then their errors and times.
class VoxelRun {
  public:
    VoxelRun(const VoxelShape& shape, const VoxelOptions& options, std::vector<std::string>& notes)
        : shape_(shape), options_(options), notes_(notes) {
        for (size_t i = 0; i < options.errorTicks; ++i) {
            const double time = kVoxelTick * static_cast<double>(i);
            hips_.push_back(shape.stroke(kHandSpeed * time, std::max(0.0, kHandAbove - kHandDescent * time)));
        }
        if (shape.mesh)
            mesh_ = shapeScene(shape.name, shape.mesh(shape.triangles), shape.stroke);
        const truth::RestPath rests = shape.smooth != nullptr
                                          ? truth::smoothPath(*shape.smooth, hips_, 0.0)
                                          : truth::oraclePath(*mesh_.haptic, 0, hips_, 0.0, kMeshOracleWork);
        exact_ = shared(truth::springForces(rests, hips_, kPlainStiffness, 0.0));
    }

    void plan(const std::function<void(double)>& progress) {
        if (options_.meshes && shape_.mesh)
            addMesh();
        double done = 0.0;
        for (const int across : options_.across) {
            addClosedForm(across);
            if (options_.meshes && shape_.mesh)
                addFromMesh(shape_.triangles, across);
            progress(++done / static_cast<double>(options_.across.size()));
        }
        if (options_.meshes && shape_.name == "torus")
            for (const size_t triangles : options_.torusTriangles)
                addFromMesh(triangles, kTorusAcross);
    }

    void measure(const std::function<void(double)>& progress) {
        double done = 0.0;
        for (VoxelCase& c : cases_) {
            addErrors(c);
            progress(0.3 * ++done / static_cast<double>(cases_.size()));
        }
        if (options_.rounds > 0)
            addTimes([&](double share) { progress(0.3 + 0.7 * share); });
    }

    [[nodiscard]] std::vector<VoxelResult> results() const {
        std::vector<VoxelResult> all;
        for (const VoxelCase& c : cases_)
            all.push_back(c.result);
        return all;
    }

  private:
    using Truth = std::shared_ptr<const std::vector<truth::FeltTick>>;
    static Truth shared(std::vector<truth::FeltTick> ticks) {
        return std::make_shared<const std::vector<truth::FeltTick>>(std::move(ticks));
    }

    void addMesh() {
        for (const VoxelMethod& method : kVoxelMethods) {
            if (method.fields)
                continue;
            VoxelResult result;
            result.source = kFromClosedForm;
            result.method = std::string(kOnMesh) + ", " + method.name;
            result.triangles = mesh_.triangles();
            cases_.push_back({result, mesh_, voxelSettings(method), exact_});
        }
    }

    /// Null, and a note, where the field would have more cells than it may.
    std::shared_ptr<const FieldGrid> built(VoxelResult& result, int across,
                                           const std::function<std::shared_ptr<const FieldGrid>()>& build) {
        const double begin = secondsNow();
        try {
            auto grid = build();
            result.build = secondsNow() - begin;
            return grid;
        } catch (const Error& error) {
            notes_.push_back(shape_.name + " from its " + result.source + ", " + std::to_string(across) +
                             " voxels across: " + error.what());
            return nullptr;
        }
    }

    void addClosedForm(int across) {
        VoxelResult result;
        result.source = kFromClosedForm;
        if (const auto grid = built(result, across, [&] { return gridOfShape(shape_, across); }))
            addField(result, grid, Similarity{shape_.diagonal(), shape_.gridTurn, glm::dvec3(0.0)}, exact_,
                     true);
    }

    /// Turned against the world as the closed form's grid is.
    void addFromMesh(size_t triangles, int across) {
        assets::Shape mesh = shape_.mesh(triangles);
        const BenchScene upright = shapeScene(shape_.name, mesh, shape_.stroke);
        const glm::dquat back = glm::conjugate(shape_.gridTurn);
        for (glm::vec3& p : mesh.positions)
            p = glm::vec3(back * glm::dvec3(p));
        for (glm::vec3& n : mesh.normals)
            n = glm::vec3(back * glm::dvec3(n));
        const BenchScene turned = shapeScene(shape_.name, std::move(mesh), shape_.stroke);
        const HapticObject& object = *turned.haptic->objects.front();
        const double scale = object.workspaceFromObject.scale;
        const FieldRequest usual;
        const FieldRequest request{.voxel = shape_.diagonal() / across / scale,
                                   .inside = std::min(1.0, fieldDepths().inside / scale),
                                   .outside = std::max(usual.outside, fieldDepths().outside / scale)};
        VoxelResult result;
        result.source = kFromMesh;
        result.triangles = upright.triangles();
        const auto grid = built(result, across, [&] { return fieldOfMesh(object, request); });
        if (grid == nullptr)
            return;
        const Similarity turn{1.0, shape_.gridTurn, glm::dvec3(0.0)};
        addField(result, grid, turn * object.workspaceFromObject,
                 shared(feel(*upright.haptic, voxelSettings(kVoxelMethods[0]), hips_).ticks), false);
    }

    void addField(VoxelResult result, const std::shared_ptr<const FieldGrid>& grid, const Similarity& placed,
                  const Truth& truth, bool allMethods) {
        result.voxel = placed.scale * grid->layout().voxel;
        result.across = shape_.diagonal() / result.voxel;
        result.memory = static_cast<double>(grid->memoryBytes());
        const auto field = std::make_shared<const FieldShape>(grid);
        for (const VoxelMethod& method : kVoxelMethods) {
            if (!allMethods && (method.tricubic || method.settings[0] != '\0'))
                continue;
            std::shared_ptr<const Shape> shape = field;
            if (method.tricubic)
                shape = std::make_shared<const TricubicField>(field);
            result.method = method.name;
            cases_.push_back({result, fieldScene(shape_.name, shape, placed, shape_.stroke),
                              voxelSettings(method), truth});
        }
    }

    void addErrors(VoxelCase& c) {
        buildFor(*c.scene.haptic, c.settings);
        const std::vector<truth::FeltTick> felt = feel(*c.scene.haptic, c.settings, hips_).ticks;
        const Errors errors = compareWithTruth(hips_, *c.truth, felt);
        VoxelResult& result = c.result;
        result.shape = shape_.name;
        result.position = errors.position;
        result.direction = errors.forceDirection;
        result.contactLost = errors.contactLost;
        double compared = 0.0;
        for (size_t i = 0; i < hips_.size(); ++i) {
            const truth::FeltTick& right = (*c.truth)[i];
            if (right.failed || !right.contact || !felt[i].contact)
                continue;
            ++compared;
            result.meanPosition += glm::distance(felt[i].proxy, right.proxy);
            const double off = std::abs(shape_.distance(felt[i].proxy));
            result.meanSurface += off;
            result.maxSurface = std::max(result.maxSurface, off);
        }
        result.meanPosition /= std::max(1.0, compared);
        result.meanSurface /= std::max(1.0, compared);
    }

    void addTimes(const std::function<void(double)>& progress) {
        std::vector<TimedConfiguration> timed;
        for (const VoxelCase& c : cases_)
            timed.push_back({c.result.method, &c.scene, c.settings, kHandSpeed});
        const BenchPlan plan{.rounds = options_.rounds,
                             .ticksPerRound = options_.ticksPerRound,
                             .stages = true,
                             .ahead = static_cast<uint64_t>(options_.ticksPerRound) / 2 + 1};
        const std::vector<ConfigurationTimes> times = timeConfigurations(timed, plan, progress);
        const auto clock = static_cast<double>(clockCostNs());
        for (size_t i = 0; i < cases_.size(); ++i) {
            VoxelResult& result = cases_[i].result;
            result.step = figuresOf(times[i].rounds, clock).median;
            if (times[i].step.empty())
                continue;
            result.stepP99 = times[i].p99() - clock;
            if (!times[i].ray.empty())
                result.rayFloor = times[i].rayMedian() - clock;
        }
    }

    const VoxelShape& shape_;
    const VoxelOptions& options_;
    std::vector<std::string>& notes_;
    std::vector<glm::dvec3> hips_;
    BenchScene mesh_;
    Truth exact_;
    std::vector<VoxelCase> cases_;
};

} // namespace

std::vector<VoxelResult> studyVoxelsOf(const VoxelShape& shape, const VoxelOptions& options,
                                       std::vector<std::string>& notes,
                                       const std::function<void(double)>& progress) {
    VoxelRun study(shape, options, notes);
    study.plan([&](double share) { progress(0.3 * share); });
    study.measure([&](double share) { progress(0.3 + 0.7 * share); });
    return study.results();
}

std::vector<VoxelResult> studyVoxels(const VoxelOptions& options, std::vector<std::string>& notes,
                                     const std::function<void(double)>& progress) {
    std::vector<VoxelResult> all;
    const std::vector<VoxelShape> shapes = voxelShapes();
    double done = 0.0;
    for (const VoxelShape& shape : shapes) {
        const std::vector<VoxelResult> results = studyVoxelsOf(shape, options, notes, [&](double share) {
            progress((done + share) / static_cast<double>(shapes.size()));
        });
        all.insert(all.end(), results.begin(), results.end());
        ++done;
    }
    return all;
}

double voxelOrder(const std::vector<VoxelResult>& results, const std::string& shape,
                  const std::string& source, const std::string& method, double VoxelResult::*error) {
    const VoxelResult *coarsest = nullptr, *finest = nullptr;
    for (const VoxelResult& r : results) {
        if (r.shape != shape || r.source != source || r.method != method || !(r.voxel > 0.0))
            continue;
        if (coarsest == nullptr || r.voxel > coarsest->voxel)
            coarsest = &r;
        if (finest == nullptr || r.voxel < finest->voxel)
            finest = &r;
    }
    if (coarsest == finest)
        return std::numeric_limits<double>::quiet_NaN();
    return std::log(coarsest->*error / (finest->*error)) / std::log(coarsest->voxel / finest->voxel);
}

} // namespace touchstone::study
