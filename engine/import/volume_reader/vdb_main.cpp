// touchstone_vdb_reader vdb MOST: as touchstone_volume_reader (main.cpp), of OpenVDB's own files, by OpenVDB.

#include "engine/import/reader_child/sandbox.h"
#include "engine/import/reader_child/standard_streams.h"
#include "engine/import/volume_reader/child_main.h"
#include "engine/import/volume_reader/volume_values.h"

#include <unistd.h>

#include <cstdint>
#include <span>
#include <string_view>

namespace touchstone {
namespace {

void read(std::string_view format, uint64_t most, const char*) {
    if (format != "vdb")
        throw BadVolume("usage: touchstone_vdb_reader vdb MOST <VOLUME");
    const std::span<const uint8_t> file = standardInput();
    prepareVdb();
    enterSandbox();
    writeVdb(file, most);
    _exit(0); // memory is the system's to tidy
}

} // namespace
} // namespace touchstone

int main(int argc, char** argv) {
    touchstone::runVolumeReader(argc, argv, touchstone::read);
}
