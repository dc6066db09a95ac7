#include "server/ticks_sent.h"

namespace touchstone::server {

namespace {

void append(std::string& bytes, const void* data, size_t size) {
    bytes.append(static_cast<const char*>(data), size);
}

} // namespace

std::string ticksFrame(const ts::Ticks& ticks, size_t first, size_t count, uint32_t answers) {
    constexpr size_t kTick = 13 * sizeof(double) + 2 * sizeof(uint32_t);
    std::string bytes = "TSTK";
    const uint32_t head[3]{kProtocol, static_cast<uint32_t>(count), answers};
    bytes.reserve(bytes.size() + sizeof head + count * kTick);
    append(bytes, head, sizeof head);
    for (size_t i = first; i < first + count; ++i) {
        append(bytes, &ticks.time[i], sizeof(double));
        for (const auto* rows : {&ticks.hip, &ticks.proxy, &ticks.force, &ticks.command})
            append(bytes, (*rows)[i].data(), sizeof(ts::Vector));
        append(bytes, &ticks.contacts[i], sizeof(uint32_t));
        append(bytes, &ticks.flags[i], sizeof(uint32_t));
    }
    return bytes;
}

Json stateEvent(const ts_state& state) {
    return {{"event", "state"},
            {"tick", state.tick},
            {"time", state.time},
            {"hip", vectorOf(state.hip)},
            {"proxy", vectorOf(state.proxy)},
            {"normal", vectorOf(state.normal)},
            {"force", vectorOf(state.force)},
            {"command", vectorOf(state.command)},
            {"penetration", state.penetration},
            {"contacts", state.contacts},
            {"friction", state.friction},
            {"flags", state.flags},
            {"ticks", state.ticks},
            {"missed", state.missed},
            {"started", state.started},
            {"wake_us", 1e-3 * static_cast<double>(state.wake_ns)},
            {"step_us", 1e-3 * static_cast<double>(state.step_ns)},
            {"rendered", state.rendered != 0}};
}

} // namespace touchstone::server
