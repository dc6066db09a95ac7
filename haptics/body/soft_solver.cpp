// Bullet's soft bodies without Bullet's world and its contacts. A world would keep a broadphase, manifolds
// and sleeping states from step to step; here a step begins with the vertices that it is given, so that equal
// states give equal steps.

#include "haptics/body/soft_solver.h"

#include <BulletSoftBody/btSoftBody.h>
#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace touchstone::body {

namespace {

constexpr double kUnits = 100.0; // of Bullet's length, per m
constexpr float kStray = 5e-4f;  // cm, from its anchor: a body is calm that stays within it
constexpr int kSubsteps = 4;
constexpr int kClothRounds = 4, kJellyRounds = 2; // of the position solver: a jelly has a shape besides
/// s: a substep.
constexpr double kStep = 1.0 / (kSoftRate * kSubsteps);
/// m/s: what is faster is stopped down to it; the hand's proxy is swept over all of the way in between.
constexpr double kFastest = 3.0;
/// Of an obstacle.
constexpr size_t kMostFaces = 512;
/// (h w)^2 of the pressure's stiffest motion: beyond 4 an explicit step gains energy.
constexpr double kStable = 0.5;

btVector3 toBullet(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}
glm::dvec3 fromBullet(const btVector3& v) {
    return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

/// The edges, and for each that two triangles share the segment between the corners across it: both once.
std::vector<std::pair<uint32_t, uint32_t>> linksOf(std::span<const uint32_t> triangles) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> across;
    std::vector<std::pair<uint32_t, uint32_t>> links;
    for (size_t t = 0; t + 2 < triangles.size(); t += 3)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = triangles[t + k], b = triangles[t + (k + 1) % 3],
                           c = triangles[t + (k + 2) % 3];
            const auto [found, isNew] = across.insert({std::minmax(a, b), c});
            if (isNew)
                links.push_back(std::minmax(a, b));
            else if (found->second != c)
                links.push_back(std::minmax(found->second, c));
        }
    std::ranges::sort(links);
    const auto rest = std::ranges::unique(links);
    links.erase(rest.begin(), rest.end());
    return links;
}

/// Half-spaces whose intersection is the convex hull, n . x <= d, in Bullet's unit; or, where the hull has
/// more faces than kMostFaces, a hull around it with so many fixed directions.
std::vector<glm::dvec4> halfSpacesOf(const std::vector<glm::dvec3>& points) {
    std::vector<double> numbers;
    for (const glm::dvec3& p : points)
        for (int c = 0; c < 3; ++c)
            numbers.push_back(kUnits * p[c]);
    btConvexHullComputer hull;
    hull.compute(numbers.data(), 3 * sizeof(double), static_cast<int>(points.size()), 0.0f, 0.0f);
    std::vector<glm::dvec3> directions;
    for (int f = 0; f < hull.faces.size(); ++f) {
        const btConvexHullComputer::Edge* const first = &hull.edges[hull.faces[f]];
        glm::dvec3 normal(0.0); // Newell's: of a face with rounded corners
        for (const btConvexHullComputer::Edge* edge = first;;) {
            normal += glm::cross(fromBullet(hull.vertices[edge->getSourceVertex()]),
                                 fromBullet(hull.vertices[edge->getTargetVertex()]));
            edge = edge->getNextEdgeOfFace();
            if (edge == first)
                break;
        }
        if (const double length = glm::length(normal); length > 0.0)
            directions.push_back(normal / length);
    }
    if (directions.size() > kMostFaces) {
        directions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
        for (size_t k = directions.size(); k < kMostFaces; ++k) { // evenly, along a spiral
            const double y = 1.0 - 2.0 * (static_cast<double>(k) + 0.5) / static_cast<double>(kMostFaces);
            const double turn = std::numbers::pi * (1.0 + std::sqrt(5.0)) * static_cast<double>(k);
            const double r = std::sqrt(1.0 - y * y);
            directions.emplace_back(r * std::cos(turn), y, r * std::sin(turn));
        }
    }
    std::vector<glm::dvec4> halfSpaces;
    for (const glm::dvec3& direction : directions) {
        double most = -INFINITY;
        for (int i = 0; i < hull.vertices.size(); ++i)
            most = std::max(most, glm::dot(direction, fromBullet(hull.vertices[i])));
        halfSpaces.emplace_back(direction, most);
    }
    return halfSpaces;
}

} // namespace

struct SoftSolver::Bullet {
    btSoftBodyWorldInfo world;
    std::vector<std::vector<glm::dvec4>> obstacles; // half-spaces of each
    std::unique_ptr<btSoftBody> body;
    double restVolume = 0.0;
};

