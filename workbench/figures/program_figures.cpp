#include "workbench/figures/program_figures.h"

#include "haptics/program/program_fault.h"
#include "haptics/program/program_touch.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace touchstone {

namespace {

using program::ProgramGradient;

struct Figures {
    double ns = 0.0; ///< of one call, of the fastest batch
    uint32_t cost = 0;
    int flagged = 0;           ///< calls without a result
    program::ProgramEnd end{}; ///< of one of these
};

/// Touches a stroke over a patch of 50 mm, 2 mm deep.
Figures measure(const program::RegisterProgram& compiled, ProgramGradient gradient,
                std::chrono::steady_clock::time_point end) {
    constexpr int kBatches = 20, kCalls = 500;
    Figures figures{.ns = INFINITY};
    for (int batch = 0; batch < kBatches; ++batch) {
        const auto start = std::chrono::steady_clock::now();
        if (batch > 0 && start > end)
            break;
        int flagged = 0;
        for (int i = 0; i < kCalls; ++i) {
            const double t = static_cast<double>(i) / kCalls;
            const program::ProgramContact contact{
                .position = {0.05 * t, 0.01 + 0.02 * std::sin(20.0 * t), 0.01 * t},
                .toolDirection = {1.0, 0.0, 0.0},
                .toolVelocity = {0.1, 0.0, 0.0},
                .depth = 0.002,
                .stiffness = 600.0,
                .staticFriction = 0.5,
                .dynamicFriction = 0.4,
                .filterWidth = 1e-4,
                .time = t,
                .maxStiffness = 3000.0};
            const program::ProgramFelt felt = feelProgram(compiled, gradient, contact);
            figures.cost = std::max(figures.cost, felt.cost);
            if (felt.ending == program::Ending::Finished)
                continue;
            ++flagged;
            figures.end = {felt.ending, felt.at};
        }
        const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
        figures.ns = std::min(figures.ns, time.count() / kCalls);
        figures.flagged = flagged;
    }
    return figures;
}

} // namespace

nlohmann::ordered_json programFigures(const program::RegisterProgram& compiled, std::string_view source,
                                      int64_t longestNs) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::nanoseconds(longestNs);
    const Figures plain = measure(compiled, ProgramGradient::None, end),
                  dual = measure(compiled, ProgramGradient::Dual, end),
                  central = measure(compiled, ProgramGradient::Central, end);
    return {{"instructions", compiled.instructions.size()},
            {"registers", compiled.registers},
            {"ns_per_tick", std::round(plain.ns)},
            {"ns_with_gradients", std::round(dual.ns)},
            {"ns_with_differences", std::round(central.ns)},
            {"cost", plain.cost},
            {"budget", program::kBudget},
            {"flagged_share", static_cast<double>(dual.flagged) / 500.0},
            {"fault", program::textOf(program::faultOf(compiled, source, dual.end))}};
}

} // namespace touchstone
