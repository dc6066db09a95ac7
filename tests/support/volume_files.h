#pragma once
// Volumes of touchstone_assets as files of every format.

#include "assets/volumes.h"

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchstone::test {

using VolumeBytes = std::vector<uint8_t>;

inline VolumeBytes bytesOfText(const std::string& text) {
    return {text.begin(), text.end()};
}

inline void append(VolumeBytes& bytes, const std::vector<std::byte>& more) {
    const auto* const first = reinterpret_cast<const uint8_t*>(more.data());
    bytes.insert(bytes.end(), first, first + more.size());
}

inline VolumeBytes gzipped(const VolumeBytes& bytes) {
    z_stream stream{};
    if (deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::runtime_error("zlib");
    VolumeBytes out(deflateBound(&stream, bytes.size()) + 64);
    stream.next_in = const_cast<uint8_t*>(bytes.data());
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = out.data();
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

/// (left, posterior, superior), mm: centre of the first voxel.
inline glm::dvec3 firstVoxel(const assets::VolumeData& volume) {
    return -0.5 * volume.spacing * glm::dvec3(volume.voxels - 1);
}

inline std::string threeNumbers(const glm::dvec3& v) {
    char text[96];
    std::snprintf(text, sizeof text, "%.17g %.17g %.17g", v.x, v.y, v.z);
    return text;
}

inline VolumeBytes nrrdFile(const assets::VolumeData& volume) {
    VolumeBytes bytes;
    append(bytes, assets::nrrdOf(volume));
    return bytes;
}

/// `dataFile`: LOCAL, or the name of a file beside it.
inline VolumeBytes metaFile(const assets::VolumeData& volume, const std::string& dataFile = "LOCAL",
                            bool big = false) {
    const std::string type = volume.type == "uint8"   ? "MET_UCHAR"
                             : volume.type == "int16" ? "MET_SHORT"
                                                      : "MET_FLOAT";
    VolumeBytes bytes = bytesOfText(
        "ObjectType = Image\nNDims = 3\nDimSize = " + threeNumbers(glm::dvec3(volume.voxels)) +
        "\nElementSpacing = " + threeNumbers(volume.spacing) +
        "\nOffset = " + threeNumbers(firstVoxel(volume)) +
        "\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nElementByteOrderMSB = " + (big ? "True" : "False") +
        "\nElementType = " + type + "\nElementDataFile = " + dataFile + "\n");
    if (dataFile == "LOCAL")
        append(bytes, assets::valuesOf(volume, big));
    return bytes;
}

enum class NiftiPlace { Sform, Qform };

/// In right, anterior, superior coordinates: the first two axes turned round by the matrix or the quaternion.
inline VolumeBytes niftiFile(const assets::VolumeData& volume, NiftiPlace place = NiftiPlace::Sform,
                             bool big = false) {
    VolumeBytes bytes(352);
    const auto put = [&](size_t at, auto value) {
        std::array<uint8_t, sizeof value> raw{};
        std::memcpy(raw.data(), &value, sizeof value);
        for (size_t i = 0; i < raw.size(); ++i)
            bytes[at + i] = raw[big ? raw.size() - 1 - i : i];
    };
    put(0, int32_t{348});
    put(40, int16_t{3});
    for (int axis = 0; axis < 3; ++axis) {
        put(42 + 2 * static_cast<size_t>(axis), static_cast<int16_t>(volume.voxels[axis]));
        put(80 + 4 * static_cast<size_t>(axis), static_cast<float>(volume.spacing[axis]));
    }
    for (size_t axis = 3; axis < 7; ++axis)
        put(42 + 2 * axis, int16_t{1});
    put(76, 1.0f);
    put(70, static_cast<int16_t>(volume.type == "uint8" ? 2 : volume.type == "int16" ? 4 : 16));
    put(108, 352.0f);
    bytes[123] = 2; // mm
    const glm::dvec3 first = firstVoxel(volume) * glm::dvec3(-1, -1, 1);
    if (place == NiftiPlace::Sform) {
        put(254, int16_t{1});
        for (int row = 0; row < 3; ++row) {
            const size_t at = 280 + 16 * static_cast<size_t>(row);
            put(at + 4 * static_cast<size_t>(row),
                static_cast<float>((row < 2 ? -1.0 : 1.0) * volume.spacing[row]));
            put(at + 12, static_cast<float>(first[row]));
        }
    } else { // half a turn about z: a = 0, d = 1
        put(252, int16_t{1});
        put(264, 1.0f);
        for (int axis = 0; axis < 3; ++axis)
            put(268 + 4 * static_cast<size_t>(axis), static_cast<float>(first[axis]));
    }
    std::memcpy(bytes.data() + 344, "n+1", 4);
    append(bytes, assets::valuesOf(volume, big));
    return bytes;
}

} // namespace touchstone::test
