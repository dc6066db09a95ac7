// Keyframes by the specification alone, for evaluations that the program is compared with.

#include "tests/support/pose_truth.h"

#include <algorithm>
#include <cmath>

namespace touchstone::test {
namespace {

using Numbers = std::vector<Real>;

Numbers unitOf(Numbers v) {
    Real sum = 0;
    for (const Real x : v)
        sum += x * x;
    for (Real& x : v)
        x /= std::sqrt(sum);
    return v;
}

Numbers mixed(Real a, const Numbers& from, Real b, const Numbers& to) {
    Numbers sum(from.size());
    for (size_t i = 0; i < sum.size(); ++i)
        sum[i] = a * from[i] + b * to[i];
    return sum;
}

/// C.4, with unit quaternions.
Numbers slerped(const Numbers& from, const Numbers& to, Real t) {
    Real dot = 0;
    for (size_t i = 0; i < 4; ++i)
        dot += from[i] * to[i];
    const Real angle = std::acos(std::min<Real>(std::abs(dot), 1)), sign = dot < 0 ? -1 : 1;
    if (angle < 1e-9L)
        return unitOf(mixed(1 - t, from, sign * t, to));
    return mixed(std::sin(angle * (1 - t)) / std::sin(angle), from,
                 sign * std::sin(angle * t) / std::sin(angle), to);
}

Numbers sampled(const Numbers& times, const Numbers& values, const std::string& interpolation, bool rotation,
                Real time) {
    const bool cubic = interpolation == "CUBICSPLINE";
    const size_t width = values.size() / times.size() / (cubic ? 3 : 1);
    const auto part = [&](size_t key, size_t which) { // 0 in-tangent, 1 value, 2 out-tangent
        const size_t first = (cubic ? 3 * key + which : key) * width;
        return Numbers(values.begin() + static_cast<std::ptrdiff_t>(first),
                       values.begin() + static_cast<std::ptrdiff_t>(first + width));
    };
    const auto value = [&](size_t key) { return rotation ? unitOf(part(key, 1)) : part(key, 1); };
    if (time <= times.front())
        return value(0);
    if (time >= times.back())
        return value(times.size() - 1);
    size_t key = 0;
    while (times[key + 1] <= time)
        ++key;
    const Real span = times[key + 1] - times[key], t = (time - times[key]) / span;
    if (interpolation == "STEP")
        return value(key);
    if (!cubic)
        return rotation ? slerped(value(key), value(key + 1), t)
                        : mixed(1 - t, value(key), t, value(key + 1));
    const Real t2 = t * t, t3 = t2 * t;
    const Numbers points = mixed(2 * t3 - 3 * t2 + 1, part(key, 1), -2 * t3 + 3 * t2, part(key + 1, 1));
    const Numbers slopes = mixed(span * (t3 - 2 * t2 + t), part(key, 2), span * (t3 - t2), part(key + 1, 0));
    const Numbers sum = mixed(1, points, 1, slopes);
    return rotation ? unitOf(sum) : sum;
}

} // namespace

TruthFile animated(const TruthFile& file, size_t animation, Real time) {
    TruthFile posed = file;
    const nlohmann::json& stated = file.json["animations"][animation];
    for (const nlohmann::json& channel : stated["channels"]) {
        if (!channel["target"].contains("node"))
            continue;
        const nlohmann::json& sampler = stated["samplers"][channel["sampler"].get<size_t>()];
        const std::string path = channel["target"]["path"];
        const Numbers value =
            sampled(truthNumbers(file, sampler["input"]), truthNumbers(file, sampler["output"]),
                    sampler.value("interpolation", std::string("LINEAR")), path == "rotation", time);
        posed.json["nodes"][channel["target"]["node"].get<size_t>()][path] =
            std::vector<double>(value.begin(), value.end());
    }
    return posed;
}

} // namespace touchstone::test
