#include "workbench/readings/force_history.h"

#include "workbench/readings/force_parts.h"

#include <algorithm>

namespace touchstone {

void ForceHistory::add(const TickRecord& record, bool recorded) {
    const HapticOutput& output = record.output;
    const glm::dvec3 along = output.force - glm::dot(output.force, output.normal) * output.normal;
    const ForceParts parts = forceParts(output);
    entries_[next_] = {.time = record.time,
                       .force = static_cast<float>(glm::length(output.force)),
                       .tangential = output.contacts > 0 ? static_cast<float>(glm::length(along)) : 0.0f,
                       .normal = static_cast<float>(parts.normal),
                       .surfaceTangential = static_cast<float>(parts.tangential),
                       .x = static_cast<float>(output.force.x),
                       .y = static_cast<float>(output.force.y),
                       .z = static_cast<float>(output.force.z),
                       .penetration = static_cast<float>(output.penetration),
                       .energy = static_cast<float>(output.energyBalance),
                       .step = 1e-9f * static_cast<float>(record.stepNs),
                       .contact = output.contacts > 0,
                       .recorded = recorded};
    next_ = (next_ + 1) % entries_.size();
    count_ = std::min(count_ + 1, entries_.size());
}

ForceHistory::Entry ForceHistory::mean(size_t ticks) const {
    Entry sum;
    size_t contacts = 0;
    for (size_t i = count_ - std::min(ticks, count_); i < count_; ++i) {
        if (!at(i).contact)
            continue;
        sum.force += at(i).force;
        sum.tangential += at(i).tangential;
        ++contacts;
    }
    if (contacts > 0) {
        sum.force /= static_cast<float>(contacts);
        sum.tangential /= static_cast<float>(contacts);
        sum.contact = true;
    }
    return sum;
}

} // namespace touchstone
