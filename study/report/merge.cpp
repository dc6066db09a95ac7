#include "study/report/report.h"

#include <cmath>
#include <set>
#include <tuple>

namespace touchstone::study {

namespace {

/// What two results must share to be comparable.
std::string measuredBy(const Provenance& p) {
    return p.machine + ", " + p.processor + ", " + p.compiler + ", " + p.buildType + ", commit " + p.commit;
}

template <class Element, class Key>
void append(std::vector<Element>& all, const std::vector<Element>& more, std::set<Key>& known,
            Key (*keyOf)(const Element&), const auto& twice) {
    for (const Element& element : more)
        if (known.insert(keyOf(element)).second)
            all.push_back(element);
        else
            twice(element);
}

using ConfigurationKey = std::tuple<std::string, std::string, std::string, std::string, std::string, double>;
ConfigurationKey rungKey(const ConfigurationResult& r) {
    return {r.scene, r.path, r.ablation, r.configuration, r.settings, r.rateHz};
}
double rateKey(const RateResult& r) {
    return r.rateHz;
}
using VoxelKey = std::tuple<std::string, std::string, std::string, size_t, double>;
VoxelKey voxelKey(const VoxelResult& v) {
    return {v.shape, v.source, v.method, v.triangles, v.across};
}
std::string noticeableKey(const JustNoticeable& j) {
    return j.quantity + "\n" + j.source;
}

} // namespace

StudyResult mergeStudies(std::span<const StudyResult> shards) {
    StudyResult all;
    std::set<ConfigurationKey> configurations;
    std::set<double> rates;
    std::set<VoxelKey> voxels;
    std::set<std::string> noticeable, strangers;
    if (!shards.empty()) {
        all.provenance = shards.front().provenance;
        strangers.insert(measuredBy(all.provenance));
    }
    for (const StudyResult& shard : shards) {
        if (strangers.insert(measuredBy(shard.provenance)).second)
            all.problems.push_back("some times were measured elsewhere and do not compare: " +
                                   measuredBy(shard.provenance));
        append(all.noticeable, shard.noticeable, noticeable, noticeableKey, [](const JustNoticeable&) {});
        append(all.configurations, shard.configurations, configurations, rungKey,
               [&](const ConfigurationResult& r) {
                   all.problems.push_back(r.scene + ", " + r.path + ", " + r.configuration +
                                          ": measured twice; the first one counts");
               });
        append(all.rates, shard.rates, rates, rateKey, [&](const RateResult& r) {
            all.problems.push_back("the servo rate of " + std::to_string(std::lround(r.rateHz)) +
                                   " Hz was measured twice; the first one counts");
        });
        append(all.voxels, shard.voxels, voxels, voxelKey, [&](const VoxelResult& v) {
            all.problems.push_back(v.shape + ", " + v.source + ", " + v.method +
                                   ": its voxels were measured twice; the first ones count");
        });
        all.problems.insert(all.problems.end(), shard.problems.begin(), shard.problems.end());
        all.notes.insert(all.notes.end(), shard.notes.begin(), shard.notes.end());
    }
    return all;
}

} // namespace touchstone::study