/// A vertex under a hand.
struct SoftSolver::Pressed {
    int vertex = 0;
    double weight = 0.0; // sum 1
    double goal = 0.0;   // m, along Patch::along: where the hand would have it
};

/// The vertices under a hand in a step.
struct SoftSolver::Patch {
    std::vector<Pressed> pressed;
    glm::dvec3 along{0.0};  // unit, into the body
    double most = 0.0;      // N
    double stiffness = 0.0; // N/m
    double share = 1.0;     // of the step
};

SoftSolver::SoftSolver(const SoftBody& law, const SoftShape& shape, double scale)
    : law_(law), scale_(scale), triangles_(shape.triangles), bullet_(std::make_unique<Bullet>()) {
    const size_t count = shape.vertices.size();
    for (const glm::dvec3& v : shape.vertices)
        rest_.places.push_back(glm::vec3(kUnits * v));
    rest_.velocities.assign(count, glm::vec3(0.0f));
    rest_.anchor = rest_.places;
    std::vector<btVector3> places;
    for (const glm::vec3& v : rest_.places)
        places.push_back(toBullet(v));
    const auto free = static_cast<double>(std::ranges::count(shape.fixed, 0));
    std::vector<btScalar> masses;
    for (size_t v = 0; v < count; ++v)
        masses.push_back(shape.fixed[v] != 0 ? 0.0f : static_cast<btScalar>(law.mass / std::max(free, 1.0)));
    bullet_->world.m_sparsesdf.Initialize();
    bullet_->world.air_density = 0.0f;
    bullet_->body =
        std::make_unique<btSoftBody>(&bullet_->world, static_cast<int>(count), places.data(), masses.data());
    btSoftBody& body = *bullet_->body;
    btSoftBody::Material& material = *body.m_materials[0];
    material.m_kLST = static_cast<btScalar>(law.stretch);
    // Bullet's volume has a sign, and its normals are to face outwards.
    const bool inward = law.kind == SoftKind::Jelly && signedVolumeOf(rest_) < 0.0;
    for (size_t t = 0; t + 2 < triangles_.size(); t += 3)
        body.appendFace(static_cast<int>(triangles_[t]), static_cast<int>(triangles_[t + (inward ? 2 : 1)]),
                        static_cast<int>(triangles_[t + (inward ? 1 : 2)]));
    for (const auto& [a, b] : linksOf(triangles_))
        body.appendLink(static_cast<int>(a), static_cast<int>(b));
    body.m_cfg.collisions = 0;
    body.m_cfg.kDP = static_cast<btScalar>(1.0 - std::exp(-law.damping * kStep));
    const bool jelly = law.kind == SoftKind::Jelly;
    body.m_cfg.piterations = jelly ? kJellyRounds : kClothRounds;
    // A vertex goes back by kMT of its way in each substep: an oscillator of kMT = (2 pi f h)^2.
    body.m_cfg.kMT = static_cast<btScalar>(
        jelly ? std::min(std::pow(2.0 * std::numbers::pi * law.shapeFrequency * kStep, 2.0), 1.0) : 0.0);
    body.setPose(jelly, jelly);
    // Lengths and areas at rest are those of now. Bullet would take them again from the first state that it
    // steps, which in a replay that begins in the middle is a deformed one.
    body.updateConstants();
    body.m_bUpdateRtCst = false;
    bullet_->restVolume = std::abs(static_cast<double>(body.getVolume()));
    if (jelly && law.volumeStiffness > 0.0 && bullet_->restVolume > 0.0) {
        // Pressure K (V0 - V) / V0 in Bullet's units: 1 Pa = 1/100 kg / (cm s²). Its stiffest motion has
        // w² = K / V0 sum A² / m.
        double pressure = law.volumeStiffness / (kUnits * bullet_->restVolume), sum = 0.0;
        for (int i = 0; i < body.m_nodes.size(); ++i) {
            const auto area = static_cast<double>(body.m_nodes[i].m_area);
            sum += area * area * static_cast<double>(body.m_nodes[i].m_im);
        }
        if (sum > 0.0)
            pressure = std::min(pressure, kStable / (kStep * kStep * sum));
        body.m_cfg.kVC = static_cast<btScalar>(pressure);
    }
    for (const auto& points : shape.hulls)
        bullet_->obstacles.push_back(halfSpacesOf(points));
}

SoftSolver::~SoftSolver() = default;

double SoftSolver::volumeOf(const SoftState& state) const noexcept {
    return std::abs(signedVolumeOf(state));
}

