#include "tests/stability/trial.h"

#include <algorithm>
#include <cmath>

namespace touchstone::test {

std::string Variant::name() const {
    return std::string(radius > 0.0 ? "r 0.5 mm" : "r 0") + (shaded ? ", shaded" : ", flat");
}

HapticSettings Variant::settings() const {
    HapticSettings s;
    s.proxyRadius = radius;
    s.forceShading = shaded ? ShadingMode::TwoPass : ShadingMode::Off;
    s.texture = TextureMode::Off;
    s.friction = FrictionMode::Off;
    s.stiffness = 1000.0;
    return s;
}

std::vector<Variant> allVariants() {
    return {{0.0, false}, {0.0, true}, {0.5e-3, false}, {0.5e-3, true}};
}

const std::vector<double>& allSpeeds() {
    static const std::vector<double> speeds{0.05, 1.0, 5.0, 50.0};
    return speeds;
}

void Gauge::take(const HapticOutput& output) {
    ++measured_.ticks;
    if (output.contacts > 0)
        ++measured_.contactTicks;
    for (const glm::dvec3& v : {output.proxy, output.force, output.normal, output.commandInWorkspace})
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
            ++measured_.notFinite;
    if (has(output.flags, TickFlag::BudgetReached))
        ++measured_.budgetReached;
    if (!first_) {
        const glm::dvec3 moved = output.hip - lastHip_;
        measured_.energy += glm::dot(0.5 * (output.force + lastForce_), moved);
        const double jump = glm::length(output.force - lastForce_) - stiffness_ * glm::length(moved);
        measured_.largestJump = std::max(measured_.largestJump, jump);
    }
    first_ = false;
    lastHip_ = output.hip;
    lastForce_ = output.force;
}

assets::Shape soup(const std::vector<glm::dvec3>& corners) {
    assets::Shape shape;
    for (const glm::dvec3& p : corners) {
        shape.indices.push_back(static_cast<uint32_t>(shape.positions.size()));
        shape.positions.emplace_back(p);
    }
    return shape;
}

void addQuad(std::vector<glm::dvec3>& corners, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
             const glm::dvec3& d) {
    corners.insert(corners.end(), {a, b, c, a, c, d});
}

void append(assets::Shape& shape, const assets::Shape& other, const glm::dmat4& at) {
    const auto base = static_cast<uint32_t>(shape.positions.size());
    for (const glm::vec3& p : other.positions)
        shape.positions.emplace_back(glm::dvec3(at * glm::dvec4(glm::dvec3(p), 1.0)));
    shape.normals.clear();
    shape.uv.clear();
    shape.tangents.clear();
    for (const uint32_t i : other.indices)
        shape.indices.push_back(base + i);
}

double holdStill(TouchBench& bench, int ticks) {
    double largest = 0.0;
    glm::dvec3 last = bench.output.force;
    for (int i = 0; i < ticks; ++i) {
        bench.step(bench.output.hip);
        largest = std::max(largest, glm::length(bench.output.force - last));
        last = bench.output.force;
    }
    return largest;
}

} // namespace touchstone::test
