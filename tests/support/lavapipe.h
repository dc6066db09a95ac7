#pragma once
// Pictures are compared on one device: Mesa's software one, whichever cards the machine has.

#include <cstdlib>
#include <filesystem>
#include <string>

namespace touchstone::test {

/// Makes the Vulkan loader see lavapipe alone, unless the environment already names a driver. Before the
/// first Gpu.
inline void useLavapipe() {
    const std::filesystem::path drivers = "/usr/share/vulkan/icd.d";
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(drivers, ignored)) {
        const std::string name = entry.path().filename().string();
        if (name.rfind("lvp_icd", 0) != 0)
            continue;
        ::setenv("VK_ICD_FILENAMES", entry.path().c_str(), 0);
        ::setenv("VK_DRIVER_FILES", entry.path().c_str(), 0);
        return;
    }
}

} // namespace touchstone::test
