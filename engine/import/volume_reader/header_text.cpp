#include "engine/import/volume_file/flat_volume_format.h"
#include "engine/import/volume_reader/raw_volume.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace touchstone {

namespace {

struct TypeFacts {
    uint32_t bytes;
    const char* name;
};
constexpr TypeFacts kTypes[] = {{1, "uint8"}, {1, "int8"},   {2, "uint16"}, {2, "int16"}, {4, "uint32"},
                                {4, "int32"}, {8, "uint64"}, {8, "int64"},  {4, "float"}, {8, "double"}};

} // namespace

uint32_t bytesOf(SampleType type) {
    return kTypes[static_cast<size_t>(type)].bytes;
}

const char* nameOf(SampleType type) {
    return kTypes[static_cast<size_t>(type)].name;
}

std::string_view trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t\r");
    return first == std::string_view::npos ? std::string_view()
                                           : text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

std::string lowered(std::string_view text) {
    std::string low(text);
    std::ranges::transform(low, low.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return low;
}

std::vector<double> numbersIn(std::string_view text, const char* field, size_t count) {
    constexpr const char* kBetween = " \t\r,()";
    std::vector<double> numbers;
    for (size_t at = text.find_first_not_of(kBetween); at != std::string_view::npos;
         at = text.find_first_not_of(kBetween, at)) {
        double value = 0.0;
        const char* const end = text.data() + text.size();
        at += text[at] == '+' ? 1 : 0; // which from_chars does not know
        const auto [next, problem] = std::from_chars(text.data() + at, end, value);
        if (problem != std::errc() || !std::isfinite(value) || numbers.size() >= 64)
            throw BadVolume(std::string(field) + " is '" + std::string(text.substr(0, 60)) +
                            "', which is not a list of numbers");
        numbers.push_back(value);
        at = static_cast<size_t>(next - text.data());
    }
    if (count > 0 && numbers.size() != count)
        throw BadVolume(std::string(field) + " has " + std::to_string(numbers.size()) +
                        " numbers instead of " + std::to_string(count));
    return numbers;
}

std::string_view headerText(std::span<const uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), std::min<size_t>(bytes.size(), kMostVolumeHeader)};
}

std::string_view nextLine(std::string_view& rest, std::string_view all) {
    const size_t end = rest.find('\n');
    if (end == std::string_view::npos && all.size() == kMostVolumeHeader)
        throw BadVolume("its header is longer than " + std::to_string(kMostVolumeHeader >> 10) +
                        " KiB, or has no end");
    const std::string_view line = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
}

void refuseSeveralFiles(std::string_view name) {
    const std::string first = lowered(name.substr(0, name.find(' ')));
    bool several = first == "list";
    for (size_t at = name.find('%'); at != std::string_view::npos; at = name.find('%', at + 1)) {
        const size_t end = name.find_first_not_of("0123456789", at + 1);
        several = several || (end != std::string_view::npos && name[end] == 'd');
    }
    if (several)
        throw BadVolume("its slices are in files of their own: convert it to one file");
}

uint64_t wholeNumber(double value, const char* field) {
    constexpr double kMost = 9007199254740992.0;
    if (!(value >= 0.0) || value > kMost || value != std::floor(value))
        throw BadVolume(std::string(field) + " has a number that is not a count");
    return static_cast<uint64_t>(value);
}

} // namespace touchstone
