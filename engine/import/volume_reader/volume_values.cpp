#include "engine/import/volume_reader/volume_values.h"

#include "engine/import/reader_child/standard_streams.h"
#include "engine/import/volume_file/flat_volume_format.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>

namespace touchstone {

namespace {

VolumeType flatTypeOf(SampleType type) {
    switch (type) {
    case SampleType::U8:
        return VolumeType::UInt8;
    case SampleType::I8:
        return VolumeType::Int8;
    case SampleType::U16:
        return VolumeType::UInt16;
    case SampleType::I16:
        return VolumeType::Int16;
    default:
        return VolumeType::Float;
    }
}

std::string withUnit(double bytes) {
    char text[32];
    std::snprintf(text, sizeof text, bytes >= 1e9 ? "%.1f GB" : "%.1f MB",
                  bytes >= 1e9 ? bytes / 1e9 : bytes / 1e6);
    return text;
}

/// Gives bytes one after the other.
class ByteSource {
  public:
    virtual ~ByteSource() = default;
    /// Throws BadVolume where there are fewer.
    virtual void take(std::span<uint8_t> bytes) = 0;
};

[[noreturn]] void cutOff(const std::string& how) {
    throw BadVolume("it is cut off: " + how);
}

class RawSource final : public ByteSource {
  public:
    explicit RawSource(std::span<const uint8_t> rest) : rest_(rest) {}
    void take(std::span<uint8_t> bytes) override {
        if (bytes.size() > rest_.size())
            cutOff("it ends before its last value");
        std::memcpy(bytes.data(), rest_.data(), bytes.size());
        rest_ = rest_.subspan(bytes.size());
    }

  private:
    std::span<const uint8_t> rest_;
};

/// gzip and zlib streams.
class InflatingSource final : public ByteSource {
  public:
    explicit InflatingSource(std::span<const uint8_t> deflated) : rest_(deflated) {
        constexpr int kEither = 32 + MAX_WBITS;
        if (inflateInit2(&stream_, kEither) != Z_OK)
            throw std::bad_alloc();
    }
    ~InflatingSource() override { inflateEnd(&stream_); }
    InflatingSource(const InflatingSource&) = delete;
    InflatingSource& operator=(const InflatingSource&) = delete;

    void take(std::span<uint8_t> bytes) override {
        if (const size_t got = takeSome(bytes); got < bytes.size())
            cutOff("what it inflates to ends before its last value");
    }
    size_t takeSome(std::span<uint8_t> bytes) {
        size_t got = 0;
        while (got < bytes.size()) {
            constexpr size_t kMost = size_t{1} << 30; // zlib counts in 32 bits
            const size_t in = std::min(rest_.size(), kMost), out = std::min(bytes.size() - got, kMost);
            stream_.next_in = const_cast<uint8_t*>(rest_.data()); // zlib does not write to it
            stream_.avail_in = static_cast<uInt>(in);
            stream_.next_out = bytes.data() + got;
            stream_.avail_out = static_cast<uInt>(out);
            const int state = inflate(&stream_, Z_NO_FLUSH);
            rest_ = rest_.subspan(in - stream_.avail_in);
            got += out - stream_.avail_out;
            if (state == Z_STREAM_END) {
                if (rest_.empty() || inflateReset(&stream_) != Z_OK) // another member may follow
                    return got;
            } else if (state != Z_OK) {
                if (state == Z_BUF_ERROR && rest_.empty())
                    return got;
                throw BadVolume("its compressed values are damaged");
            }
        }
        return got;
    }

  private:
    std::span<const uint8_t> rest_;
    z_stream stream_{};
};

/// Numbers in decimal digits, as the bytes of doubles.
class TextSource final : public ByteSource {
  public:
    explicit TextSource(std::span<const uint8_t> text)
        : rest_(reinterpret_cast<const char*>(text.data()), text.size()) {}
    void take(std::span<uint8_t> bytes) override {
        for (size_t at = 0; at < bytes.size(); at += sizeof(double)) {
            rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n,"), rest_.size()));
            double value = 0.0;
            const auto [next, problem] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
            if (rest_.empty())
                cutOff("it ends before its last value");
            if (problem != std::errc())
                throw BadVolume("its values have '" + std::string(rest_.substr(0, 20)) +
                                "', which is no number");
            rest_.remove_prefix(static_cast<size_t>(next - rest_.data()));
            std::memcpy(bytes.data() + at, &value, sizeof value);
        }
    }

