# What the tests stand on beside the program's libraries: tools/test-dependencies.txt. A machine may have some of it and not the rest (a fresh one
# had GoogleTest and no umockdev, and could not even configure the program): missing_for_tests names what is not there.
set(missing_for_tests)
find_package(GTest QUIET)
find_package(benchmark QUIET)
find_package(X11 QUIET)
find_library(RAPIDCHECK_LIBRARY rapidcheck)
pkg_check_modules(umockdev QUIET IMPORTED_TARGET umockdev-1.0)
foreach(found GTest_FOUND benchmark_FOUND X11_FOUND X11_XTest_FOUND RAPIDCHECK_LIBRARY umockdev_FOUND)
    if(NOT ${found})
        string(REGEX REPLACE "_(FOUND|LIBRARY)$" "" name ${found})
        list(APPEND missing_for_tests ${name})
    endif()
endforeach()
