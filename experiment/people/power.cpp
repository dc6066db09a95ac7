#include "experiment/people/power.h"

#include "experiment/procedure/staircase.h"
#include "experiment/statistics/distributions.h"
#include "experiment/statistics/variance.h"

#include <algorithm>
#include <cmath>

namespace touchstone::experiment {

namespace {

/// A threshold that a staircase did not reach is its last level: the analysis needs every cell.
double runOne(DifferenceTable& table, size_t reversals, const SimulatedPerson& person, const PowerPlan& plan,
              Draw& draw, double& trials) {
    StaircaseRule rule = table.condition().rule;
    const double share = static_cast<double>(rule.averaged) / static_cast<double>(rule.reversals);
    rule.reversals = reversals;
    rule.averaged =
        std::max<size_t>(1, static_cast<size_t>(std::lround(share * static_cast<double>(reversals))));
    rule.largeReversals = std::min(rule.largeReversals, reversals - rule.averaged);
    Staircase staircase(rule);
    while (!staircase.finished()) {
        const double right = shareRight(sensitivity(table.condition(), table.at(staircase.level()),
                                                    person.force, person.acuity, plan.noise, plan.attention));
        staircase.answer(draw.uniform() < right);
    }
    trials += static_cast<double>(staircase.trials().size());
    return staircase.threshold().value_or(staircase.level());
}

PowerRow rowOf(std::vector<DifferenceTable>& tables, const PowerPlan& plan, size_t people, size_t reversals) {
    constexpr double kSignificant = 0.05;
    PowerRow row{.people = people, .reversals = reversals};
    const size_t count = tables.size();
    row.told.assign(count * (count - 1) / 2, 0.0);
    row.deviation.assign(count, 0.0);
    Draw draw(plan.seed ^ (people << 20) ^ (reversals << 40));
    const double told = studentizedRangeQuantile(kSignificant, static_cast<int>(count),
                                                 static_cast<double>((count - 1) * (people - 1)));
    const double each = 1.0 / static_cast<double>(plan.experiments);
    for (size_t experiment = 0; experiment < plan.experiments; ++experiment) {
        Thresholds values;
        for (size_t person = 0; person < people; ++person) {
            const SimulatedPerson who = personOf(plan.seed + 7919 * (experiment + 1), person, plan.spread);
            values.emplace_back();
            for (DifferenceTable& table : tables)
                values.back().push_back(runOne(table, reversals, who, plan, draw, row.trials));
        }
        const Variance variance = analyse(values, false);
        row.anova += variance.correctedP < kSignificant ? each : 0.0;
        for (size_t i = 0; i < row.told.size(); ++i)
            row.told[i] += variance.tukey[i].q > told ? each : 0.0;
        for (size_t i = 0; i < count; ++i)
            row.deviation[i] += each * variance.means[i].deviation;
    }
    row.trials /= static_cast<double>(plan.experiments * people * count);
    return row;
}

} // namespace

std::vector<PowerRow> powerOf(std::vector<DifferenceTable>& tables, const PowerPlan& plan) {
    std::vector<PowerRow> rows;
    if (tables.size() < 2)
        return rows;
    for (const size_t reversals : plan.reversals)
        for (const size_t people : plan.people)
            rows.push_back(rowOf(tables, plan, people, reversals));
    return rows;
}

} // namespace touchstone::experiment
