#include "tests/support/exact_trial.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdio>

namespace touchstone::test {

namespace {

/// A surface this near beyond the radius touches, object units: twice what the solver calls near. A surface
/// farther off must not be needed to explain why the proxy rests.
constexpr long double kTouching = 4e-12L;
/// Rounding of a goal and of a place in double, object units.
constexpr long double kRounding = 1e-15L;

HapticSettings bareSolve(double radius) {
    HapticSettings settings;
    settings.proxyRadius = radius;
    settings.forceShading = ShadingMode::Off;
    settings.friction = FrictionMode::Off;
    settings.deformation = false; // the proxy on the surface at rest
    return settings;
}

std::string text(const char* format, auto... values) {
    char line[400];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

} // namespace

ExactScene::ExactScene(const Scene& scene, Fit fit)
    : haptic_(compileHapticScene(scene, workspaceFromScene(scene, fit))),
      workspacePerFitted_(haptic_->workspaceFromScene.scale /
                          workspaceFromScene(scene, Fit::Workspace).scale) {}

const Soup& ExactScene::soup(int frame) {
    std::unique_ptr<Soup>& made = soups_[frame];
    if (!made)
        made = std::make_unique<Soup>(*haptic_, frame);
    return *made;
}

ExactTrial::ExactTrial(std::string name, ExactScene& scene, const ExactOptions& options)
    : scene_(scene), options_(options), bench_(scene.haptic(), bareSolve(options.radius)),
      behind_(scene.haptic(), bareSolve(options.radius)) {
    figures_.name = std::move(name);
    bench_.settings.proxyRadius = behind_.settings.proxyRadius = options.radius * scene.workspacePerFitted();
    smallestDiagonal_ = INFINITY;
    for (const auto& object : bench_.scene->objects)
        smallestDiagonal_ = std::min(smallestDiagonal_, object->diagonal * object->workspaceFromObject.scale);
}

void ExactTrial::forget() {
    closeParting();
    bench_.state[0].forgetTouch();
    behind_.state[0].forgetTouch();
    free_.reset();
}

void ExactTrial::fault(const std::string& what) {
    figures_.faults.push_back(figures_.name + " tick " + std::to_string(bench_.tick) + ": " + what);
}

ExactTrial::Frame ExactTrial::frame() {
    const int reference = bench_.state[0].reference;
    const HapticObject& object = *bench_.scene->objects[static_cast<size_t>(reference)];
    const double scale = object.workspaceFromObject.scale;
    Frame f;
    f.soup = &scene_.soup(reference);
    f.goal = LSimilarity(object.workspaceFromObject).inversePoint(LVec3(bench_.output.hip));
    f.radius = static_cast<long double>(
        std::max(bench_.settings.proxyRadius / scale, 0.5 * kWeldTolerance * object.diagonal));
    f.unit = static_cast<long double>(scale / scene_.workspacePerFitted());
    // Poses are doubles: what they lose of a goal far from the origin, and of other objects' places.
    const long double loss = 4.0L * static_cast<long double>(DBL_EPSILON / scale);
    f.aim = kRounding + loss * static_cast<long double>(glm::length(bench_.output.hip));
    f.placing = kRounding;
    if (bench_.scene->objects.size() > 1)
        for (const auto& other : bench_.scene->objects)
            f.placing =
                std::max(f.placing,
                         loss * static_cast<long double>(glm::length(other->workspaceFromObject.translation) +
                                                         other->workspaceFromObject.scale));
    f.tolerance = std::min(1e-6L * static_cast<long double>(smallestDiagonal_ / scale), 1e-6L / f.unit);
    return f;
}

/// The tick, and every place between its moves: the solve is anytime, so that a replay from the same state
/// with a budget of k moves ends where the k-th move of the whole tick ended. The replays are of a second
/// hand, one tick behind: a state holds megabytes, and most ticks of one move would copy it for nothing.
std::vector<glm::dvec3> ExactTrial::replay(const glm::dvec3& hip) {
    std::vector<glm::dvec3> places{bench_.state[0].proxy};
    bench_.step(hip);
    const uint32_t moves = bench_.output.iterations;
    if (moves > 1) {
        saved_ = behind_.state;
        const int budget = behind_.settings.iterationBudget;
        for (uint32_t k = 1; k < moves; ++k) {
            behind_.settings.iterationBudget = static_cast<int>(k);
            behind_.step(hip);
            if (behind_.output.iterations != k)
                fault("a replay of " + std::to_string(k) + " moves made another number");
            places.push_back(behind_.state[0].proxy);
            behind_.state = saved_;
            --behind_.tick;
        }
        behind_.settings.iterationBudget = budget;
    }
    behind_.step(hip);
    const glm::dvec3 end = bench_.state[0].proxy;
    if (behind_.state[0].proxy != end || behind_.output.force != bench_.output.force ||
        behind_.output.iterations != moves)
        fault("a replay of the whole tick ends elsewhere");
    places.push_back(end);
    return places;
}

/// The clearance of the straight way, or of the way over a corner that is on a tangent plane at either end:
/// so the proxy rolls around a rounded edge.
long double ExactTrial::wayClearance(const Frame& f, const LVec3& from, const LVec3& to) const {
    long double best = f.soup->clearance(from, to, f.radius);
    if (best >= f.radius)
        return best;
    for (const BruteContact& a : f.soup->within(from, f.radius + kTouching))
        for (const BruteContact& b : f.soup->within(to, f.radius + kTouching)) {
            const LVec3 along = b.normal - glm::dot(a.normal, b.normal) * a.normal;
            const long double rate = glm::dot(along, b.normal);
            if (!(rate > 0.0L))
                continue;
            const LVec3 corner = from + glm::dot(to - from, b.normal) / rate * along;
            best = std::max(best, std::min(f.soup->clearance(from, corner, f.radius),
                                           f.soup->clearance(corner, to, f.radius)));
        }
    return best;
}

void ExactTrial::checkPath(const Frame& f, const std::vector<glm::dvec3>& places) {
    for (size_t k = 1; k < places.size(); ++k) {
        const LVec3 from(places[k - 1]), to(places[k]);
        const long double shortfall = f.radius - wayClearance(f, from, to);
        figures_.shortfall = std::max(figures_.shortfall, shortfall * f.unit);
        if (shortfall > f.placing)
            fault(text("move %zu comes %.2Lg m nearer to a triangle than the radius", k, shortfall * f.unit));
        const long double retreat = glm::length(to - f.goal) - glm::length(from - f.goal);
        figures_.retreat = std::max(figures_.retreat, retreat * f.unit);
        // A plane may lift the proxy to its resting gap.
        if (retreat > kTouching + f.aim)
            fault(text("move %zu goes %.2Lg m away from the HIP", k, retreat * f.unit));
    }
    const long double shortfall = f.radius - f.soup->nearest(LVec3(places.back())).distance;
    figures_.shortfall = std::max(figures_.shortfall, shortfall * f.unit);
    if (shortfall > f.placing)
        fault(text("rests %.2Lg m nearer to a triangle than the radius", shortfall * f.unit));
}

long double ExactTrial::coneResidual(const Frame& f, const LVec3& proxy) const {
    std::vector<LVec3> normals;
    for (const BruteContact& contact : f.soup->within(proxy, f.radius + kTouching + f.placing))
        normals.push_back(contact.normal);
    return restResidual(normals, proxy, f.goal);
}

/// Where the ends differ, ours is a rest only if the oracle, put there, stays.
void ExactTrial::checkHeld(const Frame& f, const LVec3& ours) {
    const OracleRest rest = oracleRest(*f.soup, ours, f.goal, f.radius);
    const long double drift = glm::length(rest.proxy - ours);
    if (drift > f.tolerance)
        fault(text("is no rest: put there, the oracle goes on for %.2Lg m in %d moves", drift * f.unit,
                   rest.moves));
}

void ExactTrial::compareRestarted(const Frame& f, const LVec3& before) {
    const LVec3 ours(bench_.state[0].proxy);
    const OracleRest rest = oracleRest(*f.soup, before, f.goal, f.radius);
    if (!rest.settled) {
        fault("rests where the oracle, from the same place, goes on");
        return;
    }
    ++figures_.compared;
    const long double error = glm::length(rest.proxy - ours);
    if (error <= f.tolerance) {
        figures_.error = std::max(figures_.error, error * f.unit);
        figures_.relative = std::max(figures_.relative,
                                     error * f.unit * static_cast<long double>(scene_.workspacePerFitted()) /
                                         static_cast<long double>(smallestDiagonal_));
        return;
    }
    ++figures_.apart;
    checkHeld(f, ours);
    const long double cone = restResidual(rest.touching, rest.proxy, f.goal);
    const long double shortfall = f.radius - f.soup->nearest(rest.proxy).distance;
    figures_.oracleCone = std::max(figures_.oracleCone, cone * f.unit);
    figures_.oracleShortfall = std::max(figures_.oracleShortfall, shortfall * f.unit);
    figures_.divergences.push_back(
        text("%s tick %llu, restarted: %.2Lg m apart, ours %.6Lg m from the HIP, the oracle's %.6Lg m",
             figures_.name.c_str(), static_cast<unsigned long long>(bench_.tick), error * f.unit,
             glm::length(ours - f.goal) * f.unit, glm::length(rest.proxy - f.goal) * f.unit));
}

void ExactTrial::compareFree(const Frame& f) {
    const LVec3 ours(bench_.state[0].proxy);
    const OracleRest rest = oracleRest(*f.soup, *free_, f.goal, f.radius);
    free_ = rest.proxy;
    const long double error = glm::length(rest.proxy - ours);
    if (error <= f.tolerance) {
        closeParting();
        return;
    }
    ++figures_.partedTicks;
    if (!rest.settled && finished_)
        fault("rests where the free oracle goes on");
    if (rest.settled)
        figures_.oracleCone =
            std::max(figures_.oracleCone, f.unit * restResidual(rest.touching, rest.proxy, f.goal));
    figures_.oracleShortfall =
        std::max(figures_.oracleShortfall, f.unit * (f.radius - f.soup->nearest(rest.proxy).distance));
    if (!parting_) {
        if (finished_)
            checkHeld(f, ours);
        ++figures_.partings;
        parting_ = {.start = static_cast<int>(bench_.tick),
                    .first = error * f.unit,
                    .ours = glm::length(ours - f.goal) * f.unit,
                    .oracles = glm::length(rest.proxy - f.goal) * f.unit};
    }
    ++parting_->ticks;
    parting_->most = std::max(parting_->most, error * f.unit);
    parting_->unfinished |= !finished_;
}

void ExactTrial::closeParting() {
    if (!parting_)
        return;
    figures_.divergences.push_back(text(
        "%s tick %d, free: %.2Lg m apart, ours %.6Lg m from the HIP, the oracle's %.6Lg m; for %d ticks, "
        "at most %.2Lg m%s",
        figures_.name.c_str(), parting_->start, parting_->first, parting_->ours, parting_->oracles,
        parting_->ticks, parting_->most, parting_->unfinished ? ", out of moves" : ""));
    parting_.reset();
}

void ExactTrial::tick(const glm::dvec3& hip, bool compare) {
    const bool placedBefore = bench_.state[0].placed;
    const std::vector<glm::dvec3> places = replay(hip);
    const DeviceState& state = bench_.state[0];
    if (!state.placed) {
        if (placedBefore)
            fault("the proxy is walled in and gives up");
        return;
    }
    if (!placedBefore) { // it starts where the HIP is, free
        free_ = LVec3(state.proxy);
        return;
    }
    const Frame f = frame();
    const LVec3 ours(state.proxy);
    ++figures_.ticks;
    figures_.touching += bench_.output.contacts > 0 ? 1 : 0;
    figures_.moves = std::max(figures_.moves, static_cast<int>(bench_.output.iterations));
    finished_ = !has(bench_.output.flags, TickFlag::BudgetReached);
    checkPath(f, places);
    if (has(bench_.output.flags, TickFlag::CandidatesFull))
        fault("no room for the triangles near the proxy");
    if (finished_) {
        const long double cone = coneResidual(f, ours);
        figures_.cone = std::max(figures_.cone, cone * f.unit);
        if (cone > f.tolerance)
            fault(text("rests though the surfaces that touch leave it a move of %.2Lg m", cone * f.unit));
        if (compare)
            compareRestarted(f, LVec3(places.front()));
    } else {
        ++figures_.unfinished;
    }
    if (compare && options_.freeRunning)
        compareFree(f);
}

ExactFigures together(const std::string& name, const std::vector<ExactFigures>& all) {
    ExactFigures sum;
    sum.name = name;
    for (const ExactFigures& f : all) {
        sum.ticks += f.ticks;
        sum.touching += f.touching;
        sum.compared += f.compared;
        sum.unfinished += f.unfinished;
        sum.moves = std::max(sum.moves, f.moves);
        sum.apart += f.apart;
        sum.partings += f.partings;
        sum.partedTicks += f.partedTicks;
        sum.error = std::max(sum.error, f.error);
        sum.relative = std::max(sum.relative, f.relative);
        sum.cone = std::max(sum.cone, f.cone);
        sum.shortfall = std::max(sum.shortfall, f.shortfall);
        sum.retreat = std::max(sum.retreat, f.retreat);
    }
    return sum;
}

std::string exactHead() {
    return text("%-28s %7s %7s %5s %5s %8s %9s %5s %5s %6s %9s %9s %9s", "case", "ticks", "compared", "moves",
                "unfin", "error m", "diagonals", "apart", "parts", "ticks", "cone m", "short m", "retreat m");
}

std::string exactLine(const ExactFigures& f) {
    return text("%-28s %7d %7d %5d %5d %8.1Le %9.1Le %5d %5d %6d %9.1Le %9.1Le %9.1Le", f.name.c_str(),
                f.ticks, f.compared, f.moves, f.unfinished, f.error, f.relative, f.apart, f.partings,
                f.partedTicks, f.cone, f.shortfall, f.retreat);
}

} // namespace touchstone::test
