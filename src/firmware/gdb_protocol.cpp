#include "firmware/gdb_protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <system_error>
#include <utility>
#include <vector>

namespace pogosim {

namespace {

constexpr char kInterrupt = '\x03';
constexpr char kEscape = '}';
constexpr unsigned char kEscapedBit = 0x20;
constexpr std::size_t kMostHexBytes = kGdbPacketBytes / 2 - 1;  // that an answer contains as text
constexpr std::size_t kMostWatchedBytes = 4096;

std::string const kOk = "OK";
std::string const kWrongPacket = "E16";    // EINVAL
std::string const kNoAccess = "E0e";       // EFAULT
std::string const kTooManyPoints = "E1c";  // ENOSPC

std::uint8_t sum_of(std::string_view contents) {
    std::uint8_t sum = 0;
    for (char const byte : contents) {
        sum = static_cast<std::uint8_t>(sum + static_cast<unsigned char>(byte));
    }
    return sum;
}

/// -1: it is no hexadecimal digit.
int digit_of(char character) {
    if (character >= '0' && character <= '9') {
        return character - '0';
    }
    char const lower = static_cast<char>(character | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

/// A number in hexadecimal digits, nothing else.
std::optional<std::uint32_t> number_of(std::string_view text) {
    std::uint32_t number = 0;
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, 16);
    bool const is_whole = !text.empty() && digit_of(text[0]) >= 0 && end == text.data() + text.size();
    return is_whole && error == std::errc() ? std::optional(number) : std::nullopt;
}

/// Takes what is in front of a separator out of a text, with it; all, if there is none.
std::string_view take_until(std::string_view& text, char separator) {
    std::size_t const at = text.find(separator);
    std::string_view const taken = text.substr(0, at);
    text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
    return taken;
}

std::string hex_of(std::span<std::byte const> bytes) {
    std::string text;
    text.reserve(2 * bytes.size());
    for (std::byte const byte : bytes) {
        fmt::format_to(std::back_inserter(text), "{:02x}", std::to_integer<unsigned>(byte));
    }
    return text;
}

/// Absent if these are no pairs of digits.
std::optional<std::vector<std::byte>> bytes_of_hex(std::string_view hex) {
    if (hex.size() % 2 != 0) {
        return std::nullopt;
    }
    std::vector<std::byte> bytes;
    bytes.reserve(hex.size() / 2);
    for (std::size_t i = 0; i < hex.size(); i += 2) {
        int const high = digit_of(hex[i]);
        int const low = digit_of(hex[i + 1]);
        if (high < 0 || low < 0) {
            return std::nullopt;
        }
        bytes.push_back(static_cast<std::byte>(16 * high + low));
    }
    return bytes;
}

/// In the order of memory: little-endian.
std::string hex_of_register(std::uint32_t value) {
    return fmt::format("{:02x}{:02x}{:02x}{:02x}", value & 0xffU, value >> 8 & 0xffU, value >> 16 & 0xffU, value >> 24);
}

std::optional<std::uint32_t> register_of_hex(std::string_view hex) {
    std::optional<std::vector<std::byte>> const bytes = bytes_of_hex(hex);
    if (!bytes || bytes->size() != 4) {
        return std::nullopt;
    }
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        value |= std::to_integer<std::uint32_t>((*bytes)[i]) << (8 * i);
    }
    return value;
}

/// The registers of the robot's processor, for gdb.
std::string target_description() {
    std::string text =
        "<?xml version=\"1.0\"?>\n<!DOCTYPE target SYSTEM \"gdb-target.dtd\">\n<target version=\"1.0\">\n"
        "<architecture>riscv:rv32</architecture>\n<feature name=\"org.gnu.gdb.riscv.cpu\">\n";
    for (std::size_t i = 0; i < kGdbProgramCounter; ++i) {
        text += fmt::format("<reg name=\"x{}\" bitsize=\"32\" type=\"int\" regnum=\"{}\"/>\n", i, i);
    }
    text += fmt::format("<reg name=\"pc\" bitsize=\"32\" type=\"code_ptr\" regnum=\"{}\"/>\n", kGdbProgramCounter);
    return text + "</feature>\n</target>\n";
}

struct Place {
    std::uint32_t address = 0;
    std::uint32_t bytes = 0;
};

/// "ADDRESS,LENGTH". Absent if that is malformed, or goes beyond the last address.
std::optional<Place> place_of(std::string_view text) {
    std::optional<std::uint32_t> const address = number_of(take_until(text, ','));
    std::optional<std::uint32_t> const bytes = number_of(text);
    if (!address || !bytes || std::uint64_t{*address} + *bytes > std::uint64_t{1} << 32) {
        return std::nullopt;
    }
    return Place{*address, *bytes};
}

}  // namespace

std::string gdb_packet(std::string_view contents) {
    return fmt::format("${}#{:02x}", contents, sum_of(contents));
}

std::string gdb_escaped(std::string_view bytes) {
    std::string contents;
    for (char const byte : bytes) {
        if (byte == '#' || byte == '$' || byte == kEscape || byte == '*') {
            contents += kEscape;
            contents += static_cast<char>(static_cast<unsigned char>(byte) ^ kEscapedBit);
        } else {
            contents += byte;
        }
    }
    return contents;
}

std::string gdb_unescaped(std::string_view contents) {
    std::string bytes;
    for (std::size_t i = 0; i < contents.size(); ++i) {
        if (contents[i] != kEscape) {
            bytes += contents[i];
        } else if (++i < contents.size()) {
            bytes += static_cast<char>(static_cast<unsigned char>(contents[i]) ^ kEscapedBit);
        }
    }
    return bytes;
}

GdbReader::Event GdbReader::take(char byte) {
    if (byte == '$' && state_ != State::between) {
        state_ = State::between;  // the end of a packet got lost
    }
    switch (state_) {
        case State::between:
            if (byte == '$') {
                state_ = State::contents;
                contents_.clear();
                is_too_long_ = false;
                sum_ = 0;
            }
            return {byte == kInterrupt ? Kind::interrupt
                    : byte == '+'      ? Kind::acknowledged
                    : byte == '-'      ? Kind::repeat
                                       : Kind::none};
        case State::contents:
            if (byte == '#') {
                state_ = State::first_digit;
                return {};
            }
            sum_ = static_cast<std::uint8_t>(sum_ + static_cast<unsigned char>(byte));
            is_too_long_ = is_too_long_ || contents_.size() >= kGdbPacketBytes;
            if (!is_too_long_) {
                contents_ += byte;
            }
            return {};
        case State::first_digit:
            first_digit_ = byte;
            state_ = State::second_digit;
            return {};
        case State::second_digit:
            break;
    }
    state_ = State::between;
    int const high = digit_of(first_digit_);
    int const low = digit_of(byte);
    if (is_too_long_ || high < 0 || low < 0 || 16 * high + low != sum_) {
        return {Kind::broken};
    }
    return {Kind::packet, std::exchange(contents_, {})};
}

std::string GdbProtocol::packet(std::string contents) {
    last_ = gdb_packet(contents);
    return last_;
}

std::string GdbProtocol::answer(GdbReader::Event const& event) {
    using Kind = GdbReader::Kind;
    if (event.kind == Kind::broken) {
        return acknowledges_ ? "-" : "";
    }
    if (event.kind == Kind::repeat) {
        return acknowledges_ ? last_ : "";
    }
    if (event.kind != Kind::packet) {
        return "";
    }
    std::string const acknowledged = acknowledges_ ? "+" : "";
    std::optional<std::string> contents = contents_of_answer(event.contents);
    if (std::exchange(ends_acknowledging_, false)) {
        acknowledges_ = false;
    }
    return contents ? acknowledged + packet(std::move(*contents)) : acknowledged;
}

std::string GdbProtocol::stop_reply() {
    return packet(stop_text());
}

std::string GdbProtocol::exit_reply(std::optional<GdbSignal> signal) {
    return packet(signal ? fmt::format("X{:02x}", static_cast<unsigned>(*signal)) : "W00");
}

/// "T05thread:1;", and which watchpoint was hit.
std::string GdbProtocol::stop_text() const {
    GdbStop const stop = target_.stopped();
    std::string text = fmt::format("T{:02x}thread:1;", static_cast<unsigned>(stop.signal));
    if (stop.watchpoint) {
        char const* const name = stop.watchpoint->kind == GdbPointKind::write  ? "watch"
                                 : stop.watchpoint->kind == GdbPointKind::read ? "rwatch"
                                                                               : "awatch";
        text += fmt::format("{}:{:x};", name, stop.watchpoint->address);
    }
    return text;
}

/// Absent: there is none now.
std::optional<std::string> GdbProtocol::contents_of_answer(std::string_view packet) {
    std::string_view const rest = packet.substr(packet.empty() ? 0 : 1);
    switch (packet.empty() ? '\0' : packet[0]) {
        case '?':
            return stop_text();
        case 'g':
            return all_registers();
        case 'G':
            return write_all_registers(rest);
        case 'p':
            return read_register(rest);
        case 'P':
            return write_register(rest);
        case 'm':
            return read_memory(rest);
        case 'M':
            return write_memory(rest, false);
        case 'X':
            return write_memory(rest, true);
        case 'Z':
        case 'z':
            return change_points(packet);
        case 'c':
        case 's':
        case 'C':
        case 'S':
            return resume(packet);
        case 'H':  // there is one thread
        case 'T':
            return kOk;
        case 'D':
            target_.detach();
            return kOk;
        case 'k':
            target_.kill();
            return std::nullopt;
        default:
            return packet.starts_with("vCont;") ? resume_thread(packet.substr(6)) : query(packet);
    }
}

std::string GdbProtocol::query(std::string_view packet) {
    std::string_view arguments = packet;
    std::string_view const name = take_until(arguments, ':');
    if (name == "qSupported") {
        return fmt::format("PacketSize={:x};QStartNoAckMode+;qXfer:features:read+;vContSupported+", kGdbPacketBytes);
    }
    if (name == "QStartNoAckMode") {
        ends_acknowledging_ = true;
        return kOk;
    }
    if (packet.starts_with("qXfer:features:read:")) {
        return features(packet.substr(20));
    }
    if (packet.starts_with("qRcmd,")) {
        return monitor(packet.substr(6));
    }
    if (packet == "vCont?") {
        return "vCont;c;C;s;S;r";  // without C and S, gdb does not use the others
    }
    if (packet.starts_with("vKill;")) {
        target_.kill();
        return kOk;
    }
    if (packet == "qfThreadInfo") {
        return "m1";
    }
    if (packet == "qsThreadInfo") {
        return "l";
    }
    if (packet == "qC") {
        return "QC1";
    }
    if (name == "qAttached") {
        return "1";  // the robot lives on when gdb leaves
    }
    return "";
}

/// "target.xml:OFFSET,LENGTH".
std::string GdbProtocol::features(std::string_view range) const {
    static std::string const description = target_description();
    std::string_view const file = take_until(range, ':');
    std::optional<std::uint32_t> const offset = number_of(take_until(range, ','));
    std::optional<std::uint32_t> const length = number_of(range);
    if (file != "target.xml") {
        return "E00";
    }
    if (!offset || !length || *offset > description.size()) {
        return kWrongPacket;
    }
    // Each byte may become two.
    std::string_view const part =
        std::string_view(description).substr(*offset, std::min<std::size_t>(*length, kMostHexBytes));
    bool const is_last = *offset + part.size() == description.size();
    return (is_last ? "l" : "m") + gdb_escaped(part);
}

std::string GdbProtocol::monitor(std::string_view hex) const {
    std::optional<std::vector<std::byte>> const bytes = bytes_of_hex(hex);
    if (!bytes) {
        return kWrongPacket;
    }
    std::string command;
    std::ranges::transform(*bytes, std::back_inserter(command), [](std::byte byte) { return static_cast<char>(byte); });
    std::string text = target_.monitor(command);
    if (text.empty()) {
        text = "There is no such command; \"monitor help\" lists them.\n";
    }
    return hex_of(std::as_bytes(std::span(text).first(std::min(text.size(), kMostHexBytes))));
}

std::string GdbProtocol::all_registers() const {
    std::string text;
    for (std::size_t i = 0; i < kGdbRegisters; ++i) {
        text += hex_of_register(target_.read_register(i));
    }
    return text;
}

std::string GdbProtocol::write_all_registers(std::string_view hex) {
    constexpr std::size_t digits = 8;
    if (hex.size() != digits * kGdbRegisters || !bytes_of_hex(hex)) {
        return kWrongPacket;
    }
    for (std::size_t i = 0; i < kGdbRegisters; ++i) {
        target_.write_register(i, *register_of_hex(hex.substr(digits * i, digits)));
    }
    return kOk;
}

std::string GdbProtocol::read_register(std::string_view text) const {
    std::optional<std::uint32_t> const number = number_of(text);
    return number && *number < kGdbRegisters ? hex_of_register(target_.read_register(*number)) : kWrongPacket;
}

/// "NUMBER=VALUE".
std::string GdbProtocol::write_register(std::string_view text) {
    std::optional<std::uint32_t> const number = number_of(take_until(text, '='));
    std::optional<std::uint32_t> const value = register_of_hex(text);
    if (!number || *number >= kGdbRegisters || !value) {
        return kWrongPacket;
    }
    target_.write_register(*number, *value);
    return kOk;
}

/// "ADDRESS,LENGTH". The answer may have less bytes.
std::string GdbProtocol::read_memory(std::string_view text) const {
    std::optional<Place> const place = place_of(text);
    if (!place) {
        return kWrongPacket;
    }
    if (place->bytes == 0) {
        return "";
    }
    std::vector<std::byte> bytes(std::min<std::size_t>(place->bytes, kMostHexBytes));
    bytes.resize(target_.read_memory(place->address, bytes));
    return bytes.empty() ? "E01" : hex_of(bytes);
}

/// "ADDRESS,LENGTH:BYTES".
std::string GdbProtocol::write_memory(std::string_view text, bool is_binary) {
    if (text.find(':') == std::string_view::npos) {
        return kWrongPacket;
    }
    std::optional<Place> const place = place_of(take_until(text, ':'));
    std::optional<std::vector<std::byte>> bytes;
    if (is_binary) {
        std::string const raw = gdb_unescaped(text);
        auto const view = std::as_bytes(std::span(raw));
        bytes.emplace(view.begin(), view.end());
    } else {
        bytes = bytes_of_hex(text);
    }
    if (!place || !bytes || bytes->size() != place->bytes) {
        return kWrongPacket;
    }
    return bytes->empty() || target_.write_memory(place->address, *bytes) ? kOk : kNoAccess;
}

/// "Z0,ADDRESS,KIND", for a watchpoint "Z2,ADDRESS,LENGTH"; conditions may follow after ';', which were not asked for.
std::string GdbProtocol::change_points(std::string_view packet) {
    if (packet.size() < 3 || packet[2] != ',') {
        return kWrongPacket;
    }
    if (packet[1] < '0' || packet[1] > '4') {
        return "";
    }
    std::string_view rest = packet.substr(3);
    std::optional<Place> const place = place_of(take_until(rest, ';'));
    if (!place) {
        return kWrongPacket;
    }
    GdbPoint const point{static_cast<GdbPointKind>(packet[1] - '0'), place->address, place->bytes};
    if (!point.is_breakpoint() && (point.bytes == 0 || point.bytes > kMostWatchedBytes)) {
        return kWrongPacket;
    }
    if (packet[0] == 'z') {
        target_.remove(point);
        return kOk;
    }
    return target_.insert(point) ? kOk : kTooManyPoints;
}

/// "c", "s", "cADDRESS", "C05", "C05;ADDRESS": signals are not for robots.
std::optional<std::string> GdbProtocol::resume(std::string_view packet) {
    bool const has_signal = packet[0] == 'C' || packet[0] == 'S';
    bool const is_step = packet[0] == 's' || packet[0] == 'S';
    std::string_view address = packet.substr(1);
    if (has_signal && !number_of(take_until(address, ';'))) {
        return kWrongPacket;
    }
    if (!address.empty()) {
        std::optional<std::uint32_t> const pc = number_of(address);
        if (!pc) {
            return kWrongPacket;
        }
        target_.write_register(kGdbProgramCounter, *pc);
    }
    target_.resume({.is_step = is_step});
    return std::nullopt;
}

/// "s:1;c": the first action is that of the only thread.
std::optional<std::string> GdbProtocol::resume_thread(std::string_view actions) {
    std::string_view action = take_until(actions, ';');
    action = take_until(action, ':');
    std::string_view rest = action.substr(action.empty() ? 0 : 1);
    GdbResume how;
    switch (action.empty() ? '\0' : action[0]) {
        case 'c':
            break;
        case 'C':
            if (!number_of(std::exchange(rest, {}))) {
                return kWrongPacket;
            }
            break;
        case 's':
            how.is_step = true;
            break;
        case 'S':
            how.is_step = true;
            if (!number_of(std::exchange(rest, {}))) {
                return kWrongPacket;
            }
            break;
        case 'r': {
            std::optional<std::uint32_t> const first = number_of(take_until(rest, ','));
            std::optional<std::uint32_t> const last = number_of(std::exchange(rest, {}));
            if (!first || !last) {
                return kWrongPacket;
            }
            how = {.is_step = true, .first = *first, .last = *last};
            break;
        }
        default:
            return kWrongPacket;
    }
    if (!rest.empty()) {
        return kWrongPacket;
    }
    target_.resume(how);
    return std::nullopt;
}

}  // namespace pogosim
