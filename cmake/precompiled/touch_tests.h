#pragma once
// tests.h and the bench that most tests of touch stand on: half of what such a test takes to compile.
#include "cmake/precompiled/tests.h"
#include "tests/support/touch_bench.h"
