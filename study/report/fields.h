#pragma once
// The fields of a study's result, defined once for all readers and writers. A visitor gets name, unit (""
// where there is none, or where the value contains it) and the value.

#include "study/result/result.h"

#include <string_view>

namespace touchstone::study {

/// By Truth.
inline constexpr std::array<std::string_view, 4> kTruthNames{"analytic", "oracle", "reference", "coulomb"};

template <class Visitor>
void visitFields(Visitor& visit, Estimate& e) {
    visit("value", "", e.value);
    visit("low", "", e.low);
    visit("high", "", e.high);
}

template <class Visitor>
void visitFields(Visitor& visit, Spread& s) {
    visit("median", "", s.median);
    visit("p99", "", s.p99);
    visit("max", "", s.max);
}

template <class Visitor>
void visitFields(Visitor& visit, Errors& e) {
    visit("position_error", "m", e.position);
    visit("force_error", "N", e.force);
    visit("force_magnitude_error", "N", e.forceMagnitude);
    visit("force_direction_error", "rad", e.forceDirection);
    visit("largest_jump", "N", e.largestJump);
    visit("truth_jump", "N", e.truthJump);
    visit("energy_created", "J", e.energyCreated);
    visit("contact_lost_share", "", e.contactLost);
    visit("contact_invented_share", "", e.contactInvented);
    visit("ticks", "", e.ticks);
    visit("ticks_compared", "", e.compared);
    visit("truth_failed", "", e.truthFailed);
}

/// The stages as an object keyed by their names.
struct StageFields {
    std::array<Estimate, kStageCount>& stages;
};
template <class Visitor>
void visitFields(Visitor& visit, StageFields& s) {
    for (size_t i = 0; i < kStageCount; ++i)
        visit(kStageNames[i], "ns", s.stages[i]);
}

template <class Visitor>
void visitFields(Visitor& visit, ConfigurationResult& r) {
    visit("scene", "", r.scene);
    visit("shape", "", r.shape);
    visit("triangles", "", r.triangles);
    visit("facet_angle", "rad", r.facetAngle);
    visit("path", "", r.path);
    visit("ladder", "", r.ablation);
    visit("rung", "", r.configuration);
    visit("settings", "", r.settings);
    visit("rate", "hz", r.rateHz);
    visit("truth", "", r.truth);
    visit("default", "", r.isDefault);
    visit("pareto", "", r.pareto);
    visit("step_median", "ns", r.step);
    visit("step_mean", "ns", r.stepMean);
    visit("step_p99", "ns", r.stepP99);
    visit("ray_floor", "ns", r.rayFloor);
    StageFields stages{r.stages};
    visit("stage", "", stages);
    visit("errors", "", r.errors);
}

template <class Visitor>
void visitFields(Visitor& visit, RateResult& r) {
    visit("rate", "hz", r.rateHz);
    visit("stiffest_stable", "n_per_m", r.stiffestStable);
    visit("bound", "n_per_m", r.bound);
    visit("energy_created", "J", r.energyCreated);
    visit("busy_share", "", r.busy);
}

template <class Visitor>
void visitFields(Visitor& visit, VoxelResult& v) {
    visit("shape", "", v.shape);
    visit("source", "", v.source);
    visit("method", "", v.method);
    visit("triangles", "", v.triangles);
    visit("voxels_across_diagonal", "", v.across);
    visit("voxel", "m", v.voxel);
    visit("memory", "bytes", v.memory);
    visit("build", "s", v.build);
    visit("position_error_mean", "m", v.meanPosition);
    visit("position_error", "m", v.position);
    visit("surface_error_mean", "m", v.meanSurface);
    visit("surface_error_max", "m", v.maxSurface);
    visit("force_direction_error", "rad", v.direction);
    visit("contact_lost_share", "", v.contactLost);
    visit("step_median", "ns", v.step);
    visit("step_p99", "ns", v.stepP99);
    visit("ray_floor", "ns", v.rayFloor);
}

template <class Visitor>
void visitFields(Visitor& visit, JustNoticeable& j) {
    visit("quantity", "", j.quantity);
    visit("unit", "", j.unit);
    visit("source", "", j.source);
    visit("value", "", j.value);
}

template <class Visitor>
void visitFields(Visitor& visit, Provenance& p) {
    visit("machine", "", p.machine);
    visit("processor", "", p.processor);
    visit("processors", "", p.processors);
    visit("kernel", "", p.kernel);
    visit("compiler", "", p.compiler);
    visit("build_type", "", p.buildType);
    visit("commit", "", p.commit);
    visit("date", "", p.date);
    visit("command", "", p.command);
}

template <class Visitor>
void visitFields(Visitor& visit, StudyResult& s) {
    visit("provenance", "", s.provenance);
    visit("noticeable", "", s.noticeable);
    visit("rungs", "", s.configurations);
    visit("rates", "", s.rates);
    visit("voxels", "", s.voxels);
    visit("problems", "", s.problems);
    visit("notes", "", s.notes);
}

} // namespace touchstone::study
