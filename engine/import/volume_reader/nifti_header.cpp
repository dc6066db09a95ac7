// NIfTI-1: https://nifti.nimh.nih.gov/pub/dist/src/niftilib/nifti1.h. World coordinates are (right, anterior,
// superior).

#include "engine/import/volume_file/flat_volume_format.h"
#include "engine/import/volume_reader/raw_volume.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace touchstone {

namespace {

constexpr size_t kHeader = 348;

class NiftiFields {
  public:
    NiftiFields(std::span<const uint8_t> bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}

    [[nodiscard]] int16_t word(size_t at) const { return static_cast<int16_t>(bits<uint16_t>(at)); }
    /// As it is; `real`: a finite one.
    [[nodiscard]] double any(size_t at) const {
        return static_cast<double>(std::bit_cast<float>(bits<uint32_t>(at)));
    }
    [[nodiscard]] double real(size_t at) const {
        const double value = any(at);
        if (!std::isfinite(value))
            throw BadVolume("its header has a number that is not finite");
        return value;
    }
    template <class Word>
    [[nodiscard]] Word bits(size_t at) const {
        Word value = 0;
        for (size_t i = 0; i < sizeof value; ++i)
            value = static_cast<Word>(value << 8 | bytes_[at + (swapped_ ? i : sizeof value - 1 - i)]);
        return value;
    }

  private:
    std::span<const uint8_t> bytes_;
    bool swapped_; ///< big-endian
};

SampleType typeOf(int code) {
    using enum SampleType;
    switch (code) {
    case 2:
        return U8;
    case 4:
        return I16;
    case 8:
        return I32;
    case 16:
        return F32;
    case 64:
        return F64;
    case 256:
        return I8;
    case 512:
        return U16;
    case 768:
        return U32;
    case 1024:
        return I64;
    case 1280:
        return U64;
    default:
        throw BadVolume("its values have the type " + std::to_string(code) + ", which is no single number's");
    }
}

/// Method 3 (sform) where it is given, else 2 (qform), else 1 (spacing alone).
void place(const NiftiFields& fields, RawVolume& volume) {
    constexpr size_t kPixdim = 76, kQform = 252, kSform = 254, kQuatern = 256, kOffset = 268, kRows = 280,
                     kUnits = 123;
    const int unit = fields.bits<uint8_t>(kUnits) & 7;
    const double metre = unit == 1 ? 1.0 : unit == 3 ? 1e-6 : 1e-3;
    if (unit == 0)
        volume.notes |= kNoUnit;
    const auto steps = [&] {
        return glm::dvec3(fields.real(kPixdim + 4), fields.real(kPixdim + 8), fields.real(kPixdim + 12));
    };
    glm::dmat3 axes(1.0);
    glm::dvec3 origin(0.0);
    if (fields.word(kSform) > 0) {
        for (int row = 0; row < 3; ++row) {
            const size_t at = kRows + 16 * static_cast<size_t>(row);
            for (int column = 0; column < 3; ++column)
                axes[column][row] = fields.real(at + 4 * static_cast<size_t>(column));
            origin[row] = fields.real(at + 12);
        }
    } else if (fields.word(kQform) > 0) {
        const double b = fields.real(kQuatern), c = fields.real(kQuatern + 4), d = fields.real(kQuatern + 8);
        const double a = std::sqrt(std::max(0.0, 1.0 - (b * b + c * c + d * d)));
        axes = {{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)},
                {2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)},
                {2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - c * c - b * b}};
        const glm::dvec3 step = steps();
        axes[0] *= step.x;
        axes[1] *= step.y;
        axes[2] *= fields.real(kPixdim) < 0.0 ? -step.z : step.z; // qfac
        origin = {fields.real(kOffset), fields.real(kOffset + 4), fields.real(kOffset + 8)};
    } else {
        volume.notes |= kNoOrientation;
        const glm::dvec3 step = steps();
        axes = {{step.x, 0, 0}, {0, step.y, 0}, {0, 0, step.z}};
    }
    const glm::dmat3 lpsFromRas({-1, 0, 0}, {0, -1, 0}, {0, 0, 1});
    const glm::dmat3 sceneFrom = metre * sceneFromLps() * lpsFromRas;
    volume.axes = sceneFrom * axes;
    volume.origin = sceneFrom * origin;
}

} // namespace

RawVolume readNiftiHeader(std::span<const uint8_t> header) {
    if (header.size() < kHeader)
        throw BadVolume("it is shorter than its header");
    const bool big = header[0] == 0;
    const NiftiFields fields(header, big);
    if (const auto size = fields.bits<uint32_t>(0); size != kHeader)
        throw BadVolume(size == 540 ? "it is NIfTI-2: convert it to NIfTI-1"
                                    : "its header has a size of " + std::to_string(size) + " instead of 348");
    const std::string_view magic(reinterpret_cast<const char*>(header.data()) + 344, 3);
    if (magic == "ni1")
        throw BadVolume("its values are in an .img beside it: convert it to one .nii");
    if (magic != "n+1")
        throw BadVolume("it does not have the mark of NIfTI-1");
    RawVolume volume;
    const int axes = fields.word(40);
    for (int axis = 4; axis <= std::min(axes, 7); ++axis)
        if (fields.word(40 + 2 * static_cast<size_t>(axis)) > 1)
            throw BadVolume("it has " + std::to_string(axes) +
                            " axes: a volume has three, and one value a voxel");
    if (axes < 3 || axes > 7)
        throw BadVolume("it has " + std::to_string(axes) + " axes instead of three");
    for (size_t axis = 0; axis < 3; ++axis)
        volume.size[axis] = static_cast<uint64_t>(std::max<int16_t>(0, fields.word(42 + 2 * axis)));
    volume.type = typeOf(fields.word(70));
    volume.bigEndian = big;
    volume.skipBytes = wholeNumber(fields.real(108), "vox_offset");
    if (volume.skipBytes < kHeader)
        throw BadVolume("its values begin inside of its header");
    // Writers state "none" by 0, and some by NaN.
    if (const double slope = fields.any(112); slope != 0.0 && !std::isnan(slope)) {
        volume.scale = fields.real(112);
        volume.offset = fields.real(116);
    }
    place(fields, volume);
    return volume;
}

} // namespace touchstone
