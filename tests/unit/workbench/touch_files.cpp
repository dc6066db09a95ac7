#include "tests/unit/workbench/touch_files.h"

#include "tests/support/program.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <sstream>
#include <stdexcept>

namespace touchstone::test {

namespace {

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');)
        cells.push_back(cell);
    return cells;
}

} // namespace

std::string straightPath(const std::vector<double>& from, const std::vector<double>& to, int ticks) {
    std::string text = "t,x,y,z\n";
    for (int i = 0; i < ticks; ++i) {
        const double s = ticks > 1 ? static_cast<double>(i) / (ticks - 1) : 0.0;
        char row[160];
        std::snprintf(row, sizeof row, "%.17g,%.17g,%.17g,%.17g\n", 1e-3 * i, from[0] + s * (to[0] - from[0]),
                      from[1] + s * (to[1] - from[1]), from[2] + s * (to[2] - from[2]));
        text += row;
    }
    return text;
}

Table readTable(const std::filesystem::path& file) {
    std::istringstream stream(readFile(file));
    std::string line;
    std::getline(stream, line);
    Table table;
    table.names = split(line);
    while (std::getline(stream, line)) {
        const std::vector<std::string> cells = split(line);
        if (cells.size() != table.names.size())
            throw std::runtime_error("row " + std::to_string(table.rows) + " has another number of columns");
        for (size_t c = 0; c < cells.size(); ++c) {
            double value = 0.0;
            const char* end = cells[c].data() + cells[c].size();
            const auto [parsed, error] = std::from_chars(cells[c].data(), end, value);
            if (error != std::errc{} || parsed != end)
                throw std::runtime_error("'" + cells[c] + "' is no number");
            table.columns[table.names[c]].push_back(value);
        }
        ++table.rows;
    }
    return table;
}

std::string withoutColumn(const std::string& csv, const std::string& name) {
    std::istringstream stream(csv);
    std::string line, rest;
    size_t column = 0;
    for (bool header = true; std::getline(stream, line); header = false) {
        std::vector<std::string> cells = split(line);
        if (header)
            column = static_cast<size_t>(std::find(cells.begin(), cells.end(), name) - cells.begin());
        cells.at(column).clear();
        for (const std::string& cell : cells)
            rest += cell + ",";
        rest += "\n";
    }
    return rest;
}

} // namespace touchstone::test
