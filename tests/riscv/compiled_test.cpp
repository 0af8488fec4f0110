// What the robots' compiler makes of a program does on the simulated processor what the program does on this machine.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "riscv/core.hpp"
#include "riscv/program/workloads.h"

namespace {

using namespace pogosim;

#ifdef POGOSIM_TEST_RISCV_PROGRAM

std::shared_ptr<MemoryImage const> program_image() {
    std::ifstream file(POGOSIM_TEST_RISCV_PROGRAM, std::ios::binary);
    std::string const bytes{std::istreambuf_iterator<char>(file), {}};
    MemoryImage image;
    std::ranges::transform(bytes, image.bytes.begin(), [](char byte) { return static_cast<std::byte>(byte); });
    return std::make_shared<MemoryImage const>(std::move(image));
}

TEST(RiscvCompiled, ProgramHasTheResultsOfThisMachine) {
    auto const image = program_image();
    Code const code = decode_code(0, std::span(image->bytes).first(0x4000));  // see program/memory.ld
    for (std::uint32_t const which : {kCrc, kSort, kFloats, kMixture}) {
        for (std::uint32_t const count : {0U, 1U, 7U, which == kSort ? 20U : 5000U}) {
            Memory memory(image);
            Core core;
            core.x[10] = which;
            core.x[11] = count;
            Stop const stop = run(core, memory, code, 100'000'000);
            EXPECT_EQ(stop.reason, StopReason::ecall);
            EXPECT_EQ(core.x[10], workload(which, count)) << which << ", " << count;
            EXPECT_EQ(core.x[2], kMemoryBytes);  // the stack is empty again
            EXPECT_LE(memory.copied_pages(), 8U);
        }
    }
}

#else

TEST(RiscvCompiled, ProgramHasTheResultsOfThisMachine) {
    GTEST_SKIP() << "riscv64-unknown-elf-gcc was not installed when this was configured (see docs/real_robot.md)";
}

#endif

}  // namespace
