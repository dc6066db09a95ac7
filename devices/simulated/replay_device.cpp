#include "devices/simulated/replay_device.h"

#include "engine/core/error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

namespace touchstone {

namespace {

constexpr std::array<const char*, 4> kColumns{"t", "x", "y", "z"};

std::string_view trimmed(std::string_view text) {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
    while (!text.empty() && blank(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && blank(text.back()))
        text.remove_suffix(1);
    return text;
}

std::vector<std::string_view> cells(std::string_view line) {
    std::vector<std::string_view> result;
    for (;;) {
        const size_t comma = line.find(',');
        result.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos)
            return result;
        line.remove_prefix(comma + 1);
    }
}

std::string quoted(std::string_view cell) {
    constexpr size_t kLongest = 40;
    return '"' + std::string(cell.substr(0, kLongest)) + (cell.size() > kLongest ? "..." : "") + '"';
}

class Reader {
  public:
    Reader(std::istream& in, const std::string& name) : in_(in), name_(name) {}

    HipPath read() {
        readHeader();
        while (nextLine())
            if (!trimmed(line_).empty())
                readSample();
        if (in_.bad())
            fail("", "could not be read to its end", "check that it is a file and that the disk is well");
        if (path_.times.empty())
            fail("", "holds no sample", "add at least one line of t,x,y,z below the header");
        return std::move(path_);
    }

  private:
    [[noreturn]] void fail(const std::string& column, const std::string& problem,
                           const std::string& remedy) const {
        std::string place = "line " + std::to_string(number_);
        if (!column.empty())
            place += ", column " + column;
        throw Error(name_, place, problem, remedy);
    }

    bool nextLine() {
        if (!std::getline(in_, line_))
            return false;
        ++number_;
        return true;
    }

    void readHeader() {
        const char* remedy = "begin the file with the line t,x,y,z";
        if (!nextLine()) {
            number_ = 1;
            fail("", "the file is empty", remedy);
        }
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
        if (line_.starts_with(kByteOrderMark))
            line_.erase(0, kByteOrderMark.size());
        const std::vector<std::string_view> names = cells(line_);
        for (size_t i = 0; i < kColumns.size(); ++i) {
            const auto found = std::find(names.begin(), names.end(), kColumns[i]);
            if (found == names.end())
                fail(kColumns[i], "the header does not name it", remedy);
            if (std::find(found + 1, names.end(), kColumns[i]) != names.end())
                fail(kColumns[i], "the header names it twice", remedy);
            column_[i] = static_cast<size_t>(found - names.begin());
        }
        width_ = names.size();
    }

    [[nodiscard]] double number(std::string_view cell, const char* column) const {
        if (cell.starts_with('+'))
            cell.remove_prefix(1);
        double value = 0.0;
        const auto [end, problem] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
        if (problem != std::errc() || end != cell.data() + cell.size())
            fail(column, quoted(cell) + " is not a number",
                 "write a decimal number with a point, such as 0.0125");
        if (!std::isfinite(value))
            fail(column, quoted(cell) + " is not finite", "leave the sample out or repair it");
        return value;
    }

    void readSample() {
        const std::vector<std::string_view> row = cells(line_);
        if (row.size() != width_)
            fail("",
                 "has " + std::to_string(row.size()) + " values where the header names " +
                     std::to_string(width_),
                 "give every line one value a column");
        std::array<double, 4> values;
        for (size_t i = 0; i < kColumns.size(); ++i)
            values[i] = number(row[column_[i]], kColumns[i]);
        if (!path_.times.empty() && !(values[0] > path_.times.back()))
            fail("t", "the time does not increase",
                 "sort the samples by time and drop those that repeat one");
        path_.times.push_back(values[0]);
        path_.positions.emplace_back(values[1], values[2], values[3]);
    }

    std::istream& in_;
    const std::string& name_;
    std::string line_;
    size_t number_ = 0, width_ = 0;
    std::array<size_t, 4> column_{};
    HipPath path_;
};

} // namespace

HipPath readHipPath(std::istream& in, const std::string& name) {
    return Reader(in, name).read();
}

HipPath readHipPath(const std::filesystem::path& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        throw Error(file.string(), "", "is a folder", "name a CSV file with the columns t,x,y,z");
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw Error(file.string(), "", "cannot be opened", "check the name and that you may read the file");
    return readHipPath(in, file.string());
}

ReplayDevice::ReplayDevice(HipPath path) : path_(std::move(path)) {
    if (path_.times.empty() || path_.times.size() != path_.positions.size())
        throw Error("replay", "", "the path holds no sample", "give it at least one");
}

DeviceSample ReplayDevice::sample(double time) noexcept {
    const std::vector<double>& times = path_.times;
    const double at = times.front() + (std::isfinite(time) ? time : 0.0);
    const auto after = std::upper_bound(times.begin(), times.end(), at);
    DeviceSample sample;
    sample.valid = true;
    if (after == times.begin()) {
        sample.position = path_.positions.front();
    } else if (after == times.end()) {
        sample.position = path_.positions.back();
    } else {
        const auto next = static_cast<size_t>(after - times.begin());
        const double fraction = (at - times[next - 1]) / (times[next] - times[next - 1]);
        sample.position = glm::mix(path_.positions[next - 1], path_.positions[next], fraction);
    }
    return sample;
}

} // namespace touchstone
