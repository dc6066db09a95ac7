#include "haptics/shape/field/field_cache.h"

#include "engine/core/cache_folder.h"
#include "engine/core/checksum.h"
#include "engine/core/error.h"
#include "engine/core/output_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

namespace touchstone {

namespace {

constexpr const char* kCachedEnding = ".field";
constexpr size_t kCachedBrick = FieldGrid::kBrickNodes * sizeof(float);

/// Of the machine that wrote it: a cache is not carried to another one.
struct CachedHeader {
    std::array<char, 8> magic{'T', 'S', 'F', 'I', 'E', 'L', 'D', '1'};
    uint64_t key = 0, seal = 0;
    double voxel = 0.0, inside = 0.0, outside = 0.0;
    std::array<double, 3> origin{};
    std::array<int32_t, 3> cells{};
    uint32_t unused = 0;
};
static_assert(std::is_trivially_copyable_v<CachedHeader> && sizeof(CachedHeader) == 88);

/// Calls visit(first cell) for every brick, the first axis fastest.
template <class Visit>
void eachBrick(const glm::ivec3& cells, const Visit& visit) {
    for (int z = 0; z < cells.z; z += FieldGrid::kBrick)
        for (int y = 0; y < cells.y; y += FieldGrid::kBrick)
            for (int x = 0; x < cells.x; x += FieldGrid::kBrick)
                visit(glm::ivec3(x, y, z));
}

/// What FieldGrid::hash leaves out, too.
uint64_t sealOf(const FieldGrid& grid) {
    Hash64 hash;
    hash.add(grid.hash());
    hash.add(grid.inside());
    hash.add(grid.outside());
    return hash.value();
}

uint64_t bytesOf(const FieldGrid& grid) {
    uint64_t bytes = sizeof(CachedHeader);
    eachBrick(grid.layout().cells, [&](const glm::ivec3& first) {
        const float flat = grid.flatBrick(first);
        bytes += sizeof flat + (flat == flat ? 0 : kCachedBrick);
    });
    return bytes;
}

template <class Value>
std::string_view bytesAt(const Value* first, size_t count) {
    return {reinterpret_cast<const char*>(first), count * sizeof(Value)};
}

std::string contentsOf(const std::filesystem::path& file, uint64_t mostBytes) {
    std::error_code error;
    const uintmax_t size = std::filesystem::file_size(file, error);
    if (error || !std::filesystem::is_regular_file(file, error) || size > mostBytes)
        return {};
    std::string text(size, '\0');
    std::ifstream stream(file, std::ios::binary);
    if (!stream.read(text.data(), static_cast<std::streamsize>(size)))
        return {};
    return text;
}

/// Null where the bytes are not those of `keep`.
std::shared_ptr<const FieldGrid> gridFrom(std::string_view text, uint64_t key) {
    CachedHeader header;
    const CachedHeader expected;
    if (text.size() < sizeof header)
        return nullptr;
    std::memcpy(&header, text.data(), sizeof header);
    if (header.magic != expected.magic || header.key != key)
        return nullptr;
    const FieldLayout layout{{header.origin[0], header.origin[1], header.origin[2]},
                             header.voxel,
                             {header.cells[0], header.cells[1], header.cells[2]}};
    if (std::min({layout.cells.x, layout.cells.y, layout.cells.z}) < 1)
        return nullptr;
    uint64_t bricks = 1; // each takes four bytes at least: no table larger than the file
    for (int axis = 0; axis < 3; ++axis)
        bricks *= static_cast<uint64_t>(layout.cells[axis]) / FieldGrid::kBrick + 1;
    if (glm::any(glm::greaterThan(layout.cells, glm::ivec3(FieldGrid::kMostOnAxis))) || bricks > text.size())
        return nullptr;
    size_t at = sizeof header;
    try { // the grid's own checks
        auto grid = std::make_shared<const FieldGrid>(
            layout, header.inside, header.outside, [&](const glm::ivec3&, std::span<float> nodes) {
                float flat = 0.0f;
                if (text.size() - at < sizeof flat)
                    throw Error("cached field", "", "ends too early", "");
                std::memcpy(&flat, text.data() + at, sizeof flat);
                at += sizeof flat;
                if (flat == flat) {
                    std::ranges::fill(nodes, flat);
                    return;
                }
                if (text.size() - at < kCachedBrick)
                    throw Error("cached field", "", "ends too early", "");
                std::memcpy(nodes.data(), text.data() + at, kCachedBrick);
                at += kCachedBrick;
            });
        return at == text.size() && sealOf(*grid) == header.seal ? grid : nullptr;
    } catch (const Error&) {
        return nullptr;
    }
}

} // namespace

FieldCache FieldCache::usual() {
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return std::string(value != nullptr ? value : "");
    };
    std::filesystem::path cache;
    if (const std::filesystem::path asked = variable("XDG_CACHE_HOME"); asked.is_absolute())
        cache = asked;
    else if (const std::filesystem::path home = variable("HOME"); home.is_absolute())
        cache = home / ".cache";
    else
        return {{}, 0};
    uint64_t bytes = kUsualBytes;
    const std::string text = variable("TOUCHSTONE_FIELD_CACHE_MB");
    if (uint64_t millions = 0;
        std::from_chars(text.data(), text.data() + text.size(), millions).ec == std::errc{} &&
        millions <= 1'000'000)
        bytes = 1'000'000 * millions;
    return {cache / "touchstone" / "fields", bytes};
}

