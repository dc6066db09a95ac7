#include "eye_points.h"

#include "renderer/gpu_impl.h"
#include "renderer/gpu_memory.h"
#include "renderer/program/link_program.h"
#include "tests/support/lavapipe.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace touchstone::program {

namespace {

#include "shaders/program_points_comp.h"

constexpr size_t kInputs = 13, kOutputs = 7, kGroup = 64, kVector = 16; ///< of program_points.comp

vk::raii::DescriptorSetLayout layoutOf(const Gpu::Impl& gpu, vk::DescriptorType type, uint32_t count) {
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    for (uint32_t i = 0; i < count; ++i)
        bindings.push_back({.binding = i,
                            .descriptorType = type,
                            .descriptorCount = 1,
                            .stageFlags = vk::ShaderStageFlagBits::eCompute});
    return {gpu.device,
            vk::DescriptorSetLayoutCreateInfo{.bindingCount = count, .pBindings = bindings.data()}};
}

} // namespace

EyePoints::EyePoints() {
    test::useLavapipe();
    gpu_ = Gpu::headless();
}

std::vector<EyeResult> EyePoints::run(std::span<const uint32_t> program,
                                      std::span<const std::byte> parameters,
                                      std::span<const std::array<PortValue, kMaxLocations>> inputs) {
    const Gpu::Impl& gpu = gpu_->impl();
    const LinkedProgram linked = linkProgram(program_points_comp, program, 1);
    if (!linked.problem.empty())
        throw std::runtime_error(linked.problem);
    using Usage = vk::BufferUsageFlagBits;
    const GpuBuffer in =
        createBuffer(gpu, inputs.size() * kInputs * kVector, Usage::eStorageBuffer, MemoryUse::Upload);
    const GpuBuffer out =
        createBuffer(gpu, inputs.size() * kOutputs * kVector, Usage::eStorageBuffer, MemoryUse::Readback);
    const GpuBuffer uniforms = createBuffer(gpu, parameters.size(), Usage::eUniformBuffer, MemoryUse::Upload);
    for (size_t i = 0; i < inputs.size(); ++i)
        std::memcpy(in.mapped + i * kInputs * kVector, inputs[i].data(), kInputs * kVector);
    std::ranges::copy(parameters, uniforms.mapped); // a program may have none

    const vk::raii::DescriptorSetLayout points = layoutOf(gpu, vk::DescriptorType::eStorageBuffer, 2),
                                        block = layoutOf(gpu, vk::DescriptorType::eUniformBuffer, 1);
    const std::array layouts{*points, *block};
    const std::array sizes{vk::DescriptorPoolSize{vk::DescriptorType::eStorageBuffer, 2},
                           vk::DescriptorPoolSize{vk::DescriptorType::eUniformBuffer, 1}};
    const vk::raii::DescriptorPool pool(
        gpu.device, vk::DescriptorPoolCreateInfo{
                        .maxSets = 2, .poolSizeCount = sizes.size(), .pPoolSizes = sizes.data()});
    const std::vector<vk::DescriptorSet> sets =
        (*gpu.device)
            .allocateDescriptorSets({.descriptorPool = *pool,
                                     .descriptorSetCount = layouts.size(),
                                     .pSetLayouts = layouts.data()},
                                    *gpu.device.getDispatcher());
    const std::array<vk::DescriptorBufferInfo, 3> buffers{
        {{*in.buffer, 0, in.size}, {*out.buffer, 0, out.size}, {*uniforms.buffer, 0, uniforms.size}}};
    for (uint32_t i = 0; i < 3; ++i)
        gpu.device.updateDescriptorSets(
            vk::WriteDescriptorSet{.dstSet = sets[i / 2],
                                   .dstBinding = i % 2,
                                   .descriptorCount = 1,
                                   .descriptorType = i < 2 ? vk::DescriptorType::eStorageBuffer
                                                           : vk::DescriptorType::eUniformBuffer,
                                   .pBufferInfo = &buffers[i]},
            {});
    const vk::raii::PipelineLayout layout(
        gpu.device,
        vk::PipelineLayoutCreateInfo{.setLayoutCount = layouts.size(), .pSetLayouts = layouts.data()});
    const vk::raii::ShaderModule module(
        gpu.device,
        vk::ShaderModuleCreateInfo{.codeSize = 4 * linked.words.size(), .pCode = linked.words.data()});
    const vk::raii::Pipeline pipeline(
        gpu.device, nullptr,
        vk::ComputePipelineCreateInfo{
            .stage = {.stage = vk::ShaderStageFlagBits::eCompute, .module = *module, .pName = "main"},
            .layout = *layout});
    runOnce(gpu, [&](const vk::raii::CommandBuffer& commands) {
        commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline);
        commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout, 0, sets, {});
        commands.dispatch(static_cast<uint32_t>((inputs.size() + kGroup - 1) / kGroup), 1, 1);
    });
    std::vector<EyeResult> results(inputs.size());
    for (size_t i = 0; i < inputs.size(); ++i) {
        const std::byte* const from = out.mapped + i * kOutputs * kVector;
        std::memcpy(results[i].out.data(), from, 5 * kVector);
        float done = 0.0f;
        std::memcpy(&done, from + (kOutputs - 1) * kVector, 4);
        results[i].done = done == 1.0f;
    }
    return results;
}

} // namespace touchstone::program
