// The one place that compiles tinygltf (engine/import/file/tinygltf.h). Its writers, which we never call,
// want fstream even where it is told to leave files alone.
#include <fstream>

#define TINYGLTF_IMPLEMENTATION
#include "engine/import/file/tinygltf.h"
