#include "haptics/shape/field/field_error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

namespace {

/// Of the place from the surface. The gradient is a unit vector but at kinks, where the field is rounded.
double offAt(const FieldShape& field, const glm::dvec3& place) {
    constexpr double kFlattest = 0.5;
    return std::abs(field.value(place)) / std::max(glm::length(field.gradient(place)), kFlattest);
}

int stepsOf(double length, double step, int most) {
    return static_cast<int>(std::clamp(std::ceil(length / step), 1.0, static_cast<double>(most)));
}

double offAlong(const FieldShape& field, const glm::dvec3& a, const glm::dvec3& b) {
    constexpr int kMost = 1024;
    const int steps = stepsOf(glm::distance(a, b), 0.5 * field.voxel(), kMost);
    double worst = 0.0;
    for (int i = 0; i <= steps; ++i)
        worst = std::max(worst, offAt(field, glm::mix(a, b, static_cast<double>(i) / steps)));
    return worst;
}

double offInside(const FieldShape& field, const std::array<glm::dvec3, 3>& corners) {
    constexpr int kMost = 64;
    const auto& [a, b, c] = corners;
    const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const int rows = stepsOf(longest, field.voxel(), kMost);
    double worst = offAt(field, (a + b + c) / 3.0);
    for (int i = 1; i < rows; ++i)
        for (int j = 1; i + j < rows; ++j)
            worst = std::max(worst, offAt(field, a + (static_cast<double>(i) * (b - a) +
                                                      static_cast<double>(j) * (c - a)) /
                                                         static_cast<double>(rows)));
    return worst;
}

/// Voxels to choose from.
double voxelOf(int i) {
    return kCoarsestWithin * std::exp2(-0.5 * i);
}

} // namespace

double fieldErrorOf(const HapticObject& mesh, const FieldShape& field) {
    double worst = 0.0;
    for (size_t t = 0; t < mesh.triangleCount(); ++t) {
        std::array<glm::dvec3, 3> corners;
        for (size_t k = 0; k < 3; ++k)
            corners[k] = mesh.vertices[mesh.indices[3 * t + k]];
        worst = std::max(worst, offInside(field, corners));
        for (size_t k = 0; k < 3; ++k)
            worst = std::max(worst, offAlong(field, corners[k], corners[(k + 1) % 3]));
    }
    return worst;
}

FittedField fieldWithin(const HapticObject& mesh, FieldRequest request, double error, const FieldCache& cache,
                        const Progress& progress) {
    const double finest = finestVoxel(mesh, request.outside);
    int last = 0;
    while (voxelOf(last + 1) >= finest)
        ++last;
    const int usual = std::min(last, 2);
    double done = 0.0;
    const auto fitted = [&](int i) {
        const double next = 0.5 * (1.0 + done);
        request.voxel = std::max(voxelOf(i), finest);
        FittedField field{fieldOfMesh(mesh, request, cache, progress.part(done, next)), 0.0};
        field.error = fieldErrorOf(mesh, FieldShape(field.grid));
        done = next;
        return field;
    };
    int i = 0;
    FittedField field = fitted(i);
    // The error falls with the square of the voxel where the surface is smooth, with its first power at
    // edges.
    if (field.error * std::exp2(-static_cast<double>(last)) > error)
        return fitted(usual);
    while (field.error > error && i < last) {
        i = std::min(i + std::max(1, static_cast<int>(std::log2(field.error / error))), last);
        field = fitted(i);
    }
    return field;
}

} // namespace touchstone
