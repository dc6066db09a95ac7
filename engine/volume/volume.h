#pragma once
// Scalar data on a grid of voxels: a scan. Immutable; any thread.

#include "engine/core/checksum.h"
#include "engine/core/progress.h"
#include "engine/math/similarity.h"
#include "engine/volume/volume_type.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// What a file states of its volume.
struct VolumeFacts {
    glm::ivec3 size{0}; ///< voxels along each axis, at least 2
    VolumeType type = VolumeType::UInt8;
    glm::dmat3 axes{1.0}; ///< columns: m, scene frame, from a voxel to the next along each axis; right-handed
    glm::dvec3 origin{0.0};           ///< m, scene frame: centre of voxel (0, 0, 0)
    double scale = 1.0, offset = 0.0; ///< a value is scale * stored + offset
    std::optional<double> statedIso;  ///< of a level set: where its surface is
    std::string format, fileType;     ///< "NRRD", "int16"
    FileStamp file;                   ///< of the file that was opened
    std::vector<std::string> notes;   ///< what the file leaves open, for warnings
};

/// Values in blocks of 8^3 voxels and their neighbours.
struct ValueRange {
    float low = 0.0f, high = 0.0f;
};

class Volume {
  public:
    static constexpr int kBlock = 8;  ///< voxels a side
    static constexpr int kBins = 256; ///< of the histogram
    using Histogram = std::array<uint64_t, kBins>;

    /// `stored`: the values as facts.type, the first axis fastest, at least as many as there are voxels; kept
    /// alive by `owner`. Throws Error, naming `shownAs`, where a value is not a finite number, where all are
    /// equal, and where floats cannot divide their range: wider than the largest, or some of its last bits.
    /// Throws Cancelled; reports nothing.
    Volume(VolumeFacts facts, std::span<const uint8_t> stored, std::shared_ptr<const void> owner,
           const std::string& shownAs, const Progress& progress = {});

    [[nodiscard]] const VolumeFacts& facts() const noexcept { return facts_; }
    [[nodiscard]] const glm::ivec3& size() const noexcept { return facts_.size; }
    [[nodiscard]] uint64_t voxels() const noexcept {
        return uint64_t(facts_.size.x) * uint64_t(facts_.size.y) * uint64_t(facts_.size.z);
    }
    [[nodiscard]] uint64_t memoryBytes() const noexcept {
        return stored_.size() + ranges_.capacity() * sizeof(ValueRange);
    }
    /// Lowest and highest value.
    [[nodiscard]] double low() const noexcept { return low_; }
    [[nodiscard]] double high() const noexcept { return high_; }
    /// Voxels by value, in equal steps from low to high.
    [[nodiscard]] const Histogram& histogram() const noexcept { return histogram_; }
    /// What the file states, else Otsu's threshold: of all that divide the histogram in two classes the one
    /// with the largest variance between them (N. Otsu, 1979).
    [[nodiscard]] double defaultIso() const noexcept { return defaultIso_; }
    /// Throws Error where no surface has this value: it lies above every voxel's or at the lowest one's.
    void checkIso(double iso, const std::string& shownAs) const;

    /// The values of the voxels of a row from `first` on, which has as many.
    void row(const glm::ivec3& first, std::span<float> values) const noexcept;
    /// The range of a block's values, and of the voxels one beyond it on the high sides.
    [[nodiscard]] const ValueRange& range(const glm::ivec3& block) const noexcept {
        return ranges_[indexOf(block)];
    }
    [[nodiscard]] const glm::ivec3& blocks() const noexcept { return blocks_; }
    /// m, scene frame, of voxel coordinates.
    [[nodiscard]] glm::dvec3 scenePoint(const glm::dvec3& voxel) const noexcept {
        return facts_.origin + facts_.axes * voxel;
    }
    /// Around the centres of all voxels, scene frame.
    [[nodiscard]] Bounds bounds() const;

  private:
    [[nodiscard]] size_t indexOf(const glm::ivec3& block) const noexcept {
        return static_cast<size_t>(block.x) +
               static_cast<size_t>(blocks_.x) *
                   (static_cast<size_t>(block.y) +
                    static_cast<size_t>(blocks_.y) * static_cast<size_t>(block.z));
    }
    void measure(const std::string& shownAs, const Progress& progress);
    void count(const Progress& progress);

    VolumeFacts facts_;
    std::span<const uint8_t> stored_;
    std::shared_ptr<const void> owner_;
    double low_ = 0.0, high_ = 0.0, defaultIso_ = 0.0;
    Histogram histogram_{};
    glm::ivec3 blocks_{0};
    std::vector<ValueRange> ranges_;
};

/// The largest float below `iso`. A voxel is inside of the surface at `iso` where its value is at least that,
/// so where it is above this one: the surface of zero of highestOutside(iso) - value divides the voxels in
/// the same way for the eye and for the hand, also where many have the value itself, as in a mask.
[[nodiscard]] float highestOutside(double iso);

/// Otsu's threshold of a histogram whose bins divide low..high: a border between two bins.
[[nodiscard]] double otsuThreshold(const Volume::Histogram& histogram, double low, double high);

} // namespace touchstone
