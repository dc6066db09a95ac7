#include "tests/property/effects/effect_trial.h"

#include "tests/support/surface_hand.h"
#include "tests/support/touch_bench.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

namespace touchstone::test {

namespace {

constexpr double kDt = 1e-3;

/// From `path`, a tap, the same with some turns about its deepest place.
std::vector<glm::dvec3> withCircles(const std::vector<glm::dvec3>& path, double radius, double speed,
                                    std::mt19937& random) {
    size_t deepest = 0;
    for (size_t i = 1; i < path.size(); ++i)
        if (glm::length(path[i] - path[0]) > glm::length(path[deepest] - path[0]))
            deepest = i;
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const glm::dvec3 a = glm::normalize(glm::dvec3(any(random), any(random), any(random) + 1e-3));
    const glm::dvec3 b =
        glm::normalize(glm::cross(a, glm::dvec3(any(random), any(random) + 1e-3, any(random))));
    std::vector<glm::dvec3> result(path.begin(), path.begin() + static_cast<ptrdiff_t>(deepest) + 1);
    const double turn = speed * kDt / radius;
    constexpr int kTicks = 300;
    for (int i = 0; i < kTicks; ++i) {
        const double grown = std::min(1.0, i / 50.0);
        result.push_back(path[deepest] + grown * radius * (std::cos(i * turn) * a + std::sin(i * turn) * b));
    }
    result.insert(result.end(), path.begin() + static_cast<ptrdiff_t>(deepest), path.end());
    return result;
}

/// Each object sways by millimetres and hundredths of a radian, with a phase of its own.
Similarity swayed(const Similarity& rest, size_t k, double time) {
    const double phase = 2.4 * static_cast<double>(k), w = 9.0;
    Similarity pose = rest;
    pose.translation += 2e-3 * glm::dvec3(std::sin(w * time + phase), std::sin(0.7 * w * time + 2.0 * phase),
                                          std::cos(0.9 * w * time + phase));
    pose.rotation =
        glm::angleAxis(0.05 * std::sin(w * time + phase), glm::dvec3(0.6, 0.8, 0.0)) * pose.rotation;
    return pose;
}

/// A slew limit that is met, too.
const DeviceLimits kLimits{.maxForceRate = 2000.0};

class EffectTrial {
  public:
    EffectTrial(const EffectCase& c, const EffectWorld& world, unsigned seed, ContactMethod contact)
        : case_(c), world_(world), scene_(c.oneSided ? *world.frontOnly : *world.bothSides),
          settings_(c.settings(seed)), state_(1), motions_(scene_.restMotions) {
        settings_.contact = contact;
        figures.name = c.name();
        if (c.moving)
            for (size_t k = 0; k < motions_.size(); ++k)
                motions_[k].workspaceFromObject = swayed(scene_.restMotions[k].workspaceFromObject, k, 0.0);
    }

    void tick(const glm::dvec3& hip) {
        if (case_.moving)
            for (size_t k = 0; k < motions_.size(); ++k) {
                motions_[k].before = motions_[k].workspaceFromObject;
                motions_[k].workspaceFromObject =
                    swayed(scene_.restMotions[k].workspaceFromObject, k, static_cast<double>(tick_) * kDt);
            }
        DeviceSample sample;
        sample.position = hip;
        sample.valid = true;
        sample.limits = kLimits;
        TickInput input;
        input.tick = tick_;
        input.time = static_cast<double>(tick_) * kDt;
        input.dt = kDt;
        input.hands = {&sample, 1};
        if (case_.moving)
            worldState_.place(motions_);
        NoStopwatch none;
        hapticStep(scene_, settings_, input, worldState_, state_, {&output_, 1}, none);
        ++tick_;
        checkLimits();
        if (state_[0].placed)
            checkPlace();
    }
    [[nodiscard]] bool placed() const { return state_[0].placed; }
    void forget() { state_[0].forgetTouch(); }

    EffectFigures figures;

  private:
    void checkLimits() {
        const glm::dvec3 force = output_.command.force();
        const double strength = glm::length(force), change = glm::length(force - last_);
        const double most = kLimits.maxForce, fastest = kLimits.maxForceRate * kDt;
        if (!(strength <= most * (1.0 + 1e-12)) || !(change <= fastest * (1.0 + 1e-9)) ||
            !std::isfinite(glm::length(output_.force)) || !std::isfinite(glm::length(output_.proxy)))
            ++figures.limits;
        figures.strongest = std::max(figures.strongest, strength);
        figures.fastest = std::max(figures.fastest, change);
        last_ = force;
    }

    /// Of the proxy in the frame of object k: a point is a very small ball, as small as the object asks.
    [[nodiscard]] double radius(const HapticObject& object) const {
        const double skin = 0.5 * kWeldTolerance * object.diagonal * object.workspaceFromObject.scale;
        return settings_.contact == ContactMethod::Sweep ? std::max(settings_.proxyRadius, skin) : 0.0;
    }

