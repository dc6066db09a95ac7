#include "workbench/files/saved_file.h"

#include "engine/core/output_file.h"
#include "workbench/files/state_folder.h"

#include <array>
#include <cstdio>
#include <ctime>
#include <string>

namespace touchstone {

std::filesystem::path savedFile(std::string_view what, std::string_view ending) {
    const std::filesystem::path folder = stateFolder() / "saved";
    std::filesystem::create_directories(folder);
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    std::array<char, 32> date{};
    std::strftime(date.data(), date.size(), "-%Y%m%d-%H%M%S", &local);
    return folder / (std::string(what) + date.data() + std::string(ending));
}

void writeChart(const std::filesystem::path& file, const ForceHistory& history) {
    std::string text = "t,force,tangential,penetration,energy,step,contact,recorded\n";
    std::array<char, 192> row{};
    for (size_t i = 0; i < history.size(); ++i) {
        const ForceHistory::Entry& e = history.at(i);
        std::snprintf(row.data(), row.size(), "%.6f,%.9g,%.9g,%.9g,%.9g,%.9g,%d,%d\n", e.time,
                      static_cast<double>(e.force), static_cast<double>(e.tangential),
                      static_cast<double>(e.penetration), static_cast<double>(e.energy),
                      static_cast<double>(e.step), e.contact ? 1 : 0, e.recorded ? 1 : 0);
        text += row.data();
    }
    writeFile(file, text);
}

} // namespace touchstone
