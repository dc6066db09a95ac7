// The only translation unit that compiles tinygltf (engine/import/file/tinygltf.h). Its unused writers need
// fstream even where file access is disabled.
#include <fstream>

#define TINYGLTF_IMPLEMENTATION
#include "engine/import/file/tinygltf.h"