  private:
    std::string_view rest_;
};

template <class From, class To>
void convert(const uint8_t* from, uint8_t* to, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        From value;
        std::memcpy(&value, from + i * sizeof value, sizeof value);
        const auto other = static_cast<To>(value);
        std::memcpy(to + i * sizeof other, &other, sizeof other);
    }
}

/// Text: doubles that must be values of the type.
template <class To>
void convertText(const uint8_t* from, uint8_t* to, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        double value = 0.0;
        std::memcpy(&value, from + i * sizeof value, sizeof value);
        if constexpr (!std::is_floating_point_v<To>) {
            if (!(value >= static_cast<double>(std::numeric_limits<To>::lowest())) ||
                !(value <= static_cast<double>(std::numeric_limits<To>::max())))
                throw BadVolume("it has a value that its type cannot hold");
        }
        const auto other = static_cast<To>(value);
        std::memcpy(to + i * sizeof other, &other, sizeof other);
    }
}

void swapBytes(std::span<uint8_t> bytes, size_t each) {
    for (size_t at = 0; at + each <= bytes.size(); at += each)
        std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                     bytes.begin() + static_cast<std::ptrdiff_t>(at + each));
}

/// From the file's type to the answer's.
void toFlat(SampleType type, const uint8_t* from, uint8_t* to, size_t count) {
    switch (type) {
    case SampleType::U32:
        return convert<uint32_t, float>(from, to, count);
    case SampleType::I32:
        return convert<int32_t, float>(from, to, count);
    case SampleType::U64:
        return convert<uint64_t, float>(from, to, count);
    case SampleType::I64:
        return convert<int64_t, float>(from, to, count);
    case SampleType::F64:
        return convert<double, float>(from, to, count);
    default:
        std::memcpy(to, from, count * bytesOf(type));
    }
}

void textToFlat(VolumeType type, const uint8_t* from, uint8_t* to, size_t count) {
    switch (type) {
    case VolumeType::UInt8:
        return convertText<uint8_t>(from, to, count);
    case VolumeType::Int8:
        return convertText<int8_t>(from, to, count);
    case VolumeType::UInt16:
        return convertText<uint16_t>(from, to, count);
    case VolumeType::Int16:
        return convertText<int16_t>(from, to, count);
    case VolumeType::Float:
        return convertText<float>(from, to, count);
    }
}

std::span<const uint8_t> skipped(const RawVolume& volume, std::span<const uint8_t> data, uint64_t needed) {
    for (uint64_t line = 0; line < volume.skipLines; ++line) {
        const auto end = std::find(data.begin(), data.end(), uint8_t{'\n'});
        if (end == data.end())
            cutOff("it has fewer lines than are to be skipped");
        data = data.subspan(static_cast<size_t>(end - data.begin()) + 1);
    }
    if (volume.encoding != VolumeEncoding::Raw)
        return data;
    if (volume.atEnd)
        return data.subspan(data.size() - std::min<uint64_t>(data.size(), needed));
    if (volume.skipBytes > data.size() || data.size() - volume.skipBytes < needed)
        cutOff("its header asks for " + std::to_string(needed) + " bytes of values, and there are " +
               std::to_string(data.size() - std::min<uint64_t>(data.size(), volume.skipBytes)));
    return data.subspan(volume.skipBytes);
}

/// Reverses the first axis where the three are left-handed.
bool makeRightHanded(RawVolume& volume) {
    if (glm::determinant(volume.axes) >= 0.0)
        return false;
    volume.origin += static_cast<double>(volume.size[0] - 1) * volume.axes[0];
    volume.axes[0] = -volume.axes[0];
    return true;
}