std::filesystem::path FieldCache::fileOf(uint64_t key) const {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "%016llx%s", static_cast<unsigned long long>(key), kCachedEnding);
    return folder_ / name.data();
}

std::shared_ptr<const FieldGrid> FieldCache::find(uint64_t key) const {
    if (mostBytes_ == 0)
        return nullptr;
    const std::filesystem::path file = fileOf(key);
    std::error_code error;
    if (!std::filesystem::exists(file, error))
        return nullptr;
    auto grid = gridFrom(contentsOf(file, mostBytes_), key);
    if (grid == nullptr)
        std::filesystem::remove(file, error);
    else // the newest one
        std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now(), error);
    return grid;
}

bool FieldCache::makeRoom(uint64_t bytes) const {
    if (bytes > mostBytes_ / 4)
        return false;
    const auto kept = cachedFiles(folder_, kCachedEnding);
    if (!kept)
        return false;
    uint64_t all = bytes;
    for (const CachedFile& one : *kept)
        all += one.bytes;
    std::error_code error;
    for (size_t i = 0; i < kept->size() && all > mostBytes_; ++i) {
        if (std::filesystem::remove((*kept)[i].file, error); !error)
            all -= (*kept)[i].bytes;
    }
    return true;
}

void FieldCache::keep(uint64_t key, const FieldGrid& grid) const {
    if (mostBytes_ == 0 || !makeRoom(bytesOf(grid)))
        return;
    CachedHeader header;
    const FieldLayout& layout = grid.layout();
    header.key = key;
    header.seal = sealOf(grid);
    header.voxel = layout.voxel;
    header.inside = grid.inside();
    header.outside = grid.outside();
    for (int axis = 0; axis < 3; ++axis) {
        header.origin[static_cast<size_t>(axis)] = layout.origin[axis];
        header.cells[static_cast<size_t>(axis)] = layout.cells[axis];
    }
    try {
        OutputFile file(fileOf(key));
        file.write(bytesAt(&header, 1));
        std::array<float, FieldGrid::kBrickNodes> nodes{};
        eachBrick(layout.cells, [&](const glm::ivec3& first) {
            const float flat = grid.flatBrick(first);
            file.write(bytesAt(&flat, 1));
            if (flat == flat)
                return;
            grid.copyBrick(first / FieldGrid::kBrick, nodes);
            file.write(bytesAt(nodes.data(), nodes.size()));
        });
        file.commit();
    } catch (const Error&) { // a full disk, a folder that belongs to somebody else
    }
}

} // namespace touchstone
