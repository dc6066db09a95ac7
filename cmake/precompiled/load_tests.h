#pragma once
// tests.h and what tests of the import stand on.
#include "cmake/precompiled/tests.h"
#include "tests/unit/engine/load_support.h"