FlatVolumeHead headOf(const RawVolume& volume) {
    FlatVolumeHead head;
    head.type = static_cast<uint32_t>(flatTypeOf(volume.type));
    head.notes = volume.notes;
    head.scale = volume.scale;
    head.offset = volume.offset;
    head.iso = std::nan("");
    for (int axis = 0; axis < 3; ++axis) {
        head.size[axis] = static_cast<uint32_t>(volume.size[static_cast<size_t>(axis)]);
        head.origin[axis] = volume.origin[axis];
        for (int part = 0; part < 3; ++part)
            head.axes[axis][part] = volume.axes[axis][part];
    }
    std::strncpy(head.fileType, nameOf(volume.type), sizeof head.fileType - 1);
    return head;
}

} // namespace

void checkVolumeSize(const RawVolume& volume, uint64_t most) {
    double voxels = 1.0;
    std::string sizes;
    for (const uint64_t size : volume.size) {
        sizes += (sizes.empty() ? "" : " x ") + std::to_string(size);
        voxels *= static_cast<double>(size);
    }
    for (const uint64_t size : volume.size)
        if (size < 2)
            throw BadVolume("it has " + sizes + " voxels: a volume has at least two on each axis");
    const double bytes = voxels * bytesOf(flatTypeOf(volume.type));
    const uint64_t longest = *std::ranges::max_element(volume.size);
    if (bytes <= static_cast<double>(most) && longest <= kMostVolumeAxis)
        return;
    const double factor = std::max(std::cbrt(bytes / static_cast<double>(most)),
                                   static_cast<double>(longest) / kMostVolumeAxis);
    char times[16];
    std::snprintf(times, sizeof times, "%.1f", std::ceil(10.0 * factor) / 10.0);
    throw BadVolume("its header asks for " + withUnit(bytes) + " of values (" + sizes + " voxels, " +
                    nameOf(volume.type) + "), and " + withUnit(static_cast<double>(most)) +
                    " fit: crop it, or resample it with voxels " + times + " times as large");
}

void writeVolume(RawVolume volume, std::span<const uint8_t> data) {
    const bool reversed = makeRightHanded(volume);
    const FlatVolumeHead head = headOf(volume);
    const auto flat = static_cast<VolumeType>(head.type);
    const bool text = volume.encoding == VolumeEncoding::Text;
    const size_t each = text ? sizeof(double) : bytesOf(volume.type), flatEach = bytesOf(flat);
    const size_t row = volume.size[0], rows = volume.size[1] * volume.size[2];
    data = skipped(volume, data, uint64_t{each} * row * rows);
    std::unique_ptr<ByteSource> source;
    if (text) {
        source = std::make_unique<TextSource>(data);
    } else if (volume.encoding == VolumeEncoding::Deflated) {
        auto inflating = std::make_unique<InflatingSource>(data);
        std::vector<uint8_t> before(std::min<uint64_t>(volume.skipBytes, uint64_t{1} << 20));
        for (uint64_t at = 0; at < volume.skipBytes; at += before.size())
            inflating->take(
                std::span(before).first(std::min<uint64_t>(before.size(), volume.skipBytes - at)));
        source = std::move(inflating);
    } else {
        source = std::make_unique<RawSource>(data);
    }
    writeOutput(&head, sizeof head);
    // Whole rows, some at a time.
    const size_t together = std::max<size_t>(1, (size_t{1} << 18) / (row * each));
    std::vector<uint8_t> in(together * row * each), out(together * row * flatEach);
    for (size_t at = 0; at < rows; at += together) {
        const size_t count = std::min(together, rows - at) * row;
        const std::span<uint8_t> taken = std::span(in).first(count * each);
        source->take(taken);
        if (volume.bigEndian != (std::endian::native == std::endian::big) && !text)
            swapBytes(taken, each);
        if (text)
            textToFlat(flat, in.data(), out.data(), count);
        else
            toFlat(volume.type, in.data(), out.data(), count);
        if (reversed)
            for (size_t first = 0; first < count; first += row) {
                const std::span<uint8_t> one = std::span(out).subspan(first * flatEach, row * flatEach);
                std::ranges::reverse(one);
                swapBytes(one, flatEach);
            }
        writeOutput(out.data(), count * flatEach);
    }
}

std::vector<uint8_t> inflatedStart(std::span<const uint8_t> deflated, size_t most) {
    std::vector<uint8_t> start(most);
    start.resize(InflatingSource(deflated).takeSome(start));
    return start;
}

} // namespace touchstone
