#include "firmware/firmware_program.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/error.hpp"
#include "base/escaped.hpp"
#include "firmware/code_places.hpp"
#include "firmware/firmware_call.hpp"

namespace pogosim {

namespace {

std::vector<std::byte> bytes_of_file(std::string const& file) {
    constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 28U;
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error) || std::filesystem::file_size(file, error) > most_bytes) {
        throw ConfigError(fmt::format("{}: is no firmware: expected an ELF file of up to 256 MiB", escaped(file)));
    }
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> const bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (stream.bad() || !stream.is_open()) {
        throw ConfigError(fmt::format("{}: the firmware cannot be read", escaped(file)));
    }
    std::span const raw = std::as_bytes(std::span(bytes));
    return {raw.begin(), raw.end()};
}

std::optional<std::uint32_t> variable_at(Firmware const& firmware, std::string_view name, std::uint32_t bytes) {
    FirmwareSymbol const* const found = firmware.find(name);
    return found != nullptr && !found->is_function && found->bytes == bytes ? std::optional(found->address)
                                                                            : std::nullopt;
}

/// Whether code is that with which a program begins and ends: the program's own does not wait for the end of time.
bool is_start_code(Firmware const& firmware, std::uint32_t address) {
    FirmwareSymbol const* const function = firmware.function_at(address);
    return function == nullptr || function->name.starts_with('_') || function->name == "exit" ||
           function->name == "abort";
}

/// A jump to itself, where programs end.
void intercept_endless_loops(Firmware& firmware) {
    Code& code = firmware.code;
    for (std::size_t i = 0; i < code.steps.size(); ++i) {
        Step const& step = code.steps[i];
        std::uint32_t const address = code.address + static_cast<std::uint32_t>(4 * i);
        if (step.operation == Operation::jal && step.immediate == 0 && is_start_code(firmware, address)) {
            intercept(code, address, kEndlessLoop);
        }
    }
}

/// Whether a program is unlikely to have a function of its own by this name.
bool is_name_of_library(std::string_view name) {
    return name.starts_with("pogobot_") || name.starts_with("magn_") || name.ends_with("_flash") || name == "msleep";
}

/// The function of the library by a name; null: there is none. A program may have others by this name, static in a
/// file. When the library is optimised together with the program, its functions are static, too.
FirmwareSymbol const* function_of_library(Firmware const& firmware, std::string_view name) {
    FirmwareSymbol const* found = nullptr;
    for (FirmwareSymbol const& symbol : firmware.symbols) {
        bool const is_better = found == nullptr || (symbol.is_global && !found->is_global);
        if (symbol.name == name && symbol.is_function && (symbol.is_global || is_name_of_library(name)) && is_better) {
            found = &symbol;
        }
    }
    return found;
}

void intercept_library(Firmware& firmware, FirmwareRandom random) {
    std::span const functions = library_functions();
    for (std::size_t i = 0; i < functions.size(); ++i) {
        bool const is_wanted = !functions[i].is_random || random == FirmwareRandom::simulator;
        FirmwareSymbol const* const symbol = function_of_library(firmware, functions[i].name);
        if (symbol != nullptr && is_wanted) {
            intercept(firmware.code, symbol->address, static_cast<std::int32_t>(i));
        }
    }
}

}  // namespace

bool is_firmware_file(std::string const& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) {
        return false;
    }
    constexpr std::string_view magic = "\177ELF";
    constexpr std::size_t machine_at = 18;
    constexpr char risc_v = '\xf3';
    std::ifstream stream(file, std::ios::binary);
    std::array<char, machine_at + 1> header{};
    return stream.read(header.data(), header.size()) && std::string_view(header.data(), magic.size()) == magic &&
           header[machine_at] == risc_v;
}

std::shared_ptr<FirmwareProgram const> load_firmware(FirmwareSpec const& spec, ProcessorSpec const& processor) {
    std::string const name = escaped(spec.file);
    if (processor.memory_bytes > kFlashAddress) {
        throw ConfigError(fmt::format("{}: processor.memory_bytes is {}, beyond 0x{:08x}, where the robot's flash is",
                                      name, processor.memory_bytes, kFlashAddress));
    }
    auto program = std::make_shared<FirmwareProgram>();
    program->file = spec.file;
    program->bytes = bytes_of_file(spec.file);
    Firmware& firmware = program->firmware;
    firmware = read_firmware(name, program->bytes, {.bytes = static_cast<std::uint32_t>(processor.memory_bytes)},
                             processor.cycles);
    if (firmware.find("main") == nullptr) {
        throw ConfigError(fmt::format("{}: has no function main(): expected the firmware of a robot", name));
    }
    intercept_endless_loops(firmware);
    intercept_library(firmware, spec.random);
    program->loop_timer = variable_at(firmware, "timer_main_loop", 4);
    program->ticks = variable_at(firmware, "pogobot_ticks", 4);
    program->loop_hz = variable_at(firmware, "main_loop_hz", 1);
    program->send_percent = variable_at(firmware, "percent_msgs_sent_per_ticks", 1);
    program->is_muted = variable_at(firmware, "_master_mute", 1);
    return program;
}

std::string place_in_firmware(FirmwareProgram const& program, std::uint32_t address) {
    CodePlaces const places(program);
    if (!places.is_code(address)) {
        return fmt::format("0x{:08x}", address);
    }
    std::string const& function = places.functions()[places.chain(places.chain_of(address)).back()];
    CodePlaces::Line const& line = places.line(places.line_of(address));
    return line.file.empty() ? function : fmt::format("{} ({}:{})", function, line.file, line.number);
}

}  // namespace pogosim