    void checkPlace() {
        ++figures.ticks;
        const bool cut = has(output_.flags, TickFlag::BudgetReached);
        if (has(output_.flags, TickFlag::CandidatesFull) || has(output_.flags, TickFlag::Jammed)) {
            figures.contact += output_.contacts > 0 ? 1 : 0;
            ++figures.exempt;
            return;
        }
        if (output_.contacts == 0) {
            if (output_.penetration > kCertificate && !cut) {
                ++figures.left;
                figures.worst = std::max(figures.worst, output_.penetration);
            }
            return;
        }
        ++figures.contact;
        figures.moves += output_.iterations;
        figures.budget += cut ? 1 : 0;
        figures.notConverged += has(output_.flags, TickFlag::ShadingNotConverged) ? 1 : 0;
        const double r = radius(*scene_.objects[static_cast<size_t>(state_[0].reference)]);
        const EffectWorld::Place place =
            world_.measure(output_.proxy, case_.moving ? ObjectMotions(motions_) : scene_.restMotions, r,
                           case_.oneSided && r > 0.0);
        // What is one-sided may be half passed, from behind. The radius may be that of the last reference
        // object.
        if (!case_.oneSided) {
            double least = r;
            for (const auto& object : scene_.objects)
                least = std::min(least, radius(*object));
            figures.inside = std::max(figures.inside, least - place.nearest);
        }
        if (!(place.off > kCertificate))
            return;
        ++(cut ? figures.late : figures.off);
        double& worst = cut ? figures.latest : figures.worst;
        worst = std::max(worst, place.off);
    }

    const EffectCase& case_;
    const EffectWorld& world_;
    const HapticScene& scene_;
    HapticSettings settings_;
    std::vector<DeviceState> state_;
    WorldState worldState_;
    HapticOutput output_;
    std::vector<ObjectMotion> motions_;
    glm::dvec3 last_{0.0};
    uint64_t tick_ = 0;
};

HandOptions handOf(const EffectCase& c, const EffectWorld& world) {
    switch (c.stroke) {
    case EffectStroke::Shallow:
        return {.speed = 0.1, .depth = 1e-3, .height = 4.3e-3, .length = 10e-3};
    case EffectStroke::Deep:
        return {.speed = 0.4, .depth = 0.95 * world.bodyRadius, .height = 4.3e-3, .length = 0.0};
    case EffectStroke::Fast:
        return {.speed = 2.0, .depth = 4e-3, .height = 9.1e-3, .length = 120e-3};
    }
    return {};
}

} // namespace

EffectFigures& EffectFigures::operator+=(const EffectFigures& other) {
    ticks += other.ticks;
    contact += other.contact;
    budget += other.budget;
    exempt += other.exempt;
    notConverged += other.notConverged;
    off += other.off;
    late += other.late;
    left += other.left;
    worst = std::max(worst, other.worst);
    latest = std::max(latest, other.latest);
    inside = std::max(inside, other.inside);
    limits += other.limits;
    strongest = std::max(strongest, other.strongest);
    fastest = std::max(fastest, other.fastest);
    moves += other.moves;
    return *this;
}

EffectFigures runEffects(const EffectCase& c, unsigned seed, int contactTicks, ContactMethod contact) {
    const EffectWorld& world = *effectWorld(c.body);
    EffectTrial trial(c, world, seed, contact);
    const Similarity& frame = world.bothSides->objects[0]->workspaceFromObject;
    SurfaceHand hand(*world.whole, frame.scale, handOf(c, world), seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0.2, 1.0);
    // A hand that starts inside a body feels nothing: such strokes are left out.
    for (int strokes = 0;
         strokes < 200 && trial.figures.contact < contactTicks && trial.figures.ticks < 8 * contactTicks;
         ++strokes) {
        std::vector<glm::dvec3> path;
        for (const LVec3& hip : hand.stroke())
            path.push_back(glm::dvec3(LSimilarity(frame).point(hip)));
        if (c.stroke == EffectStroke::Deep)
            path = withCircles(path, 0.05 * world.bodyRadius, 0.5 * share(random), random);
        for (const glm::dvec3& hip : path) {
            trial.tick(hip);
            if (!trial.placed())
                break;
        }
        trial.forget();
    }
    return trial.figures;
}

EffectFigures followEffects(const EffectCase& c, unsigned seed, std::span<const glm::dvec3> path) {
    EffectTrial trial(c, *effectWorld(c.body), seed, ContactMethod::Sweep);
    for (const glm::dvec3& hip : path)
        trial.tick(hip);
    return trial.figures;
}

std::string effectHead() {
    char line[300];
    std::snprintf(line, sizeof line, "%-58s %7s %7s %5s %8s %6s %6s %8s %6s %8s %8s %5s %5s", "case",
                  "contact", "budget", "exempt", "noconv", "off", "left", "worst m", "late", "latest m",
                  "inside m", "limit", "moves");
    return line;
}

std::string effectLine(const EffectFigures& f) {
    char line[300];
    std::snprintf(line, sizeof line, "%-58s %7d %7d %5d %8d %6d %6d %8.1e %6d %8.1e %8.1e %5d %5.1f",
                  f.name.c_str(), f.contact, f.budget, f.exempt, f.notConverged, f.off, f.left, f.worst,
                  f.late, f.latest, f.inside, f.limits, f.moves / std::max(1, f.contact));
    return line;
}

} // namespace touchstone::test
