# Run at build time: writes the commit that is built into OUT, and touches it only where it has changed.
execute_process(COMMAND git -C "${SOURCE}" describe --always --abbrev=12 --dirty --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR commit STREQUAL "")
    set(commit "unknown")
endif()
file(CONFIGURE OUTPUT "${OUT}" CONTENT [[
#pragma once
namespace touchstone::study {
inline constexpr const char* kCommit = "@commit@";
}
]] @ONLY)
