#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace touchstone {

/// What became of a file that the user saved.
struct SavedNote {
    std::filesystem::path file; ///< empty: none yet, or it is not saved
    std::string problem;        ///< why it is not saved; empty: no problem
    double at = -1e9;           ///< s, secondsNow() of the result

    /// "saved /…/charts.csv", or the problem; empty before the first one.
    [[nodiscard]] std::string text() const { return file.empty() ? problem : "saved " + file.string(); }
};

/// An unused path for files that the window saves: in the state folder's `saved`, named by content and time.
/// No file beside it has the same stem. Creates the folder; throws std::filesystem::filesystem_error.
[[nodiscard]] std::filesystem::path savedFile(std::string_view what, std::string_view ending);

} // namespace touchstone
