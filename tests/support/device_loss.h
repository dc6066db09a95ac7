#pragma once
// Loses the Vulkan device, or its window's surface, when a test wants it (tests/support/loss_layer.cpp).

#include "tests/support/program.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace touchstone::test {

/// The environment in which there is something that loses devices; programs and this process itself, before
/// its first Gpu, may have it.
class DeviceLoss {
  public:
    /// `file`: does not exist yet.
    explicit DeviceLoss(std::filesystem::path file) : file_(std::move(file)) {}

    /// The validation layer sees what the program does before the loss does, as with a real device.
    [[nodiscard]] Environment environment() const {
        return {std::string("VK_LAYER_PATH=") + LOSS_LAYER_FOLDER + ":/usr/share/vulkan/explicit_layer.d",
                "VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation:VK_LAYER_TOUCHSTONE_loss",
                "TOUCHSTONE_LOSS_FILE=" + file_.string()};
    }
    void useHere() const {
        for (const std::string& variable : environment()) {
            const size_t equals = variable.find('=');
            ::setenv(variable.substr(0, equals).c_str(), variable.substr(equals + 1).c_str(), 1);
        }
    }

    /// At the `count`-th such call from now: "submit", "present", "acquire", "wait", "surface" or "create".
    /// `again`: that often on every device that follows.
    void lose(const std::string& kind, int count = 1, bool again = false) const {
        const std::filesystem::path fresh = file_.string() + ".new";
        std::ofstream(fresh) << kind << ' ' << count << (again ? " again" : "") << '\n';
        std::filesystem::rename(fresh, file_); // whole or not at all
    }
    /// What was asked for has happened.
    [[nodiscard]] bool lost() const { return !std::filesystem::exists(file_); }

  private:
    std::filesystem::path file_;
};

} // namespace touchstone::test
