#include "tests/stability/moving_world.h"

#include "study/truth/brute_force.h"
#include "tests/support/allocation_counter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace touchstone::test {

using namespace truth;

namespace {

glm::dmat4 matrixOf(const Similarity& pose) {
    glm::dmat4 matrix = glm::mat4_cast(pose.rotation);
    matrix[3] = glm::dvec4(pose.translation, 1.0);
    return matrix;
}

Scene sceneOfBoxes(const std::vector<MovingWorld::Box>& boxes, int cells) {
    // All meshes stand upright at the origin: the poses are the motions'.
    Scene scene = sceneOf(assets::box(boxes[0].sides, static_cast<uint32_t>(cells)), matrixOf(Similarity{}));
    for (size_t k = 1; k < boxes.size(); ++k)
        addShape(scene, assets::box(boxes[k].sides, static_cast<uint32_t>(cells)), matrixOf(Similarity{}));
    return scene;
}

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

} // namespace

Similarity posed(const glm::dvec3& at, double angle, const glm::dvec3& axis) {
    return {1.0, glm::angleAxis(angle, axis), at};
}

MovingWorld::MovingWorld(const Variant& variant, std::vector<Box> all, int cells)
    : boxes(std::move(all)), bench(sceneOfBoxes(boxes, cells), variant.settings()), radius(variant.radius) {
    for (const ObjectMotion& rest : bench.scene->restMotions)
        unitSize_.push_back(rest.workspaceFromObject.scale);
}

const HapticOutput& MovingWorld::step(const glm::dvec3& hip) {
    const bool first = bench.motions.empty();
    bench.motions.resize(boxes.size());
    for (size_t k = 0; k < boxes.size(); ++k) {
        ObjectMotion& motion = bench.motions[k];
        Similarity now = boxes[k].pose;
        now.scale *= unitSize_[k];
        motion.before = first ? now : motion.workspaceFromObject;
        motion.workspaceFromObject = now;
        motion.jumped = boxes[k].jumped;
        boxes[k].jumped = false;
    }
    const uint64_t allocations = allocationsOnThisThread();
    bench.step(hip);
    EXPECT_EQ(allocationsOnThisThread(), allocations);
    const HapticOutput& out = bench.output;
    EXPECT_TRUE(finite(out.proxy) && finite(out.force) && finite(out.commandInWorkspace) &&
                finite(out.normal));
    if (!first)
        largestStep = std::max(largestStep, glm::length(out.force - lastForce_));
    lastForce_ = out.force;
    ++ticks;
    pinchedTicks += jammed();
    contactTicks += out.contacts > 0;
    for (size_t k = 0; k < boxes.size() && !has(out.flags, TickFlag::StartedInside); ++k)
        if (!bench.state[0].jammed.holds(static_cast<int>(k))) {
            EXPECT_GE(clearance(k), radius - 1e-9) << "box " << k << " at tick " << ticks;
        }
    return out;
}

double MovingWorld::clearance(size_t k) const {
    const Similarity& pose = bench.motions[k].workspaceFromObject;
    const Similarity inverse = pose.inverse();
    const LVec3 p(inverse.point(bench.output.proxy));
    const LVec3 beyond = glm::abs(p) - LVec3(0.5 * boxes[k].sides / unitSize_[k]);
    const auto distance =
        static_cast<double>(bruteNearest(*bench.scene->objects[k], p).distance) * pose.scale;
    return std::max({beyond.x, beyond.y, beyond.z}) < 0.0L ? -distance : distance;
}

} // namespace touchstone::test
