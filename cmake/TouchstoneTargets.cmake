# Flags that all of our own code shares, and the one way to add a library.
# Contraction is off: where products and sums are fused depends on what is inlined, so that recordings would replay with the
# build alone that made them, and a program's numbers would not be those of its SPIR-V.
add_library(touchstone_flags INTERFACE)
target_compile_options(touchstone_flags INTERFACE
    -march=x86-64-v3 -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    -Wnon-virtual-dtor -Werror -fno-math-errno)
# g++ 12 sees overlaps in inlined std::string concatenation that are not there (GCC bug 105651).
target_compile_options(touchstone_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
# g++ 12.2 takes some calls for free of effects whose visitors change locals by reference, and removes them: once
# TriangleTree::walkRay was no longer inlined in `crossings` (haptics/shape/mesh/ray_walk.cpp), nothing was left of that but
# "0 crossings", and Embree.TheInsideTestAgreesWithTheClosedForm failed. Without this analysis (of what calls modify) it is right.
target_compile_options(touchstone_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fno-ipa-modref>)
# g++ collects its garbage often by default, which took an eighth of the time of our units; a unit takes up to 1.5 GB of memory so,
# 1.2 GB before.
target_compile_options(touchstone_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576>)
# Out of a precompiled header more of such warnings lose their place in a system header; the debug preset, which has no
# such header, keeps them.
if(TOUCHSTONE_PRECOMPILE)
    target_compile_options(touchstone_flags INTERFACE
        $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow -Wno-array-bounds>)
endif()
# Foreign headers are system headers, so warnings stay ours.
target_compile_definitions(touchstone_flags INTERFACE
    GLM_FORCE_DEPTH_ZERO_TO_ONE GLM_FORCE_XYZW_ONLY GLM_FORCE_EXPLICIT_CTOR GLM_ENABLE_EXPERIMENTAL
    TOUCHSTONE_VERSION="${PROJECT_VERSION}")
# Recordings name the build that made them.
target_link_options(touchstone_flags INTERFACE -Wl,--build-id=sha1)
target_include_directories(touchstone_flags INTERFACE ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/generated)
if(TOUCHSTONE_SANITIZE)
    # GCC 12 takes std::regex for uninitialised where a sanitizer is on (GCC bug 105562).
    target_compile_options(touchstone_flags INTERFACE -fsanitize=${TOUCHSTONE_SANITIZE} -fno-omit-frame-pointer
                           -Wno-maybe-uninitialized)
    target_link_options(touchstone_flags INTERFACE -fsanitize=${TOUCHSTONE_SANITIZE})
    # The sanitizers' own data lies in their shared libraries, and libtouchstone holds the static libraries (api/CMakeLists.txt).
    target_compile_options(touchstone_flags INTERFACE -fPIC)
    # Undefined behaviour ends the program as an address error does, or a test that meets it would pass. The library's
    # assertions see an index past a vector's size but inside its capacity, which the address sanitizer cannot.
    target_compile_options(touchstone_flags INTERFACE -fno-sanitize-recover=undefined,float-cast-overflow)
    target_compile_definitions(touchstone_flags INTERFACE _GLIBCXX_ASSERTIONS)
endif()

# touchstone_headers(NAME HEADER LIBS...) makes touchstone_NAME, which holds a precompiled header for other targets.
function(touchstone_headers name header)
    add_library(touchstone_${name} OBJECT ${PROJECT_SOURCE_DIR}/cmake/precompiled/empty.cpp)
    target_link_libraries(touchstone_${name} PRIVATE touchstone_flags ${ARGN})
    if(TOUCHSTONE_PRECOMPILE)
        target_precompile_headers(touchstone_${name} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled/${header})
    endif()
endfunction()

# touchstone_precompile(NAME TARGET...): the targets use the precompiled header of touchstone_NAME. Their compile
# options must be those of touchstone_flags (g++ refuses the header otherwise).
function(touchstone_precompile name)
    if(TOUCHSTONE_PRECOMPILE)
        foreach(target ${ARGN})
            target_precompile_headers(${target} REUSE_FROM touchstone_${name})
        endforeach()
    endif()
endfunction()

touchstone_headers(common_headers common.h glm::glm)

# touchstone_independent(TARGET...): code that may lie in libtouchstone although it refers to data of other shared libraries (streams).
# No library replaces a function of ours, so that they may be inlined as without -fPIC.
function(touchstone_independent)
    set_target_properties(${ARGN} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    foreach(target ${ARGN})
        target_compile_options(${target} PRIVATE -fno-semantic-interposition)
    endforeach()
endfunction()
touchstone_headers(independent_headers common.h glm::glm)
touchstone_independent(touchstone_independent_headers)

# touchstone_watched(TARGET...): under the thread sanitizer, in a build that is not sanitized (tests/threads).
if(NOT TOUCHSTONE_SANITIZE)
    add_library(touchstone_watched_flags INTERFACE)
    target_compile_options(touchstone_watched_flags INTERFACE -O1 -g1 -fsanitize=thread -fno-omit-frame-pointer -Wno-maybe-uninitialized)
    target_compile_definitions(touchstone_watched_flags INTERFACE _GLIBCXX_ASSERTIONS)
    target_link_options(touchstone_watched_flags INTERFACE -fsanitize=thread)
    touchstone_headers(watched_headers common.h glm::glm touchstone_watched_flags)
    set_target_properties(touchstone_watched_headers PROPERTIES EXCLUDE_FROM_ALL ON)
endif()
function(touchstone_watched)
    foreach(target ${ARGN})
        target_link_libraries(${target} PUBLIC touchstone_flags touchstone_watched_flags)
        touchstone_precompile(watched_headers ${target})
    endforeach()
endfunction()

# touchstone_rooms(TARGET SOURCES...): in a unity build the files of a room are compiled together, twelve at most, so that
# a new file concerns the names of its own room alone.
function(touchstone_rooms target)
    set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
    foreach(file ${ARGN})
        cmake_path(GET file PARENT_PATH room)
        string(REPLACE "/" "_" room "room_${room}")
        if(NOT DEFINED ${room}_files)
            set(${room}_files 0)
        endif()
        math(EXPR unit "${${room}_files} / 12")
        math(EXPR ${room}_files "${${room}_files} + 1")
        set_source_files_properties(${file} PROPERTIES UNITY_GROUP ${room}_${unit})
    endforeach()
endfunction()

# touchstone_library(NAME SOURCES... ) makes touchstone_NAME, the one static library of the folder NAME.
function(touchstone_library name)
    add_library(touchstone_${name} STATIC ${ARGN})
    add_library(touchstone::${name} ALIAS touchstone_${name})
    target_link_libraries(touchstone_${name} PUBLIC touchstone_flags)
    touchstone_rooms(touchstone_${name} ${ARGN})
endfunction()
