#pragma once
// What a window under test tells of itself (`--status-json`).

#include "tests/support/program.h"
#include "tests/unit/workbench/virtual_display.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace touchstone::test {

using Json = nlohmann::json;

/// The file that a window writes after each picture.
class WindowStatus {
  public:
    /// `first`: the status until there is one. `log`: of the program, for messages.
    WindowStatus(std::filesystem::path file, std::filesystem::path log, Json first)
        : file_(std::move(file)), log_(std::move(log)), first_(std::move(first)) {}

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    /// The newest; fails when the program has gone.
    [[nodiscard]] Json newest(BackgroundProgram& program) const {
        if (!program.running())
            throw std::runtime_error("the window has closed: " + readFile(log_));
        const std::string text = readFile(file_);
        return text.empty() ? first_ : Json::parse(text);
    }
    /// Waits for a status that says so, and returns it.
    [[nodiscard]] Json until(BackgroundProgram& program, const std::string& what,
                             const std::function<bool(const Json&)>& holds) const {
        const auto end = std::chrono::steady_clock::now() + kPatience;
        std::filesystem::file_time_type seen{};
        while (std::chrono::steady_clock::now() < end) {
            std::error_code none; // and then there will be one
            const auto written = std::filesystem::last_write_time(file_, none);
            if (!none && std::exchange(seen, written) != written) {
                const Json now = newest(program);
                if (now["update"] > 0 && holds(now))
                    return now;
            } else if (!program.running()) {
                break;
            }
            constexpr std::chrono::milliseconds kLookEvery{5}; // a sixth of a frame
            std::this_thread::sleep_for(kLookEvery);
        }
        throw std::runtime_error("waited in vain for " + what + ": " + newest(program).dump(2) +
                                 readFile(log_));
    }

  private:
    std::filesystem::path file_, log_;
    Json first_;
};

} // namespace touchstone::test
