// touchstone_volume_reader nrrd|meta|nifti MOST [HEADER]: reads a volume from standard input and writes
// it flat to standard output (engine/import/volume_file/flat_volume_format.h), at most MOST bytes of values.
// Exit status 1: standard output has a line that says why there is none; kDetachedData: the name of the file
// that holds the values. The program is then started again with that file as its input and the text of the
// first one as HEADER.
//
// Headers are read by code of ours, compressed values by zlib. Both meet files of any origin, so they run in
// this process: the parent limits memory and time, and the sandbox leaves it no file, network or process.
// OpenVDB's own files have a reader of their own (vdb_main.cpp), since to load OpenVDB takes 37 ms.

#include "engine/import/reader_child/sandbox.h"
#include "engine/import/reader_child/standard_streams.h"
#include "engine/import/volume_file/flat_volume_format.h"
#include "engine/import/volume_reader/child_main.h"
#include "engine/import/volume_reader/volume_values.h"

#include <unistd.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace touchstone {
namespace {

using HeaderReader = RawVolume (*)(std::span<const uint8_t>);

void readHeaderAndData(HeaderReader reader, std::span<const uint8_t> header, std::span<const uint8_t> file,
                       bool detached, uint64_t most) {
    RawVolume volume = reader(header);
    checkVolumeSize(volume, most);
    if (!detached && !volume.dataFile.empty())
        endWith(kDetachedData, volume.dataFile);
    writeVolume(volume, detached ? file : file.subspan(volume.headerBytes));
}

void readNifti(std::span<const uint8_t> file, uint64_t most) {
    constexpr size_t kHeader = 352;
    const bool deflated = file.size() > 2 && file[0] == 0x1f && file[1] == 0x8b;
    const std::vector<uint8_t> start = deflated ? inflatedStart(file, kHeader) : std::vector<uint8_t>();
    RawVolume volume = readNiftiHeader(deflated ? std::span<const uint8_t>(start) : file);
    volume.encoding = deflated ? VolumeEncoding::Deflated : VolumeEncoding::Raw;
    checkVolumeSize(volume, most);
    writeVolume(volume, file);
}

void read(std::string_view format, uint64_t most, const char* header) {
    const std::span<const uint8_t> file = standardInput();
    enterSandbox();
    const std::string_view text = header != nullptr ? header : "";
    const std::span<const uint8_t> before =
        header != nullptr ? std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()) : file;
    if (format == "nrrd")
        readHeaderAndData(readNrrdHeader, before, file, header != nullptr, most);
    else if (format == "meta")
        readHeaderAndData(readMetaHeader, before, file, header != nullptr, most);
    else if (format == "nifti")
        readNifti(file, most);
    else
        throw BadVolume("usage: touchstone_volume_reader nrrd|meta|nifti MOST [HEADER] <VOLUME");
    _exit(0); // memory is the system's to tidy
}

} // namespace
} // namespace touchstone

int main(int argc, char** argv) {
    touchstone::runVolumeReader(argc, argv, touchstone::read);
}
