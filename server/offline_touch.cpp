#include "server/offline_touch.h"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace touchstone::server {

namespace {

constexpr size_t kMostPositions = 100'000;

/// What a message asks for.
struct Asked {
    std::string stroke; // empty: `positions`
    std::vector<ts::Vector> positions;
    double rate = 1000.0; // Hz
    std::map<std::string, std::string> settings;
};

std::vector<ts::Vector> positionsIn(const Json& message) {
    const auto rows = member<std::vector<std::vector<double>>>(message, "positions");
    if (rows.size() > kMostPositions)
        throw Refusal("'positions' has more than 100000 rows");
    std::vector<ts::Vector> positions(rows.size());
    for (size_t i = 0; i < rows.size(); ++i) {
        double row[3];
        numbersOf(rows[i], row, "positions");
        positions[i] = {row[0], row[1], row[2]};
    }
    return positions;
}

Asked askedBy(const Json& message) {
    Asked asked;
    if (message.contains("stroke") == message.contains("positions"))
        throw Refusal("give either 'stroke' or 'positions'");
    if (message.contains("stroke"))
        asked.stroke = member<std::string>(message, "stroke");
    else
        asked.positions = positionsIn(message);
    if (message.contains("stroke") && asked.stroke.empty())
        throw Refusal("'stroke' is empty");
    asked.rate = memberOr(message, "rate", asked.rate);
    if (!(asked.rate >= 1.0 && asked.rate <= 1e6))
        throw Refusal("'rate' is not within 1 .. 1e6 Hz");
    asked.settings = memberOr(message, "settings", asked.settings);
    return asked;
}

/// The positions of the stroke: ts_stroke's rows, at most as many as a path may have.
std::vector<ts::Vector> laid(ts_scene scene, const Asked& asked) {
    size_t rows = 0;
    ts::check(ts_stroke(scene, asked.stroke.c_str(), 0.0, 0.0, asked.rate, nullptr, 0, &rows));
    if (rows > kMostPositions)
        throw ts::Error(TS_ARGUMENT, "rate: makes " + std::to_string(rows) +
                                         " positions of the stroke, and "
                                         "100000 are the most");
    std::vector<ts::Vector> positions(rows);
    ts::check(
        ts_stroke(scene, asked.stroke.c_str(), 0.0, 0.0, asked.rate, positions.data()->data(), rows, &rows));
    return positions;
}

ts::Ticks touched(ts_scene scene, const Asked& asked, std::atomic<bool>& stopping) {
    ts::Settings settings;
    for (const auto& [name, value] : asked.settings)
        settings.set(name, value);
    const std::vector<ts::Vector> positions = asked.stroke.empty() ? asked.positions : laid(scene, asked);
    ts::Ticks ticks(positions.size());
    if (positions.empty())
        return ticks;
    ts_path path = TS_STRUCT(ts_path);
    path.positions = positions.data()->data();
    path.count = positions.size();
    path.rate = asked.rate;
    path.context = &stopping;
    path.progress = [](void* context, size_t, size_t) {
        return static_cast<std::atomic<bool>*>(context)->load(std::memory_order_relaxed) ? 1 : 0;
    };
    const ts_ticks arrays = ticks.arrays();
    ts::check(ts_touch(scene, settings.get(), &path, &arrays));
    return ticks;
}

} // namespace

void OfflineTouch::begin(const Json& message, uint64_t client, const std::shared_ptr<ts::Scene>& scene) {
    if (making_.valid())
        throw Refusal("another path is being touched");
    if (scene == nullptr)
        throw Refusal("there is no scene yet");
    const auto id = message.contains("id") && message["id"].is_number_integer() ? message["id"].get<int64_t>()
                                                                                : int64_t{0};
    if (id < 1 || id > std::numeric_limits<uint32_t>::max())
        throw Refusal("'id' is not within 1 .. 4294967295: the ticks bear it");
    client_ = client;
    making_ = std::async(std::launch::async, [this, scene, asked = askedBy(message), client, id]() -> Made {
        (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 19);
        Made made{client, static_cast<uint32_t>(id), ts::Ticks(), {}};
        try {
            made.ticks = touched(scene->get(), asked, stopping_);
        } catch (const std::exception& error) {
            made.error = error.what();
        }
        return made;
    });
}

void OfflineTouch::forget(uint64_t client) {
    if (making_.valid() && client_ == client)
        stopping_.store(true, std::memory_order_relaxed);
}

std::optional<OfflineTouch::Made> OfflineTouch::take() {
    if (!making_.valid() || making_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return std::nullopt;
    Made made = making_.get();
    stopping_.store(false, std::memory_order_relaxed);
    return made;
}

void OfflineTouch::stop() {
    stopping_.store(true, std::memory_order_relaxed);
    if (making_.valid())
        making_.wait();
}

} // namespace touchstone::server
