#include "workbench/figures/tick_csv.h"

#include <array>
#include <charconv>

namespace touchstone {

namespace {

template <class Number>
void append(std::string& text, Number number) {
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
    text.append(buffer.data(), result.ptr);
    text.push_back(',');
}

void append(std::string& text, const glm::dvec3& v) {
    append(text, v.x);
    append(text, v.y);
    append(text, v.z);
}

} // namespace

void appendTickRow(std::string& text, double time, const HapticOutput& output, int64_t stepNs) {
    append(text, time);
    append(text, output.hip);
    append(text, output.proxy);
    append(text, output.normal);
    append(text, output.force);
    append(text, output.contacts);
    append(text, static_cast<unsigned>(output.friction));
    append(text, output.penetration);
    append(text, stepNs);
    append(text, output.commandInWorkspace);
    text.back() = '\n';
}

} // namespace touchstone
