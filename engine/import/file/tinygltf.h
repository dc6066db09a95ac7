#pragma once
// tinygltf without image loading, without files, and in a separate namespace: Debian's libdraco exports the
// symbols of another version of tinygltf, and the library loaded first would serve both with the wrong
// structs.

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#define tinygltf touchstone_tinygltf
#include <tiny_gltf.h>
#undef tinygltf

namespace tinygltf = touchstone_tinygltf;
