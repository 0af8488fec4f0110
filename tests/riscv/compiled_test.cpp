// What the robots' compiler makes of a program does on the simulated processor what the program does on this machine.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <span>
#include <string>

#include "riscv/core.hpp"
#include "riscv/firmware_file.hpp"
#include "riscv/program/workloads.h"

namespace {

using namespace pogosim;

#ifdef POGOSIM_TEST_RISCV_PROGRAM

Firmware program() {
    std::ifstream file(POGOSIM_TEST_RISCV_PROGRAM, std::ios::binary);
    std::string const bytes{std::istreambuf_iterator<char>(file), {}};
    return read_firmware(POGOSIM_TEST_RISCV_PROGRAM, std::as_bytes(std::span(bytes)));
}

TEST(RiscvCompiled, ProgramHasItsFunctionsByName) {
    Firmware const firmware = program();
    ASSERT_NE(firmware.find("workload"), nullptr);
    FirmwareSymbol const& workload = *firmware.find("workload");
    EXPECT_TRUE(workload.is_function);
    EXPECT_EQ(firmware.function_at(workload.address + workload.bytes - 4), &workload);
    EXPECT_EQ(firmware.entry, firmware.find("start")->address);
}

TEST(RiscvCompiled, ProgramHasTheResultsOfThisMachine) {
    Firmware const firmware = program();
    for (std::uint32_t const which : {kCrc, kSort, kFloats, kMixture}) {
        for (std::uint32_t const count : {0U, 1U, 7U, which == kSort ? 20U : 5000U}) {
            Memory memory(firmware.image);
            Core core{.x = {}, .pc = firmware.entry};
            core.x[10] = which;
            core.x[11] = count;
            Stop const stop = run(core, memory, firmware.code, 100'000'000);
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
