#include "study/errors/feel.h"

#include "engine/core/float_mode.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/tick/stepped_hand.h"

#include <algorithm>
#include <cmath>

namespace touchstone::study {

namespace {

constexpr double kTick = 1e-3; // s

/// Angles between the facets that the proxy leaves and enters.
class FacetAngles {
  public:
    void meet(const HapticScene& scene, const HapticOutput& output) {
        if (output.contacts == 0 || output.object < 0 ||
            scene.objects[static_cast<size_t>(output.object)]->shape != nullptr) {
            object_ = -1;
            return;
        }
        if (output.object == object_ && output.triangle == triangle_)
            return;
        const HapticObject& object = *scene.objects[static_cast<size_t>(output.object)];
        const glm::dvec3 normal = triangleOf(object, static_cast<uint32_t>(output.triangle)).normal;
        constexpr double kLevel = 1e-5; // rad: float vertices of one plane
        if (output.object == object_) {
            const double angle =
                std::atan2(glm::length(glm::cross(normal, normal_)), glm::dot(normal, normal_));
            if (angle > kLevel) {
                sum_ += angle;
                ++count_;
            }
        }
        object_ = output.object;
        triangle_ = output.triangle;
        normal_ = normal;
    }
    [[nodiscard]] double mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : 0.0; }

  private:
    int object_ = -1, triangle_ = -1;
    glm::dvec3 normal_{0.0};
    double sum_ = 0.0;
    size_t count_ = 0;
};

} // namespace

FeltPath feel(const HapticScene& scene, const HapticSettings& settings, std::span<const glm::dvec3> hips) {
    enterFloatMode();
    FeltPath path;
    path.ticks.reserve(hips.size());
    FacetAngles angles;
    SteppedHand hand(scene);
    const HapticOutput& output = hand.output;
    StageTrace trace;
    std::vector<size_t> touched(scene.objects.size());
    for (size_t i = 0; i < hips.size(); ++i) {
        StageTracer tracer(hand.state, trace);
        (void)hand.step(settings, sampleAt(hips[i]), kTick, tracer);
        path.ticks.push_back({output.proxy, output.force, output.contacts > 0, false});
        angles.meet(scene, output);
        if (output.contacts > 0 && output.object >= 0)
            ++touched[static_cast<size_t>(output.object)];
    }
    path.object = static_cast<int>(std::max_element(touched.begin(), touched.end()) - touched.begin());
    path.facetAngle = angles.mean();
    return path;
}

} // namespace touchstone::study
