#pragma once
// What the header of a volume states.

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

/// Ends the reading; the text is shown to the user after "cannot be read as ...: ".
struct BadVolume : std::runtime_error {
    using std::runtime_error::runtime_error;
};

enum class SampleType : uint8_t { U8, I8, U16, I16, U32, I32, U64, I64, F32, F64 };
[[nodiscard]] uint32_t bytesOf(SampleType type);
[[nodiscard]] const char* nameOf(SampleType type);

enum class VolumeEncoding : uint8_t { Raw, Deflated, Text };

struct RawVolume {
    std::array<uint64_t, 3> size{};
    SampleType type = SampleType::U8;
    bool bigEndian = false;
    VolumeEncoding encoding = VolumeEncoding::Raw;
    /// Before the values, in the data: lines, then bytes (of the inflated data, as NRRD has it); `atEnd`: raw
    /// values end with the data.
    uint64_t skipLines = 0, skipBytes = 0;
    bool atEnd = false;
    double scale = 1.0, offset = 0.0;
    glm::dmat3 axes{1.0};   ///< columns; m, scene frame
    glm::dvec3 origin{0.0}; ///< m, scene frame
    uint32_t notes = 0;     ///< FlatVolumeNotes
    std::string dataFile;   ///< elsewhere; empty: the data follow the header
    uint64_t headerBytes = 0;
};

/// The directions of the patient to the scene's axes: left is +x, superior +y, anterior +z, so that a head
/// stands upright and faces the viewer, as glTF has its models. From coordinates (left, posterior, superior).
[[nodiscard]] inline glm::dmat3 sceneFromLps() {
    return {{1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}};
}

/// Each throws BadVolume. `bytes` starts with the header.
[[nodiscard]] RawVolume readNrrdHeader(std::span<const uint8_t> bytes);
[[nodiscard]] RawVolume readMetaHeader(std::span<const uint8_t> bytes);
/// `header`: at least the first 348 bytes, inflated.
[[nodiscard]] RawVolume readNiftiHeader(std::span<const uint8_t> header);

/// Lines of a header, for the two formats of text.
[[nodiscard]] std::string_view trimmed(std::string_view text);
[[nodiscard]] std::string lowered(std::string_view text);
/// Numbers separated by blanks, commas and brackets. Throws BadVolume naming `field` where one is no finite
/// number, and where there are not `count` of them (0: any number).
[[nodiscard]] std::vector<double> numbersIn(std::string_view text, const char* field, size_t count = 0);
/// The text that a header can be in: the first kMostVolumeHeader bytes.
[[nodiscard]] std::string_view headerText(std::span<const uint8_t> bytes);
/// The next line of `all`, and what is left of it. Throws BadVolume where headerText has cut it off.
[[nodiscard]] std::string_view nextLine(std::string_view& rest, std::string_view all);
/// Throws BadVolume where the name of a data file stands for several: LIST, or slice%03d.raw.
void refuseSeveralFiles(std::string_view name);
/// A whole number in 0..2^53 out of `value`.
[[nodiscard]] uint64_t wholeNumber(double value, const char* field);

} // namespace touchstone
