#pragma once

#include "renderer/vulkan.h"

namespace vk::detail {} // namespace vk::detail

namespace touchstone {

/// Throws the exception of vulkan.hpp for a result that is none of the expected ones.
[[noreturn]] inline void throwResult(VkResult result, const char* what) {
    using namespace vk;
    using namespace vk::detail;
    throwResultException(static_cast<vk::Result>(result), what);
}

} // namespace touchstone