double SoftSolver::signedVolumeOf(const SoftState& state) const noexcept {
    double sum = 0.0;
    for (size_t t = 0; t + 2 < triangles_.size(); t += 3) {
        const glm::dvec3 a(state.places[triangles_[t]]), b(state.places[triangles_[t + 1]]),
            c(state.places[triangles_[t + 2]]);
        sum += glm::dot(a, glm::cross(b, c));
    }
    return sum / (6.0 * kUnits * kUnits * kUnits);
}

void SoftSolver::load(const SoftState& state) {
    btSoftBody& body = *bullet_->body;
    for (int i = 0; i < body.m_nodes.size(); ++i) {
        btSoftBody::Node& node = body.m_nodes[i];
        const auto v = static_cast<size_t>(i);
        node.m_x = node.m_q = toBullet(state.places[v]);
        node.m_v = node.m_vn = toBullet(state.velocities[v]);
        node.m_f = btVector3(0, 0, 0);
    }
    body.updateNormals();
    body.updateBounds();
}

/// A substep of a push. Each vertex under the hand has a spring k w of its own to where the hand would have
/// it, with a damper c = 2 sqrt(k w m) that keeps it from flying past: the hand feels where it is 4 to 8 ms
/// later. The force is that at the substep's end, f = (k w (d - h v) - c v) / (1 + h (h k w + c) / m).
void SoftSolver::press(const Patch& patch, double dt) {
    for (const Pressed& pressed : patch.pressed) {
        btSoftBody::Node& node = bullet_->body->m_nodes[pressed.vertex];
        const auto inverseMass = static_cast<double>(node.m_im);
        if (!(inverseMass > 0.0))
            continue;
        const double stiffness = patch.stiffness * pressed.weight;
        const double damper = 2.0 * patch.share * std::sqrt(stiffness / (patch.share * inverseMass));
        const double depth = pressed.goal - glm::dot(patch.along, fromBullet(node.m_x)) / kUnits;
        const double speed = glm::dot(patch.along, fromBullet(node.m_v)) / kUnits;
        const double force = std::clamp((stiffness * (depth - dt * speed) - damper * speed) /
                                            (1.0 + dt * (dt * stiffness + damper) * inverseMass),
                                        0.0, patch.most * pressed.weight);
        node.m_v += toBullet(glm::vec3(kUnits * dt * force * inverseMass * patch.along));
    }
}

/// The vertices under each hand.
void SoftSolver::choose(std::span<const SoftPush> pushes, const SoftState& from, const SoftState& to) {
    const btSoftBody& body = *bullet_->body;
    const double radius = law_.touchRadius * scale_;
    patches_.clear();
    for (const SoftPush& push : pushes) {
        const double length = glm::length(push.force);
        if (!(length > 0.0 && push.stiffness > 0.0 && push.share > 0.0 && std::isfinite(length)))
            continue;
        Patch patch;
        const auto felt = [&](int i) {
            const auto v = static_cast<size_t>(i);
            return glm::mix(glm::dvec3(from.places[v]), glm::dvec3(to.places[v]), push.fraction) / kUnits;
        };
        patch.along = push.force / length;
        double sum = 0.0, nearest = INFINITY;
        int closest = -1;
        for (int i = 0; i < body.m_nodes.size(); ++i) {
            const double distance = glm::distance(felt(i), push.point);
            if (body.m_nodes[i].m_im > 0.0f && distance < nearest) {
                nearest = distance;
                closest = i;
            }
            // The other side of a closed body is no part of what the hand presses.
            if (distance >= radius || (law_.kind == SoftKind::Jelly &&
                                       glm::dot(fromBullet(body.m_nodes[i].m_n), patch.along) > 0.0))
                continue;
            const double s = distance / radius, weight = (1.0 - s * s) * (1.0 - s * s);
            patch.pressed.push_back({i, weight});
            sum += weight;
        }
        if (!(sum > 0.0) && closest >= 0) {
            patch.pressed = {{closest, 1.0}};
            sum = 1.0;
        }
        for (Pressed& pressed : patch.pressed) {
            pressed.weight /= sum;
            pressed.goal = glm::dot(patch.along, felt(pressed.vertex)) + length / push.stiffness;
        }
        patch.share = push.share;
        patch.most = push.share * std::max(push.most, length);
        patch.stiffness = push.share * push.stiffness;
        patches_.push_back(std::move(patch));
    }
}

