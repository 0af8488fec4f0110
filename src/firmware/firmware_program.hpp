// A firmware with the functions of the robots' library in place: what all robots that run it share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "riscv/firmware_file.hpp"
#include "world/brain_spec.hpp"
#include "world/processor_spec.hpp"

namespace pogosim {

/// The number of an intercepted jump to itself, where a robot does nothing any more. Other numbers are indices of
/// library_functions().
inline constexpr std::int32_t kEndlessLoop = -1;

struct FirmwareProgram {
    std::string file;
    std::vector<std::byte> bytes;  // of the file
    Firmware firmware;             // with functions of the library intercepted

    // Addresses of variables, as far as the firmware has them. Compilers leave out variables that never change, and
    // make functions of the main loop a part of others; but each tick of it begins when the stopwatch timer_main_loop
    // is reset, and ends with a sleep after that is read.
    std::optional<std::uint32_t> loop_timer{};    // timer_main_loop; absent: there is no main loop
    std::optional<std::uint32_t> ticks{};         // pogobot_ticks
    std::optional<std::uint32_t> loop_hz{};       // main_loop_hz
    std::optional<std::uint32_t> send_percent{};  // percent_msgs_sent_per_ticks
    std::optional<std::uint32_t> is_muted{};      // _master_mute, of the library
};

/// Whether a file is one that load_firmware() would read or refuse for its contents: an ELF file for RISC-V.
bool is_firmware_file(std::string const& file);

/// Reads a firmware, and intercepts the functions of the library that it contains. Throws ConfigError, which names the
/// file, for what read_firmware() refuses, and if there is no main().
std::shared_ptr<FirmwareProgram const> load_firmware(FirmwareSpec const& spec, ProcessorSpec const& processor);

/// "user_step (main.c:84)", as far as the file says it; "0x00001234" for what is no function.
std::string place_in_firmware(FirmwareProgram const& program, std::uint32_t address);

}  // namespace pogosim
