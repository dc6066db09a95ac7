# Every library we stand on, as an imported target. All are packages of Debian 12 and 13: tools/dependencies.txt.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(Vulkan 1.3 REQUIRED)
find_package(glfw3 3.3 REQUIRED)
find_package(glm REQUIRED)
find_package(TinyGLTF REQUIRED)
# Debian 12 has Embree 3, Debian 13 Embree 4: other headers, other arguments (haptics/shape/mesh/embree.h).
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
    find_package(embree 3.13 REQUIRED)
endif()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/haptics/shape/mesh/embree_version.h CONTENT "#define TOUCHSTONE_EMBREE @embree_VERSION_MAJOR@\n" @ONLY)
find_package(meshoptimizer REQUIRED)
find_package(draco REQUIRED)
find_package(ZLIB REQUIRED)
find_package(PNG REQUIRED)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(glslang REQUIRED)
find_package(SPIRV-Tools REQUIRED)
find_package(SPIRV-Tools-opt REQUIRED)
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)

# OpenImageIO's own CMake config demands the tools package; pkg-config does not.
pkg_check_modules(OpenImageIO REQUIRED IMPORTED_TARGET OpenImageIO)
pkg_check_modules(bullet REQUIRED IMPORTED_TARGET bullet)
pkg_check_modules(assimp REQUIRED IMPORTED_TARGET assimp)
pkg_check_modules(hidapi REQUIRED IMPORTED_TARGET hidapi-hidraw)
pkg_check_modules(portaudio REQUIRED IMPORTED_TARGET portaudio-2.0)
pkg_check_modules(alsa REQUIRED IMPORTED_TARGET alsa)
pkg_check_modules(jack REQUIRED IMPORTED_TARGET jack)
pkg_check_modules(sndfile REQUIRED IMPORTED_TARGET sndfile)
pkg_check_modules(xcb REQUIRED IMPORTED_TARGET xcb)
pkg_check_modules(dbus REQUIRED IMPORTED_TARGET dbus-1)

# OpenVDB's own CMake module looks for packages that only its tools need.
find_package(TBB REQUIRED)
find_path(OPENVDB_INCLUDE_DIR openvdb/openvdb.h REQUIRED)
find_library(OPENVDB_LIBRARY openvdb REQUIRED)
add_library(openvdb::openvdb SHARED IMPORTED)
set_target_properties(openvdb::openvdb PROPERTIES
    IMPORTED_LOCATION ${OPENVDB_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${OPENVDB_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES TBB::tbb)

# Debian ships Dear ImGui as one static library that already holds the GLFW and Vulkan backends and
# leaves stb undefined.
find_library(IMGUI_LIBRARY imgui REQUIRED)
find_library(STB_LIBRARY stb REQUIRED)
add_library(imgui::imgui STATIC IMPORTED)
set_target_properties(imgui::imgui PROPERTIES
    IMPORTED_LOCATION ${IMGUI_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES "/usr/include/imgui;/usr/include/imgui/backends"
    INTERFACE_LINK_LIBRARIES "glfw;Vulkan::Vulkan;${STB_LIBRARY};${CMAKE_DL_LIBS}")

