#include "engine/import/volume_file/volume_format.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace touchstone {

namespace {

struct FormatNames {
    const char* name;
    const char* word;
};
constexpr FormatNames kFormatNames[] = {
    {"NRRD", "nrrd"}, {"MetaImage", "meta"}, {"NIfTI", "nifti"}, {"OpenVDB", "vdb"}};

struct Ending {
    std::string_view ending;
    VolumeFormat format;
};
constexpr Ending kEndings[] = {{".nrrd", VolumeFormat::Nrrd}, {".nhdr", VolumeFormat::Nrrd},
                               {".mhd", VolumeFormat::Meta},  {".mha", VolumeFormat::Meta},
                               {".nii", VolumeFormat::Nifti}, {".nii.gz", VolumeFormat::Nifti},
                               {".vdb", VolumeFormat::Vdb}};

} // namespace

const char* nameOf(VolumeFormat format) {
    return kFormatNames[static_cast<size_t>(format)].name;
}

const char* wordOf(VolumeFormat format) {
    return kFormatNames[static_cast<size_t>(format)].word;
}

std::optional<VolumeFormat> volumeFormatNamed(const std::filesystem::path& file) {
    std::string name = file.filename().string();
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const Ending& each : kEndings)
        if (name.size() > each.ending.size() && name.ends_with(each.ending))
            return each.format;
    return std::nullopt;
}

} // namespace touchstone
