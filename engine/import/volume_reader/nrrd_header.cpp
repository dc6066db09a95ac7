// NRRD: http://teem.sourceforge.net/nrrd/format.html

#include "engine/import/volume_file/flat_volume_format.h"
#include "engine/import/volume_reader/raw_volume.h"

#include <cmath>
#include <map>
#include <optional>

namespace touchstone {

namespace {

const std::map<std::string, SampleType>& nrrdTypes() {
    using enum SampleType;
    static const std::map<std::string, SampleType> names = {{"uchar", U8},
                                                            {"unsigned char", U8},
                                                            {"uint8", U8},
                                                            {"uint8_t", U8},
                                                            {"signed char", I8},
                                                            {"int8", I8},
                                                            {"int8_t", I8},
                                                            {"short", I16},
                                                            {"short int", I16},
                                                            {"signed short", I16},
                                                            {"signed short int", I16},
                                                            {"int16", I16},
                                                            {"int16_t", I16},
                                                            {"ushort", U16},
                                                            {"unsigned short", U16},
                                                            {"unsigned short int", U16},
                                                            {"uint16", U16},
                                                            {"uint16_t", U16},
                                                            {"int", I32},
                                                            {"signed int", I32},
                                                            {"int32", I32},
                                                            {"int32_t", I32},
                                                            {"uint", U32},
                                                            {"unsigned int", U32},
                                                            {"uint32", U32},
                                                            {"uint32_t", U32},
                                                            {"longlong", I64},
                                                            {"long long", I64},
                                                            {"long long int", I64},
                                                            {"signed long long", I64},
                                                            {"signed long long int", I64},
                                                            {"int64", I64},
                                                            {"int64_t", I64},
                                                            {"ulonglong", U64},
                                                            {"unsigned long long", U64},
                                                            {"unsigned long long int", U64},
                                                            {"uint64", U64},
                                                            {"uint64_t", U64},
                                                            {"float", F32},
                                                            {"double", F64}};
    return names;
}

/// Metres of a unit of length; none for another word.
std::optional<double> metres(std::string_view unit) {
    const std::string name = lowered(unit);
    if (name == "m" || name == "meter" || name == "metre")
        return 1.0;
    if (name == "cm")
        return 1e-2;
    if (name == "mm" || name == "millimeter" || name == "millimetre")
        return 1e-3;
    if (name == "um" || name == "micron" || name == "\xc2\xb5m" || name == "micrometer")
        return 1e-6;
    if (name == "nm")
        return 1e-9;
    return std::nullopt;
}

using NrrdFields = std::map<std::string, std::string>;

/// Up to the empty line, or the end of a detached header.
NrrdFields nrrdFields(std::string_view all, uint64_t& bytes) {
    std::string_view rest = all;
    if (!all.starts_with("NRRD000"))
        throw BadVolume("it does not begin with NRRD000");
    (void)nextLine(rest, all);
    NrrdFields fields;
    while (!rest.empty() || all.size() == kMostVolumeHeader) {
        const std::string_view line = nextLine(rest, all);
        if (line.empty())
            break;
        if (line.front() == '#' || line.find(":=") != std::string_view::npos)
            continue;
        const size_t colon = line.find(": ");
        if (colon == std::string_view::npos)
            throw BadVolume("its header has the line '" + std::string(line.substr(0, 60)) +
                            "', which is no field");
        fields[lowered(trimmed(line.substr(0, colon)))] = trimmed(line.substr(colon + 2));
    }
    bytes = all.size() - rest.size();
    return fields;
}

std::string text(const NrrdFields& fields, const char* name, const char* otherName = nullptr) {
    const auto found = fields.find(name);
    if (found != fields.end())
        return found->second;
    return otherName != nullptr ? text(fields, otherName) : std::string();
}

/// The vectors of "space directions": (x,y,z) for each axis of space, "none" for others.
std::vector<glm::dvec3> directions(std::string_view line) {
    std::vector<glm::dvec3> found;
    while (!(line = trimmed(line)).empty()) {
        if (line.starts_with("none")) {
            line.remove_prefix(4);
            continue;
        }
        const size_t end = line.find(')');
        if (line.front() != '(' || end == std::string_view::npos || found.size() == 3)
            throw BadVolume("'space directions' is not three vectors");
        const auto v = numbersIn(line.substr(0, end + 1), "'space directions'", 3);
        found.emplace_back(v[0], v[1], v[2]);
        line.remove_prefix(end + 1);
    }
    return found;
}

/// To the scene's axes; the identity for a space without anatomy.
glm::dmat3 sceneFromSpace(const std::string& space, RawVolume& volume) {
    const auto flip = [](double x, double y) {
        return sceneFromLps() * glm::dmat3({x, 0.0, 0.0}, {0.0, y, 0.0}, {0.0, 0.0, 1.0});
    };
    if (space == "left-posterior-superior" || space == "lps")
        return flip(1.0, 1.0);
    if (space == "right-anterior-superior" || space == "ras")
        return flip(-1.0, -1.0);
    if (space == "left-anterior-superior" || space == "las")
        return flip(1.0, -1.0);
    volume.notes |= kNoOrientation;
    return glm::dmat3(1.0);
}

/// The unit that all the words between quotes name; none where they name none.
std::optional<double> unitOf(std::string_view line) {
    const size_t first = line.find('"');
    const size_t second = first == std::string_view::npos ? first : line.find('"', first + 1);
    if (second == std::string_view::npos)
        return metres(trimmed(line.substr(0, line.find(' '))));
    return metres(line.substr(first + 1, second - first - 1));
}

void place(const NrrdFields& fields, size_t firstAxis, RawVolume& volume) {
    constexpr double kMillimetre = 1e-3;
    const auto unit =
        unitOf(text(fields, "space units").empty() ? text(fields, "units") : text(fields, "space units"));
    if (!unit)
        volume.notes |= kNoUnit;
    const double metre = unit.value_or(kMillimetre);
    const glm::dmat3 sceneFrom = sceneFromSpace(lowered(text(fields, "space")), volume);
    if (const std::string line = text(fields, "space directions"); !line.empty()) {
        const auto found = directions(line);
        if (found.size() != 3)
            throw BadVolume("'space directions' has " + std::to_string(found.size()) +
                            " vectors instead of 3");
        volume.axes = metre * sceneFrom * glm::dmat3(found[0], found[1], found[2]);
    } else if (const std::string spacings = text(fields, "spacings"); !spacings.empty()) {
        std::string known = lowered(spacings);
        for (size_t at; (at = known.find("nan")) != std::string::npos;)
            known.replace(at, 3, "1"); // an axis without a spacing
        const auto each = numbersIn(known, "'spacings'");
        if (each.size() < firstAxis + 3)
            throw BadVolume("'spacings' has " + std::to_string(each.size()) + " numbers");
        glm::dvec3 step(each[firstAxis], each[firstAxis + 1], each[firstAxis + 2]);
        volume.axes = metre * sceneFrom * glm::dmat3({step.x, 0, 0}, {0, step.y, 0}, {0, 0, step.z});
    } else {
        volume.axes = metre * sceneFrom;
    }
    if (const std::string line = text(fields, "space origin"); !line.empty()) {
        const auto at = numbersIn(line, "'space origin'", 3);
        volume.origin = metre * (sceneFrom * glm::dvec3(at[0], at[1], at[2]));
    }
}

void encode(const NrrdFields& fields, RawVolume& volume) {
    const std::string encoding = lowered(text(fields, "encoding"));
    if (encoding == "gz" || encoding == "gzip")
        volume.encoding = VolumeEncoding::Deflated;
    else if (encoding == "txt" || encoding == "text" || encoding == "ascii")
        volume.encoding = VolumeEncoding::Text;
    else if (encoding != "raw")
        throw BadVolume("its encoding is '" + encoding.substr(0, 20) + "': raw, gzip and text are read");
    const std::string endian = lowered(text(fields, "endian"));
    if (endian.empty() && volume.encoding != VolumeEncoding::Text && bytesOf(volume.type) > 1)
        throw BadVolume("it does not state the order of its bytes ('endian')");
    volume.bigEndian = endian == "big";
    if (!endian.empty() && endian != "big" && endian != "little")
        throw BadVolume("'endian' is neither little nor big");
    if (const std::string skip = text(fields, "line skip", "lineskip"); !skip.empty())
        volume.skipLines = wholeNumber(numbersIn(skip, "'line skip'", 1)[0], "'line skip'");
    if (const std::string skip = text(fields, "byte skip", "byteskip"); !skip.empty()) {
        const double bytes = numbersIn(skip, "'byte skip'", 1)[0];
        volume.atEnd = bytes == -1.0 && volume.encoding == VolumeEncoding::Raw;
        if (!volume.atEnd)
            volume.skipBytes = wholeNumber(bytes, "'byte skip'");
    }
}

} // namespace

RawVolume readNrrdHeader(std::span<const uint8_t> bytes) {
    RawVolume volume;
    const NrrdFields fields = nrrdFields(headerText(bytes), volume.headerBytes);
    const auto type = nrrdTypes().find(lowered(text(fields, "type")));
    if (type == nrrdTypes().end())
        throw BadVolume("its type is '" + text(fields, "type").substr(0, 30) + "', which is no number's");
    volume.type = type->second;
    const auto sizes = numbersIn(text(fields, "sizes"), "'sizes'");
    const auto dimension = numbersIn(text(fields, "dimension"), "'dimension'", 1);
    if (static_cast<double>(sizes.size()) != dimension[0])
        throw BadVolume("'sizes' has " + std::to_string(sizes.size()) +
                        " numbers, and 'dimension' is not that");
    // An axis of one value in front or behind is none.
    const bool leading = sizes.size() == 4 && sizes[0] == 1.0,
               trailing = sizes.size() == 4 && sizes[3] == 1.0;
    if (sizes.size() != 3 && !leading && !trailing)
        throw BadVolume("it has " + std::to_string(sizes.size()) +
                        " axes: a volume has three, and one value a voxel");
    const size_t first = leading ? 1 : 0;
    for (size_t axis = 0; axis < 3; ++axis)
        volume.size[axis] = wholeNumber(sizes[first + axis], "'sizes'");
    place(fields, first, volume);
    encode(fields, volume);
    volume.dataFile = text(fields, "data file", "datafile");
    refuseSeveralFiles(volume.dataFile);
    return volume;
}

} // namespace touchstone
