#include "workbench/figures/tick_csv.h"

#include "haptics/finger/finger_pad.h"

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

std::string tickCsvHeader(bool pad) {
    std::string header(kTickCsvHeader);
    if (pad)
        header.insert(header.size() - 1, ",pad_along,pad_across");
    return header;
}

void appendPadPlace(std::string& text, const DeviceSample& sample, const HapticOutput& output) {
    const glm::dquat turn = sample.mapping.workspaceFromDevice.rotation * sample.orientation;
    const glm::dvec2 place =
        output.contacts > 0 ? FingerPad{}.locationOn(turn, output.normal) : glm::dvec2(0.0);
    text.back() = ',';
    append(text, place.x);
    append(text, place.y);
    text.back() = '\n';
}

} // namespace touchstone
