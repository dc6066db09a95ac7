#pragma once
// common.h and the test framework, for tests/.
#include "cmake/precompiled/common.h"

#include <gtest/gtest.h>
