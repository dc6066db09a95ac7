#include "haptics/finger/arc_finger.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

glm::dvec2 facing(const FingerPose& pose) {
    return {std::sin(pose.pitch), -std::cos(pose.pitch)};
}

} // namespace

glm::dvec2 ArcFinger::centre(const FingerPose& pose) const noexcept {
    return pose.pad - radius * facing(pose);
}

glm::dvec2 ArcFinger::skin(const FingerPose& pose, double location) const noexcept {
    const double angle = pose.pitch + location / radius;
    return centre(pose) + radius * glm::dvec2(std::sin(angle), -std::cos(angle));
}

double ArcFinger::locationTowards(const FingerPose& pose, const glm::dvec2& direction) const noexcept {
    const glm::dvec2 down = facing(pose);
    const double half = 0.5 * length;
    return std::clamp(radius * std::atan2(crossed(down, direction), glm::dot(down, direction)), -half, half);
}

PadContact ArcFinger::touch(const FingerPose& pose, const SurfaceLine& line) const noexcept {
    PadContact contact;
    contact.location = locationTowards(pose, -line.normal);
    const glm::dvec2 deepest = skin(pose, contact.location);
    contact.depth = glm::dot(line.point - deepest, line.normal);
    contact.point = deepest + contact.depth * line.normal;
    return contact;
}

} // namespace touchstone
