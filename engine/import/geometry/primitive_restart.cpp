#include "engine/import/geometry/primitive_restart.h"

#include "engine/import/file/tinygltf.h"

#include <algorithm>
#include <span>

namespace touchstone {
namespace {

using Run = std::span<const uint32_t>;

/// Appends `run` to a strip of triangles. Every second triangle of a strip is reversed, so the run must start
/// at an even index; the triangles in between have two equal corners.
void joinStrip(std::vector<uint32_t>& strip, Run run) {
    if (run.size() < 3)
        return;
    if (!strip.empty()) {
        strip.push_back(strip.back());
        strip.push_back(run.front());
        if (strip.size() % 2 != 0)
            strip.push_back(run.front());
    }
    strip.insert(strip.end(), run.begin(), run.end());
}

/// Appends the complete primitives of `run`, with `corners` each, to a list.
void joinList(std::vector<uint32_t>& list, Run run, size_t corners) {
    const Run whole = run.first(run.size() - run.size() % corners);
    list.insert(list.end(), whole.begin(), whole.end());
}

} // namespace

std::vector<uint32_t> withoutRestarts(ImportContext& context, std::vector<uint32_t> indices, uint32_t restart,
                                      size_t vertexCount, int mode, const std::string& place) {
    const auto first = std::find(indices.begin(), indices.end(), restart);
    if (first == indices.end())
        return indices;
    const std::string what = "index " + std::to_string(first - indices.begin()) + " is " +
                             std::to_string(restart) + ", the primitive-restart value, which glTF forbids";
    if (restart < vertexCount) {
        context.warn(place, what + "; it is read as a vertex");
        return indices;
    }
    const bool strip = mode == TINYGLTF_MODE_TRIANGLE_STRIP;
    const size_t corners = mode == TINYGLTF_MODE_POINTS      ? 1
                           : mode == TINYGLTF_MODE_LINE      ? 2
                           : mode == TINYGLTF_MODE_TRIANGLES ? 3
                                                             : 0;
    if (!strip && corners == 0)
        context.fail(place, what);
    context.warn(place, what + "; the primitive ends there and another begins");
    context.spendGeometry(2 * indices.size() * sizeof(uint32_t), place);
    std::vector<uint32_t> joined;
    for (Run rest = indices; !rest.empty();) {
        const auto end = std::find(rest.begin(), rest.end(), restart);
        const Run run = rest.first(static_cast<size_t>(end - rest.begin()));
        if (strip)
            joinStrip(joined, run);
        else
            joinList(joined, run, corners);
        rest = rest.subspan(std::min(run.size() + 1, rest.size()));
    }
    return joined;
}

} // namespace touchstone
