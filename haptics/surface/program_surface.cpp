#include "haptics/surface/program_surface.h"

#include "haptics/program/felt_program.h"
#include "haptics/program/program_touch.h"
#include "haptics/sample/hip_sample.h"
#include "haptics/state/device_state.h"
#include "haptics/texture/persistent_textures.h"
#include "haptics/texture/surface_spot.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

using program::ProgramContact;
using program::ProgramFelt;

constexpr double kStill = 1e-3; // m/s

program::ProgramGradient gradientOf(ProgramMode mode, bool displaces) {
    if (!displaces)
        return program::ProgramGradient::None;
    return mode == ProgramMode::Dual      ? program::ProgramGradient::Dual
           : mode == ProgramMode::Central ? program::ProgramGradient::Central
                                          : program::ProgramGradient::None;
}

/// Unit, perpendicular to n, the same for the same n.
glm::dvec3 anyTangent(const glm::dvec3& n) {
    const glm::dvec3 axis = std::abs(n.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    return glm::normalize(axis - glm::dot(axis, n) * n);
}

/// Gradients of u and v over the triangle, object frame.
std::array<glm::dvec3, 2> slopesOf(const SurfaceSpot& spot) {
    std::array<glm::dvec2, 3> uv;
    for (size_t k = 0; k < 3; ++k)
        uv[k] = spot.uvAt(0, k);
    return {gradientOver(spot.triangle, uv[0].x, uv[1].x, uv[2].x),
            gradientOver(spot.triangle, uv[0].y, uv[1].y, uv[2].y)};
}

/// Along u: dP/du of the triangle, in the surface of normal n. Object frame.
glm::dvec3 tangentOf(const std::array<glm::dvec3, 2>& slopes, const glm::dvec3& n) {
    const auto& [alongU, alongV] = slopes;
    glm::dvec3 tangent = glm::cross(alongV, n); // perpendicular to grad v, on the side of grad u
    if (glm::dot(tangent, alongU) < 0.0)
        tangent = -tangent;
    tangent -= glm::dot(tangent, n) * n;
    const double length = glm::length(tangent);
    return length > 1e-12 ? tangent / length : anyTangent(n);
}

/// Unit vector of the part of v along the surface; 0 where there is none.
glm::dvec3 alongSurface(const glm::dvec3& v, const glm::dvec3& n) {
    const glm::dvec3 along = v - glm::dot(v, n) * n;
    const double length = glm::length(along);
    return length > 1e-6 ? along / length : glm::dvec3(0.0);
}

/// Position, coordinates and frame of the touched place. `point`, `n`: object frame.
void locate(const HapticObject& object, const HapticMaterialData& material, const Contact& contact,
            const glm::dvec3& point, const glm::dvec3& n, const Similarity& programFromObject,
            ProgramContact& at) {
    at.position = programFromObject.point(point);
    at.normal = programFromObject.direction(n);
    glm::dvec3 tangent = anyTangent(n);
    if (material.program->usesCoordinates && object.shape == nullptr && !object.uv[0].empty()) {
        SurfaceSpot spot{object, material, triangleOf(object, contact.feature)};
        spot.first = 3 * static_cast<size_t>(contact.feature);
        spot.weight = barycentric(spot.triangle, point);
        for (size_t k = 0; k < 3; ++k)
            at.uv += spot.weight[static_cast<glm::length_t>(k)] * spot.uvAt(0, k);
        const std::array<glm::dvec3, 2> slopes = slopesOf(spot);
        tangent = tangentOf(slopes, n);
        for (size_t i = 0; i < 2; ++i)
            at.uvSlope[i] = programFromObject.direction(slopes[i]) / programFromObject.scale;
    }
    at.tangent = programFromObject.direction(tangent);
    at.binormal = glm::cross(at.normal, at.tangent);
}

/// The persistent texture's value and slope there.
void readTexture(const PersistentTexture& texture, ProgramContact& at) {
    glm::dvec2 slope(0.0);
    at.persistent = texture.at(at.uv, &slope);
    at.persistentSlope = slope.x * at.uvSlope[0] + slope.y * at.uvSlope[1];
}

/// What the program returns, in place of the sample's. `programFromReference` turns directions.
void take(const ProgramFelt& felt, const HapticSettings& settings, const glm::dquat& programFromReference,
          double depth, SurfaceSample& feel) {
    const glm::dvec3 force = glm::conjugate(programFromReference) * felt.force;
    feel.programmed = true;
    feel.stiffness = felt.stiffness;
    feel.programForce = force - felt.stiffness * depth * feel.normal;
    feel.damping = felt.damping;
    if (settings.friction == FrictionMode::Off)
        return;
    feel.coulomb |= felt.staticFriction != feel.staticFriction;
    feel.staticFriction = felt.staticFriction;
    feel.dynamicFriction = felt.dynamicFriction;
}

/// What a program leaves in the persistent texture. `point`, `normal`: object frame.
void queueStroke(const ProgramFelt& felt, int object, const glm::dvec3& point, const glm::dvec3& normal,
                 double programPerObject, ProgramRun& run) {
    run.textures->queue(
        {.object = static_cast<uint32_t>(object),
         .point = point,
         .normal = normal,
         .radius = felt.brush / programPerObject,
         .change = run.part * felt.persistentChange * run.dt / (programPerObject * programPerObject)});
}

} // namespace

