#include "workbench/files/recording_controller.h"

#include "engine/core/error.h"
#include "workbench/files/state_folder.h"
#include "workbench/guards/crash_note.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdio>
#include <ctime>
#include <utility>

namespace touchstone {

RecordingController::RecordingController(ServoLoop& servo, const RecordingOptions& options,
                                         std::string command, std::function<void(const std::string&)> tell)
    : recorder_(servo), command_(std::move(command)), tell_(std::move(tell)) {
    if (!options.record.empty())
        recorder_.start(options.record, command_);
    if (options.flight)
        startFlightRecorder(options);
}

void RecordingController::startFlightRecorder(const RecordingOptions& options) {
    FlightConfig config;
    config.folder = options.flightFolder.empty() ? stateFolder() / "flight" : options.flightFolder;
    config.seconds = options.flightSeconds;
    config.origin = recordingOrigin("flight recorder of " + command_, recorder_.rateHz());
    try {
        for (const KeptFlight& kept : FlightRecorder::recover(config))
            say(kept.why + ": " + kept.file.string());
        recorder_.startFlightRecorder(std::move(config));
        leaveCrashNote("the last seconds are in " + recorder_.flightRecorder()->session().string() +
                       "-a and -b" + std::string(kRecordingEnding) +
                       "; they are kept when Touchstone starts again");
    } catch (const std::exception& error) {
        say(std::string("no flight recorder: ") + error.what());
    }
}

void RecordingController::say(const std::string& message) {
    std::fprintf(stderr, "touchstone: %s\n", message.c_str());
    if (tell_)
        tell_(message);
}

void RecordingController::update() {
    recorder_.flush();
    const std::string problem = recorder_.takeProblem();
    if (!problem.empty()) {
        problems_.push_back(problem);
        say(problem);
    }
    for (const KeptFlight& kept : recorder_.takeKept()) {
        kept_.push_back(kept.file.string());
        say(kept.why + "; recorded in " + kept.file.string());
    }
}

void RecordingController::finish() {
    update();
    recorder_.finish();
    update();
    leaveCrashNote("");
}

void RecordingController::toggle() {
    if (recorder_.recording()) {
        recorder_.stop();
        update();
        return;
    }
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    std::array<char, 32> date{};
    std::strftime(date.data(), date.size(), "%Y%m%d-%H%M%S", &local);
    try {
        const std::filesystem::path folder = stateFolder() / "recordings";
        std::filesystem::create_directories(folder);
        recorder_.start(folder / (date.data() + std::string(kRecordingEnding)), command_);
    } catch (const std::exception& error) {
        say(error.what());
    }
}

nlohmann::ordered_json RecordingController::json() const {
    nlohmann::ordered_json json;
    json["file"] = recorder_.file().empty() ? nlohmann::ordered_json(nullptr)
                                            : nlohmann::ordered_json(recorder_.file().string());
    json["ticks"] = recorder_.ticks();
    json["flight_recorder"] = recorder_.flightRecorder() != nullptr;
    json["kept"] = kept_;
    json["problems"] = problems_;
    return json;
}

} // namespace touchstone
