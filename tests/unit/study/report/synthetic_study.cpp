#include "tests/unit/study/report/synthetic_study.h"

#include "study/report/fields.h"

#include <cmath>
#include <concepts>
#include <limits>

namespace touchstone::study::test {

namespace {

/// Gives every field that it visits a value of its own.
class Filler {
  public:
    template <class Value>
    void operator()(std::string_view name, std::string_view, Value& value) {
        if constexpr (requires(Filler f) { visitFields(f, value); })
            visitFields(*this, value);
        else
            fill(std::string(name), value);
    }

  private:
    template <class Element>
    void fill(const std::string& name, std::vector<Element>& values) {
        for (int i = 0; i < 2; ++i)
            (*this)(name, "", values.emplace_back());
    }
    void fill(const std::string&, double& value) { value = 1.0 / ++count_; }
    void fill(const std::string&, bool& value) { value = ++count_ % 2 == 0; }
    void fill(const std::string&, Truth& value) { value = Truth::Reference; }
    void fill(const std::string& name, std::string& value) {
        value = name + " \"" + std::to_string(++count_) + "\", µm\nline";
    }
    template <std::integral Integer>
    void fill(const std::string&, Integer& value) {
        value = std::numeric_limits<Integer>::max() - static_cast<Integer>(++count_);
    }

    int count_ = 6;
};

} // namespace

StudyResult everyField() {
    StudyResult result;
    Filler fill;
    visitFields(fill, result);
    return result;
}

namespace {

ConfigurationResult resultOf(const std::string& scene, const std::string& ablation,
                             const std::string& configuration, double ns, double error) {
    ConfigurationResult r;
    r.scene = r.shape = scene;
    r.triangles = 64'800;
    r.path = "stroke 1 mm deep, 0.1 m/s";
    r.ablation = ablation;
    r.configuration = configuration;
    r.settings = "contact=sweep";
    r.step = {ns, 0.97 * ns, 1.03 * ns};
    r.stepMean = {1.1 * ns, 1.08 * ns, 1.12 * ns};
    r.stepP99 = 2.0 * ns;
    for (Estimate& stage : r.stages)
        stage = {1.1 * ns / kStageCount, 0.0, 0.0};
    r.rayFloor = 150.0;
    r.errors.position = r.errors.force = r.errors.forceDirection = {0.5 * error, error, 3.0 * error};
    r.errors.ticks = r.errors.compared = 4000;
    return r;
}

void addScene(StudyResult& result, const std::string& scene) {
    for (const double error : {0.0, 1e-13, 2e-3})
        result.configurations.push_back(
            resultOf(scene, "contact", "e " + std::to_string(error), 400.0 + 1e4 * error, error));
    result.configurations.back().isDefault = true;
    result.configurations.push_back(
        resultOf(scene, "friction `touch gotcha`", "Coulomb's \"law\" <&>", 700.0, 1e-2));
    for (int i = 0; i < 24; ++i)
        result.configurations.push_back(resultOf(scene, "combination", "rung " + std::to_string(i),
                                                 300.0 + 37.0 * ((7 * i) % 24),
                                                 1e-5 * std::pow(1.7, (13 + 11 * i) % 24)));
    for (const size_t triangles : {1'024, 16'384, 262'144})
        for (const double share : {1.0, 0.03}) {
            result.configurations.push_back(resultOf(scene + " " + std::to_string(triangles), "tessellation",
                                                     share == 1.0 ? "flat" : "two-pass", 500.0,
                                                     share / std::sqrt(triangles)));
            result.configurations.back().shape = scene;
            result.configurations.back().triangles = triangles;
            result.configurations.back().facetAngle = 4.0 / std::sqrt(static_cast<double>(triangles));
        }
}

} // namespace

StudyResult likeMeasured() {
    StudyResult result;
    result.provenance.processor = "A processor's name";
    result.provenance.compiler = "gcc";
    result.provenance.commit = "0a1b2c";
    result.noticeable = {{"force", "N", "somebody 1999", 0.04},
                         {"force direction", "rad", "another 2006", 0.5},
                         {"facet angle, no shading", "rad", "[004 Table 2], force only (C1)", 0.0087},
                         {"facet angle, force shading", "rad", "[004 Table 2], shaded (C2)", 0.059}};
    addScene(result, "torus 64,800");
    addScene(result, "it's `touch gotcha` $(touch gotcha) \"<&>\" µ\n\\.glb");
    for (const double hz : {500.0, 1000.0, 2000.0, 4000.0})
        result.rates.push_back({hz, 9.0 * hz, 6.0 * hz, 1e-3 / hz, {6e-7 * hz, 5e-7 * hz, 7e-7 * hz}});
    for (const char* shape : {"torus", "groove"})
        for (const char* method : {"sweep", "virtual point"})
            for (const double across : {64.0, 128.0}) {
                VoxelResult& voxel = result.voxels.emplace_back();
                voxel.shape = shape;
                voxel.source = kFromClosedForm;
                voxel.method = method;
                voxel.across = across;
                voxel.voxel = 0.2 / across;
                voxel.meanPosition = 1e-3 * voxel.voxel;
            }
    return result;
}

} // namespace touchstone::study::test
