#pragma once
// The files that `touch` reads and writes.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace touchstone::test {

/// A straight path at 1 kHz, `ticks` rows from `from` to `to` (m), as HIP.csv.
[[nodiscard]] std::string straightPath(const std::vector<double>& from, const std::vector<double>& to,
                                       int ticks);

/// A CSV as columns of numbers by name, and its lines as text.
struct Table {
    std::vector<std::string> names;
    std::map<std::string, std::vector<double>> columns;
    size_t rows = 0;

    [[nodiscard]] const std::vector<double>& operator[](const std::string& name) const {
        return columns.at(name);
    }
};
/// Throws std::runtime_error where a row has another number of columns or a value that is no number.
[[nodiscard]] Table readTable(const std::filesystem::path& file);

/// The text without the column `name`: what must be byte-identical from run to run.
[[nodiscard]] std::string withoutColumn(const std::string& csv, const std::string& name);

} // namespace touchstone::test
