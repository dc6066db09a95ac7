#include "engine/import/mesh_file/flat_meshes.h"

#include "engine/core/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace touchstone {

namespace {

/// Takes the answer apart from its front; every length is compared with what is left.
class FlatReader {
  public:
    FlatReader(std::span<const uint8_t> bytes, const std::string& shownAs)
        : rest_(bytes), shownAs_(shownAs) {}

    [[noreturn]] void fail(const std::string& problem) const {
        throw Error(shownAs_, "", "the reader of meshes gave a damaged answer: " + problem,
                    "re-export the model, or convert it to .glb");
    }

    uint32_t word() {
        uint32_t value = 0;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    /// The number of things that each take at least one word.
    uint32_t count(uint32_t most) {
        const uint32_t value = word();
        if (value > most || value > rest_.size() / sizeof(uint32_t))
            fail("a count of " + std::to_string(value));
        return value;
    }
    std::string name() {
        const uint32_t length = word();
        if (length > kMaxFlatNameBytes)
            fail("a name of " + std::to_string(length) + " bytes");
        const auto text = take((length + 3) / 4 * 4);
        return {text.begin(), text.begin() + length};
    }
    [[nodiscard]] std::span<const uint8_t> rest() const { return rest_; }

  private:
    std::span<const uint8_t> take(size_t bytes) {
        if (bytes > rest_.size())
            fail("it is cut off");
        const auto taken = rest_.first(bytes);
        rest_ = rest_.subspan(bytes);
        return taken;
    }

    std::span<const uint8_t> rest_;
    const std::string& shownAs_;
};

/// Hands out the arrays one after the other. Counts are 32 bit and their factors below 16, so no sum of one
/// mesh overflows; the size is compared after each.
class ArrayPlaces {
  public:
    ArrayPlaces(const FlatReader& reader, size_t size) : reader_(reader), size_(size) {}

    FlatRange next(uint32_t count, size_t numbers) {
        const FlatRange range{at_, size_t{count} * numbers * sizeof(uint32_t)};
        if (range.bytes > size_ - at_)
            reader_.fail("its arrays are cut off");
        at_ += range.bytes;
        return range;
    }
    [[nodiscard]] bool atEnd() const { return at_ == size_; }

  private:
    const FlatReader& reader_;
    size_t size_, at_ = 0;
};

/// Whether a check of each number of a range holds. The bytes need not be aligned for the numbers.
template <class Number, class Check>
bool allOf(std::span<const uint8_t> bytes, const Check& check) {
    constexpr size_t kBlock = 4096;
    std::array<Number, kBlock> block;
    for (size_t at = 0; at < bytes.size();) {
        const size_t count = std::min(kBlock, (bytes.size() - at) / sizeof(Number));
        std::memcpy(block.data(), bytes.data() + at, count * sizeof(Number));
        if (!std::all_of(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(count), check))
            return false;
        at += count * sizeof(Number);
    }
    return true;
}

/// A name of any bytes as text for people: what is no UTF-8 is replaced, control characters are escaped.
std::string shownName(const std::string& name) {
    return nlohmann::json(name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace

FlatMeshes readFlatMeshes(std::span<const uint8_t> bytes, const std::string& shownAs) {
    FlatReader reader(bytes, shownAs);
    FlatMeshes result;
    if (reader.word() != kFlatMagic)
        reader.fail("it begins with something else");
    const uint32_t materials = reader.count(kMaxFlatParts), meshes = reader.count(kMaxFlatParts);
    for (uint32_t i = 0; i < materials; ++i)
        result.materials.push_back(reader.name());
    for (uint32_t i = 0; i < meshes; ++i) {
        FlatMesh mesh;
        mesh.name = reader.name();
        mesh.counts.material = reader.word();
        mesh.counts.vertices = reader.word();
        mesh.counts.triangles = reader.word();
        mesh.counts.has = reader.word();
        if (mesh.counts.material >= materials || mesh.counts.has > kFlatAll || mesh.counts.vertices == 0 ||
            mesh.counts.triangles == 0)
            reader.fail("a mesh with impossible counts");
        result.meshes.push_back(std::move(mesh));
    }
    if (meshes == 0)
        reader.fail("it has no mesh");
    result.arrays = reader.rest();
    ArrayPlaces places(reader, result.arrays.size());
    for (FlatMesh& mesh : result.meshes) {
        const uint32_t vertices = mesh.counts.vertices;
        const auto optional = [&](FlatArray which, size_t numbers) {
            return (mesh.counts.has & which) != 0 ? std::optional(places.next(vertices, numbers))
                                                  : std::nullopt;
        };
        mesh.positions = places.next(vertices, 3);
        mesh.normals = optional(kFlatNormals, 3);
        mesh.textureCoordinates = optional(kFlatTextureCoordinates, 2);
        mesh.colors = optional(kFlatColors, 4);
        mesh.corners = places.next(mesh.counts.triangles, 3);
        const auto bytesOf = [&](const FlatRange& range) {
            return result.arrays.subspan(range.offset, range.bytes);
        };
        if (!allOf<float>(bytesOf(mesh.positions), [](float value) { return std::isfinite(value); }))
            throw Error(shownAs, mesh.name.empty() ? "" : "mesh " + shownName(mesh.name),
                        "has a vertex whose position is not a finite number",
                        "remove the broken vertex, or re-export the model");
        if (!allOf<uint32_t>(bytesOf(mesh.corners), [&](uint32_t corner) { return corner < vertices; }))
            reader.fail("a triangle with a vertex that does not exist");
    }
    if (!places.atEnd())
        reader.fail("it goes on after its end");
    return result;
}

} // namespace touchstone
