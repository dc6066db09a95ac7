#include "renderer/device_choice.h"

#include "engine/core/error.h"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace touchstone {

namespace {

constexpr const char* kFacility = "Vulkan";

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

const char* kindName(DeviceKind kind) {
    switch (kind) {
    case DeviceKind::Discrete:
        return "discrete";
    case DeviceKind::Integrated:
        return "integrated";
    case DeviceKind::Virtual:
        return "virtual";
    case DeviceKind::Software:
        return "software";
    case DeviceKind::Other:
        break;
    }
    return "other";
}

std::string listed(const std::vector<DeviceCandidate>& candidates) {
    std::string text;
    for (size_t i = 0; i < candidates.size(); ++i)
        text += (i > 0 ? "; " : "") + describeCandidate(i, candidates[i]);
    return text;
}

/// A number below `count` is an index, anything else a part of a name ("7900").
bool matches(const DeviceCandidate& candidate, size_t index, size_t count, std::string_view wanted) {
    size_t number = 0;
    const auto [end, problem] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    if (problem == std::errc{} && end == wanted.data() + wanted.size() && number < count)
        return number == index;
    return lower(candidate.name).find(lower(wanted)) != std::string::npos;
}

} // namespace

std::string describeCandidate(size_t index, const DeviceCandidate& candidate) {
    std::string text = std::to_string(index) + ": " + candidate.name + " (" + kindName(candidate.kind) + ")";
    if (!candidate.unfit.empty())
        text += ", unfit: " + candidate.unfit;
    return text;
}

size_t chooseDevice(const std::vector<DeviceCandidate>& candidates, std::string_view wanted) {
    if (candidates.empty())
        throw Error(
            kFacility, "", "no device was found",
            "install a driver for your graphics card, or the software one: apt install mesa-vulkan-drivers");
    size_t best = candidates.size();
    for (size_t i = 0; i < candidates.size(); ++i) {
        const DeviceCandidate& candidate = candidates[i];
        if (!wanted.empty() && !matches(candidate, i, candidates.size(), wanted))
            continue;
        if (!candidate.unfit.empty())
            continue;
        if (best == candidates.size() || candidate.kind < candidates[best].kind)
            best = i;
    }
    if (best < candidates.size())
        return best;
    if (!wanted.empty())
        throw Error(kFacility, "device \"" + std::string(wanted) + "\"",
                    "there is no such fit device; found " + listed(candidates),
                    "leave TOUCHSTONE_GPU unset, or name one of these by a part of its name or its number");
    throw Error(
        kFacility, "", "no device can draw the scene; found " + listed(candidates),
        "update the driver to Vulkan 1.3, or install the software one: apt install mesa-vulkan-drivers");
}

} // namespace touchstone
