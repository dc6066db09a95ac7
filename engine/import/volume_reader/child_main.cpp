#include "engine/import/volume_reader/child_main.h"

#include "engine/import/reader_child/standard_streams.h"

#include <charconv>
#include <exception>
#include <new>

namespace touchstone {

void runVolumeReader(int argc, char** argv, VolumeRead read) {
    try {
        uint64_t most = 0;
        const std::string_view number = argc > 2 ? argv[2] : "";
        std::from_chars(number.data(), number.data() + number.size(), most);
        read(argc > 1 ? argv[1] : "", most, argc > 3 ? argv[3] : nullptr);
    } catch (const std::bad_alloc&) {
        endWith(1, "it needs more memory than it may have");
    } catch (const std::exception& error) {
        endWith(1, error.what());
    }
}

} // namespace touchstone
