// MetaImage: https://itk.org/Wiki/MetaIO/Documentation. World coordinates are (left, posterior, superior) in
// millimetres, as in ITK.

#include "engine/import/volume_file/flat_volume_format.h"
#include "engine/import/volume_reader/raw_volume.h"

#include <map>

namespace touchstone {

namespace {

const std::map<std::string, SampleType>& metaTypes() {
    using enum SampleType;
    static const std::map<std::string, SampleType> names = {
        {"met_uchar", U8},  {"met_char", I8},    {"met_ushort", U16},     {"met_short", I16},
        {"met_uint", U32},  {"met_int", I32},    {"met_ulong", U32},      {"met_long", I32},
        {"met_float", F32}, {"met_double", F64}, {"met_ulong_long", U64}, {"met_long_long", I64}};
    return names;
}

using MetaFields = std::map<std::string, std::string>;

/// Up to ElementDataFile, which is the last field.
MetaFields metaFields(std::string_view all, uint64_t& bytes) {
    std::string_view rest = all;
    MetaFields fields;
    while (!rest.empty() || all.size() == kMostVolumeHeader) {
        const std::string_view line = nextLine(rest, all);
        const size_t equals = line.find('=');
        if (equals == std::string_view::npos) {
            if (trimmed(line).empty())
                continue;
            throw BadVolume("its header has the line '" + std::string(line.substr(0, 60)) +
                            "', which is no field");
        }
        const std::string name = lowered(trimmed(line.substr(0, equals)));
        fields[name] = trimmed(line.substr(equals + 1));
        if (name == "elementdatafile")
            break;
    }
    bytes = all.size() - rest.size();
    return fields;
}

std::string text(const MetaFields& fields, std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (const auto found = fields.find(name); found != fields.end())
            return found->second;
    return {};
}

bool isTrue(const MetaFields& fields, std::initializer_list<const char*> names) {
    const std::string value = lowered(text(fields, names));
    return value == "true" || value == "1";
}

} // namespace

RawVolume readMetaHeader(std::span<const uint8_t> bytes) {
    RawVolume volume;
    const MetaFields fields = metaFields(headerText(bytes), volume.headerBytes);
    const std::string file = text(fields, {"elementdatafile"});
    if (file.empty())
        throw BadVolume("its header has no ElementDataFile");
    if (numbersIn(text(fields, {"ndims"}), "NDims", 1)[0] != 3.0)
        throw BadVolume("NDims is not 3");
    if (const std::string channels = text(fields, {"elementnumberofchannels"});
        !channels.empty() && numbersIn(channels, "ElementNumberOfChannels", 1)[0] != 1.0)
        throw BadVolume("it has several values a voxel (ElementNumberOfChannels)");
    const auto type = metaTypes().find(lowered(text(fields, {"elementtype"})));
    if (type == metaTypes().end())
        throw BadVolume("ElementType is '" + text(fields, {"elementtype"}).substr(0, 30) +
                        "', which is no number's");
    volume.type = type->second;
    const auto sizes = numbersIn(text(fields, {"dimsize"}), "DimSize", 3);
    for (size_t axis = 0; axis < 3; ++axis)
        volume.size[axis] = wholeNumber(sizes[axis], "DimSize");
    constexpr double kMillimetre = 1e-3;
    const glm::dmat3 sceneFrom = kMillimetre * sceneFromLps();
    const std::string spacing = text(fields, {"elementspacing", "elementsize"});
    if (spacing.empty())
        volume.notes |= kNoUnit;
    const auto step = spacing.empty() ? std::vector<double>(3, 1.0) : numbersIn(spacing, "ElementSpacing", 3);
    const std::string matrix = text(fields, {"transformmatrix", "rotation", "orientation"});
    const auto m = matrix.empty() ? std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1}
                                  : numbersIn(matrix, "TransformMatrix", 9);
    for (int axis = 0; axis < 3; ++axis) {
        const size_t row = 3 * static_cast<size_t>(axis);
        volume.axes[axis] =
            sceneFrom * (step[static_cast<size_t>(axis)] * glm::dvec3(m[row], m[row + 1], m[row + 2]));
    }
    if (const std::string offset = text(fields, {"offset", "position", "origin"}); !offset.empty()) {
        const auto at = numbersIn(offset, "Offset", 3);
        volume.origin = sceneFrom * glm::dvec3(at[0], at[1], at[2]);
    }
    const std::string binary = lowered(text(fields, {"binarydata"}));
    if (binary == "false")
        volume.encoding = VolumeEncoding::Text;
    else if (isTrue(fields, {"compresseddata"}))
        volume.encoding = VolumeEncoding::Deflated;
    volume.bigEndian = isTrue(fields, {"elementbyteordermsb", "binarydatabyteordermsb"});
    if (const std::string skip = text(fields, {"headersize"}); !skip.empty()) {
        const double size = numbersIn(skip, "HeaderSize", 1)[0];
        volume.atEnd = size == -1.0 && volume.encoding == VolumeEncoding::Raw;
        if (!volume.atEnd)
            volume.skipBytes = wholeNumber(size, "HeaderSize");
    }
    refuseSeveralFiles(file);
    if (lowered(file) != "local")
        volume.dataFile = file;
    return volume;
}

} // namespace touchstone
