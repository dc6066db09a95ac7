#include "haptics/program/program_touch.h"

#include "haptics/program/interface_locations.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone::program {

namespace {

using Ports = std::array<PortValue, kMaxLocations>;

PortValue portOf(const glm::dvec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0.0f};
}
glm::dvec3 vectorOf(const PortValue& port) {
    return {static_cast<double>(port[0]), static_cast<double>(port[1]), static_cast<double>(port[2])};
}

void fill(const ProgramContact& contact, Ports& in) {
    in[kPosition] = portOf(contact.position);
    in[kNormal] = portOf(contact.normal);
    in[kTangent] = portOf(contact.tangent);
    in[kBinormal] = portOf(contact.binormal);
    in[kUv] = {static_cast<float>(contact.uv.x), static_cast<float>(contact.uv.y)};
    in[kToolDirection] = portOf(contact.toolDirection);
    in[kToolVelocity] = portOf(contact.toolVelocity);
    in[kToolAcceleration] = portOf(contact.toolAcceleration);
    in[kForce] = portOf(contact.stiffness * contact.depth * contact.normal);
    in[kMaterial] = {static_cast<float>(contact.staticFriction), static_cast<float>(contact.dynamicFriction),
                     static_cast<float>(contact.stiffness), static_cast<float>(contact.damping)};
    in[kTick] = {static_cast<float>(contact.filterWidth), static_cast<float>(contact.time)};
    in[kLook] = {1.0f, 1.0f, 1.0f, 1.0f};
    in[kPersistent] = {static_cast<float>(contact.persistent)};
}

/// The displacement along the normal, model m: its value and its gradient in the object's frame.
struct Displacement {
    double height = 0.0;
    glm::dvec3 slope{0.0};
};

double heightOf(const ProgramContact& contact, const Ports& in, const Ports& out) {
    return glm::dot(vectorOf(out[kOutPosition]) - vectorOf(in[kPosition]), contact.normal);
}

/// Runs on dual numbers whose three variables are the position's components.
RunResult runWithSlope(const RegisterProgram& program, const ProgramContact& contact, const Ports& in,
                       Ports& out, Displacement& displacement) {
    std::array<DualPortValue, kMaxLocations> dual{}, dualOut{};
    for (size_t i = 0; i <= kPersistent; ++i)
        dual[i].v = in[i];
    for (size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<glm::length_t>(k);
        dual[kPosition].d[k][k] = 1.0f;
        for (size_t i = 0; i < 2; ++i)
            dual[kUv].d[i][k] = static_cast<float>(contact.uvSlope[i][axis]);
        dual[kPersistent].d[0][k] = static_cast<float>(contact.persistentSlope[axis]);
    }
    const RunResult result = runDual(program, dual, dualOut, contact.budget);
    for (size_t i = 0; i <= kOutPersistent; ++i)
        out[i] = dualOut[i].v;
    for (size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<glm::length_t>(k);
        for (size_t i = 0; i < 3; ++i)
            displacement.slope[axis] += contact.normal[static_cast<glm::length_t>(i)] *
                                        static_cast<double>(dualOut[kOutPosition].d[i][k]);
        displacement.slope[axis] -= contact.normal[axis];
    }
    return result;
}

RunResult runWithDifferences(const RegisterProgram& program, const ProgramContact& contact, const Ports& in,
                             Ports& out, Displacement& displacement) {
    RunResult result = run(program, in, out, contact.budget);
    for (size_t k = 0; k < 3 && result.ending == Ending::Finished; ++k) {
        double difference = 0.0, distance = 0.0;
        for (const double sign : {1.0, -1.0}) {
            Ports beside = in, there{};
            const double step = sign * contact.differenceStep;
            const auto axis = static_cast<glm::length_t>(k);
            beside[kPosition][k] += static_cast<float>(step);
            for (size_t i = 0; i < 2; ++i)
                beside[kUv][i] += static_cast<float>(step * contact.uvSlope[i][axis]);
            beside[kPersistent][0] += static_cast<float>(step * contact.persistentSlope[axis]);
            const RunResult other =
                run(program, beside, there, contact.budget - std::min(contact.budget, result.cost));
            result.cost += other.cost;
            if (other.ending != Ending::Finished)
                result = {other.ending, result.cost, other.at};
            difference += sign * heightOf(contact, beside, there);
            distance += sign * static_cast<double>(beside[kPosition][k]);
        }
        if (distance > 0.0) // a step below the rounding of a far place moves nothing
            displacement.slope[static_cast<glm::length_t>(k)] = difference / distance;
    }
    return result;
}