/// Takes vertices out of a convex obstacle and of the gap around it, to the nearest of its faces, with
/// Coulomb's friction on the way that they went in this substep [Macklin, Müller, Chentanez, Kim 2014,
/// Unified particle physics, eq. 24]. Bullet's own contacts with a shape (a sampled distance, solved before
/// the links) let a cloth hop by 0.2 mm and walk off the ball.
void SoftSolver::layOn(const std::vector<glm::dvec4>& halfSpaces) {
    btSoftBody& body = *bullet_->body;
    const double gap = kUnits * scale_ * law_.thickness;
    const auto rate = static_cast<btScalar>((1.0 - static_cast<double>(body.m_cfg.kDP)) / kStep);
    for (int i = 0; i < body.m_nodes.size(); ++i) {
        btSoftBody::Node& node = body.m_nodes[i];
        if (!(node.m_im > 0.0f)) // it is held
            continue;
        const glm::dvec3 place = fromBullet(node.m_x);
        double highest = -INFINITY;
        glm::dvec3 normal(0.0);
        for (const glm::dvec4& halfSpace : halfSpaces)
            if (const double height = glm::dot(glm::dvec3(halfSpace), place) - halfSpace.w;
                height > highest) {
                highest = height;
                normal = glm::dvec3(halfSpace);
                if (highest >= gap)
                    break;
            }
        if (highest >= gap)
            continue;
        const double push = gap - highest;
        const glm::dvec3 way = place - fromBullet(node.m_q);
        const glm::dvec3 along = way - glm::dot(way, normal) * normal;
        const double slides = glm::length(along), held = std::min(slides, law_.friction * push);
        const glm::dvec3 moved = push * normal - (slides > 0.0 ? held / slides : 0.0) * along;
        node.m_x += toBullet(glm::vec3(moved));
        node.m_v = (node.m_x - node.m_q) * rate;
        // What takes a vertex out of an obstacle is no velocity.
        const btVector3 n = toBullet(glm::vec3(normal));
        if (const btScalar outwards = node.m_v.dot(n); outwards > 0.0f)
            node.m_v -= n * outwards;
    }
}

void SoftSolver::substep() {
    btSoftBody& body = *bullet_->body;
    for (const Patch& patch : patches_)
        press(patch, kStep);
    body.predictMotion(static_cast<btScalar>(kStep));
    body.solveConstraints();
    for (const auto& halfSpaces : bullet_->obstacles)
        layOn(halfSpaces);
    body.integrateMotion();
}

/// The vertices of Bullet's body, or those at rest where it was torn apart.
void SoftSolver::writeTo(SoftState& next) const {
    const btSoftBody& body = *bullet_->body;
    for (int i = 0; i < body.m_nodes.size(); ++i) {
        const auto v = static_cast<size_t>(i);
        next.places[v] = glm::vec3(fromBullet(body.m_nodes[i].m_x));
        glm::vec3 velocity(fromBullet(body.m_nodes[i].m_v));
        const float speed = glm::length(velocity);
        constexpr auto kMost = static_cast<float>(kUnits * kFastest);
        if (speed > kMost)
            velocity *= kMost / speed;
        next.velocities[v] = velocity;
        if (!std::isfinite(glm::dot(next.places[v], next.places[v]) + speed)) {
            next.places = rest_.places;
            next.velocities = rest_.velocities;
            return;
        }
    }
}

void SoftSolver::step(const SoftState& now, const SoftState& from, const SoftState& to,
                      std::span<const SoftPush> pushes, double gravity, uint64_t number, SoftState& next) {
    const auto pull = static_cast<float>(gravity);
    if (asleep(now) && pushes.empty() && pull == now.gravity) {
        next = now;
        return;
    }
    btSoftBody& body = *bullet_->body;
    load(now);
    bullet_->world.m_gravity = btVector3(0, static_cast<btScalar>(-kUnits) * pull, 0);
    const bool breathes = law_.breath > 0.0 && body.m_pose.m_bvolume;
    if (breathes) {
        const double turn =
            2.0 * std::numbers::pi * static_cast<double>(number) / (kSoftRate * law_.breathTime);
        body.m_pose.m_volume =
            static_cast<btScalar>(bullet_->restVolume * (1.0 + law_.breath * std::sin(turn)));
    }
    choose(pushes, from, to);
    for (int k = 0; k < kSubsteps; ++k)
        substep();
    writeTo(next);
    // Against an anchor, not from step to step: a slow return is no rest.
    bool calm = !breathes && pushes.empty() && pull == now.gravity;
    for (size_t v = 0; v < next.places.size() && calm; ++v)
        calm = glm::distance(next.places[v], now.anchor[v]) <= kStray;
    next.anchor = calm ? now.anchor : next.places;
    next.calm = calm ? now.calm + 1 : 0;
    next.gravity = pull;
    if (asleep(next))
        std::ranges::fill(next.velocities, glm::vec3(0.0f));
}

} // namespace touchstone::body