ProgramRun programRun(const ToolMotion& tool, const glm::dvec3& velocity, double zoom, double dt,
                      PersistentTextures* textures) noexcept {
    return {.tool = tool,
            .velocity = velocity,
            .zoom = zoom,
            .dt = dt,
            .budget = program::kBudget,
            .end = {},
            .textures = textures};
}

void runProgram(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                const DeviceLimits& limits, int reference, const Contact& contact, double depth,
                ProgramRun& run, SurfaceSample& feel) noexcept {
    const auto k = static_cast<size_t>(contact.object);
    const HapticObject& object = *scene.objects[k];
    const HapticMaterialData& material = scene.materials[static_cast<size_t>(object.material)];
    if (material.program == nullptr || !(feel.stiffness > 0.0) || settings.programs == ProgramMode::Off)
        return;
    const program::FeltProgram& program = *material.program;
    const Similarity& workspaceFromObject = motions[k].workspaceFromObject;
    const Similarity& workspaceFromReference = motions[static_cast<size_t>(reference)].workspaceFromObject;
    const Similarity& programFromObject = scene.programFromObject[k];
    glm::dvec3 point = contact.point, n = feel.normal;
    if (contact.object != reference) {
        const Similarity objectFromReference = workspaceFromObject.inverseTimes(workspaceFromReference);
        point = objectFromReference.point(point);
        n = objectFromReference.direction(n);
    }
    const glm::dquat programFromWorkspace =
        programFromObject.rotation * glm::conjugate(workspaceFromObject.rotation);
    const glm::dquat programFromReference = programFromWorkspace * workspaceFromReference.rotation;

    ProgramContact at;
    locate(object, material, contact, point, n, programFromObject, at);
    const double zoomed = std::max(run.zoom, 1.0);
    const double speed = glm::length(run.velocity - glm::dot(run.velocity, feel.normal) * feel.normal);
    at.toolDirection = alongSurface(programFromWorkspace * run.tool.direction, at.normal);
    at.toolVelocity = programFromReference * run.velocity / zoomed;
    at.toolAcceleration = programFromWorkspace * run.tool.acceleration / zoomed;
    at.depth = depth;
    at.stiffness = feel.stiffness;
    at.damping = feel.damping;
    at.staticFriction = feel.staticFriction;
    at.dynamicFriction = feel.dynamicFriction;
    at.modelPerWorkspace = programFromObject.scale / workspaceFromObject.scale;
    at.filterWidth = speed * run.dt * at.modelPerWorkspace;
    at.time = run.tool.time;
    at.maxStiffness = std::max({feel.stiffness, settings.stiffness, limits.maxStiffness});
    at.differenceStep = 1e-4 * programFromObject.scale; // of the object's longest side
    at.budget = run.budget;
    const PersistentTexture* const texture =
        run.textures != nullptr ? run.textures->at(contact.object) : nullptr;
    if (texture != nullptr)
        readTexture(*texture, at);
    else if (program.texture.width > 0)
        at.persistent = static_cast<double>(program.texture.initial);
    const ProgramFelt felt =
        program::feelProgram(program.code, gradientOf(settings.programs, program.displaces), at);
    run.budget -= std::min(run.budget, felt.cost);
    if (felt.ending == program::Ending::Finished)
        take(felt, settings, programFromReference, depth, feel);
    else if (run.end.ending == program::Ending::Finished)
        run.end = {felt.ending, felt.at, contact.object};
    if (texture != nullptr && felt.persistentChange != 0.0 && felt.brush > 0.0)
        queueStroke(felt, contact.object, point, n, programFromObject.scale, run);
}

void followTool(const glm::dvec3& velocity, double dt, ToolMotion& tool) noexcept {
    constexpr double kTwoPi = 6.283185307179586;
    tool.time += dt;
    if (tool.known) {
        const double share = 1.0 - std::exp(-kTwoPi * kVelocityCutoff * dt);
        tool.acceleration += share * ((velocity - tool.velocity) / dt - tool.acceleration);
    }
    tool.known = true;
    tool.velocity = velocity;
}

void followDirection(const glm::dvec3& velocity, const glm::dvec3& normal,
                     const Similarity& workspaceFromReference, ToolMotion& tool) noexcept {
    const glm::dvec3 along = velocity - glm::dot(velocity, normal) * normal;
    const double speed = glm::length(along);
    if (speed > kStill)
        tool.direction = workspaceFromReference.direction(along / speed);
}

} // namespace touchstone