/// The displacement that is felt, s(h, d), with its derivatives by h and by d: h up to d/2, d from 3d/2 on,
/// smooth between; -d below -d, where the spring is slack.
struct Limited {
    double height = 0.0, byHeight = 0.0, byDepth = 0.0;
};

Limited limited(double height, double depth) {
    if (height <= -depth)
        return {-depth, 0.0, -1.0};
    if (height <= 0.5 * depth)
        return {height, 1.0, 0.0};
    if (height >= 1.5 * depth)
        return {depth, 0.0, 1.0};
    const double u = height / depth, over = u - 0.5, part = u - 0.5 * over * over;
    return {part * depth, 1.0 - over, part - u * (1.0 - over)};
}

/// The force before its bounds.
glm::dvec3 freeForce(const ProgramContact& contact, const Ports& in, const Ports& out,
                     const Displacement& displacement, double stiffness, const Limited& felt) {
    const glm::dvec3& n = contact.normal;
    const double depth = contact.depth, height = felt.height;
    const glm::dvec3 along = displacement.slope - glm::dot(displacement.slope, n) * n;
    glm::dvec3 direction = (1.0 + felt.byDepth) * n - felt.byHeight * along;
    if (out[kOutNormal] != in[kNormal]) {
        const glm::dvec3 perturbed = vectorOf(out[kOutNormal]);
        const double length = glm::length(perturbed);
        direction = length > 0.0 ? perturbed / length : n;
    }
    return stiffness / contact.stiffness * vectorOf(out[kOutForce]) +
           stiffness * ((depth + height) * direction - depth * n);
}

/// What of it a contact may do.
glm::dvec3 boundedForce(const ProgramContact& contact, glm::dvec3 force, double stiffness) {
    const double push = glm::dot(force, contact.normal);
    if (push < 0.0)
        force -= push * contact.normal;
    const double greatest = kMaxProgramGain * stiffness * contact.depth, length = glm::length(force);
    return length > greatest ? greatest / length * force : force;
}

} // namespace

ProgramFelt feelProgram(const RegisterProgram& program, ProgramGradient gradient,
                        const ProgramContact& contact) noexcept {
    ProgramFelt felt{.force = contact.stiffness * contact.depth * contact.normal,
                     .stiffness = contact.stiffness,
                     .damping = contact.damping,
                     .staticFriction = contact.staticFriction,
                     .dynamicFriction = contact.dynamicFriction};
    Ports in{}, out{};
    fill(contact, in);
    Displacement displacement;
    const RunResult result =
        gradient == ProgramGradient::Dual      ? runWithSlope(program, contact, in, out, displacement)
        : gradient == ProgramGradient::Central ? runWithDifferences(program, contact, in, out, displacement)
                                               : run(program, in, out, contact.budget);
    felt.ending = result.ending;
    felt.cost = result.cost;
    felt.at = result.at;
    if (result.ending != Ending::Finished)
        return felt;
    const PortValue& material = out[kOutMaterial];
    const double stiffness = std::clamp(static_cast<double>(material[2]), 0.0, contact.maxStiffness);
    const Limited height = limited(heightOf(contact, in, out) / contact.modelPerWorkspace, contact.depth);
    const glm::dvec3 force =
        boundedForce(contact, freeForce(contact, in, out, displacement, stiffness, height), stiffness);
    if (!std::isfinite(force.x + force.y + force.z)) {
        felt.ending = Ending::NotFinite;
        felt.at = ProgramEnd::kForce;
        return felt;
    }
    felt.force = force;
    felt.height = height.height;
    felt.stiffness = stiffness;
    felt.damping = std::max(static_cast<double>(material[3]), 0.0);
    felt.staticFriction = std::max(static_cast<double>(material[0]), 0.0);
    felt.dynamicFriction = std::clamp(static_cast<double>(material[1]), 0.0, felt.staticFriction);
    felt.persistentChange = static_cast<double>(out[kOutPersistent][0]);
    felt.brush = std::max(static_cast<double>(out[kOutPersistent][1]), 0.0);
    return felt;
}

} // namespace touchstone::program
