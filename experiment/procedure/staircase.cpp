#include "experiment/procedure/staircase.h"

#include "engine/core/error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace touchstone::experiment {

namespace {

void check(const StaircaseRule& rule) {
    const auto refuse = [](const char* problem, const char* remedy) {
        throw Error("staircase", "", problem, remedy);
    };
    for (const double value : {rule.start, rule.largeStep, rule.smallStep, rule.lowest, rule.highest})
        if (!std::isfinite(value))
            refuse("a number is not finite", "give levels and steps as numbers");
    if (rule.largeStep <= 0.0 || rule.smallStep <= 0.0)
        refuse("a step is not positive", "a larger level is the harder one");
    if (rule.lowest > rule.highest || rule.start < rule.lowest || rule.start > rule.highest)
        refuse("the first level lies outside of the levels", "lowest <= start <= highest");
    if (rule.averaged == 0 || rule.averaged > rule.reversals)
        refuse("it averages more reversals than it counts", "1 <= averaged <= reversals");
}

} // namespace

Staircase::Staircase(const StaircaseRule& rule) : rule_(rule), level_(rule.start) {
    check(rule);
}

void Staircase::answer(bool right) {
    if (finished())
        return;
    Direction turn = Direction::None;
    if (!right)
        turn = Direction::Down;
    else if (++rightInARow_ == 2)
        turn = Direction::Up;
    trials_.push_back(
        {level_, right, turn != Direction::None && direction_ != Direction::None && turn != direction_});
    if (turn == Direction::None)
        return;
    rightInARow_ = 0;
    if (trials_.back().reversal)
        reversals_.push_back(level_);
    direction_ = turn;
    const double step = reversals_.size() < rule_.largeReversals ? rule_.largeStep : rule_.smallStep;
    level_ = std::clamp(level_ + (turn == Direction::Up ? step : -step), rule_.lowest, rule_.highest);
}

std::optional<double> Staircase::threshold() const noexcept {
    if (reversals_.size() < rule_.reversals)
        return std::nullopt;
    const auto last = reversals_.end() - static_cast<std::ptrdiff_t>(rule_.averaged);
    return std::accumulate(last, reversals_.end(), 0.0) / static_cast<double>(rule_.averaged);
}

} // namespace touchstone::experiment
