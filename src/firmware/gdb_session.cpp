#include "firmware/gdb_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "base/escaped.hpp"
#include "base/log.hpp"
#include "firmware/firmware_program.hpp"
#include "riscv/memory_image.hpp"

namespace pogosim {

namespace {

constexpr int kWaitMs = 100;                            // between looks at Ctrl-C in the simulator's terminal
constexpr std::uint64_t kCyclesBetweenLooks = 500'000;  // at Ctrl-C of gdb, of a robot that does not call the library
constexpr std::uint32_t kReturn = 0x00008067;           // ret
constexpr std::size_t kMostBreakpoints = 1024;
constexpr std::size_t kMostWatchpoints = 64;

GdbSignal signal_of(StopReason reason) {
    switch (reason) {
        case StopReason::illegal_instruction:
        case StopReason::ecall:
            return GdbSignal::illegal_instruction;
        case StopReason::ebreak:
            return GdbSignal::trap;
        case StopReason::unaligned_access:
            return GdbSignal::bus_error;
        default:
            return GdbSignal::segmentation;
    }
}

/// Bytes that an operation reads from memory, or writes to it; 0: it does neither.
std::uint32_t accessed_bytes(Operation operation) {
    switch (operation) {
        case Operation::lb:
        case Operation::lbu:
        case Operation::sb:
            return 1;
        case Operation::lh:
        case Operation::lhu:
        case Operation::sh:
            return 2;
        case Operation::lw:
        case Operation::sw:
            return 4;
        default:
            return 0;
    }
}

bool is_store(Operation operation) {
    return operation == Operation::sb || operation == Operation::sh || operation == Operation::sw;
}

std::string_view trimmed(std::string_view text) {
    constexpr auto kBlanks = " \t\r\n";
    std::size_t const first = text.find_first_not_of(kBlanks);
    return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace

/// While this exists, gdb sees this robot.
class GdbSession::Scope {
public:
    Scope(GdbSession& session, Core& core, Memory& memory, Code const& code) : session_(session) {
        session_.core_ = &core;
        session_.memory_ = &memory;
        session_.code_ = &code;
    }
    ~Scope() {
        session_.core_ = nullptr;
        session_.memory_ = nullptr;
        session_.code_ = nullptr;
    }
    Scope(Scope const&) = delete;
    Scope& operator=(Scope const&) = delete;

private:
    GdbSession& session_;
};

GdbSession::GdbSession(GdbRobot robot, int port) : robot_(std::move(robot)), server_(port) {}

GdbSession::~GdbSession() {
    if (server_.has_peer() && protocol_) {
        server_.send_last(protocol_->exit_reply(ended_by_));
    }
}

// ---- Running

Stop GdbSession::run(Core& core, Memory& memory, Code const& code, std::uint64_t most_cycles) {
    constexpr std::uint64_t kLongest = std::numeric_limits<std::int64_t>::max() / 2;
    Scope const scope(*this, core, memory, code);
    if (!std::exchange(has_waited_, true)) {
        wait_for_peer();
    }
    look_at_peer();
    end_call();
    std::uint64_t const end = core.cycles + std::min(most_cycles, kLongest);
    std::uint64_t next_look = core.cycles + kCyclesBetweenLooks;
    for (;;) {
        if (core.cycles >= next_look) {
            look_at_peer();
            next_look = core.cycles + kCyclesBetweenLooks;
        }
        if (passed_ != core.pc) {
            passed_.reset();
        }
        if (is_at_breakpoint()) {
            show({});
            continue;
        }
        if (core.cycles >= end) {
            return pogosim::run(core, memory, code, 0);
        }
        bool const is_single = is_single_step();
        touched_ = touched_point();
        std::uint64_t const cycles = is_single ? 1 : std::min(end, next_look) - core.cycles;
        Stop const stop = pogosim::run(core, memory, is_single ? code : code_with_breakpoints(), cycles);
        if (stop.reason == StopReason::budget_used) {
            note_progress();
        } else if (stop.reason == StopReason::intercepted) {
            if (!is_at_breakpoint()) {
                passed_ = called_ = stop.pc;
                return stop;
            }
        } else if (stop.reason == StopReason::wait_for_interrupt || !is_shown(stop)) {
            return stop;
        }
    }
}

/// With watchpoints, each instruction; else only what gdb asks for, and an instruction at which a breakpoint is.
bool GdbSession::is_single_step() const {
    return how_.is_step || !watched_.empty() || passed_ == core_->pc;
}

bool GdbSession::has_breakpoint(std::uint32_t address) const {
    return std::ranges::find(breakpoints_, address, &GdbPoint::address) != breakpoints_.end();
}

/// One that has not been shown.
bool GdbSession::is_at_breakpoint() const {
    return passed_ != core_->pc && has_breakpoint(core_->pc);
}

/// A function of the library in which the robot was has returned, unless it has to be called once more.
void GdbSession::end_call() {
    if (called_ && called_ != core_->pc) {
        called_.reset();
        note_progress();
    }
}

/// The robot has gone on: by an instruction, a function of the library or, if nothing is looked at, several.
void GdbSession::note_progress() {
    passed_.reset();
    shown_fault_.reset();
    std::optional<GdbPoint> watchpoint = changed_point();
    if (!watchpoint) {
        watchpoint = std::exchange(touched_, std::nullopt);
    }
    std::uint32_t const offset = core_->pc - how_.first;
    bool const is_step_over = how_.is_step && offset >= how_.last - how_.first;
    if (watchpoint || is_step_over) {
        show({.signal = GdbSignal::trap, .watchpoint = watchpoint});
    }
}

/// Whether gdb was shown that the robot cannot go on, and may have changed that. False: it was shown before.
bool GdbSession::is_shown(Stop const& fault) {
    GdbSignal const signal = signal_of(fault.reason);
    bool const is_return_to_gdb = fault.reason == StopReason::jump_outside && fault.address != fault.pc &&
                                  !code_->overlaps(fault.address, 1) && has_breakpoint(fault.address);
    if (is_return_to_gdb) {
        core_->pc = fault.address;  // the function that it has called returns to a breakpoint on the stack
        return true;
    }
    if (!server_.has_peer() || shown_fault_ == fault) {
        ended_by_ = signal;
        return false;
    }
    shown_fault_ = fault;
    show({.signal = signal});
    return true;
}

void GdbSession::look(Core& core, Memory& memory, Code const& code) {
    Scope const scope(*this, core, memory, code);
    if (has_waited_) {
        look_at_peer();
    }
}

void GdbSession::show_failure(Core& core, Memory& memory, Code const& code) {
    Scope const scope(*this, core, memory, code);
    if (!ended_by_) {
        ended_by_ = GdbSignal::abort;
        show({.signal = GdbSignal::abort});
    }
}

// ---- Watchpoints and breakpoints

/// A watchpoint for reading that the instruction at pc meets: by its addresses, whatever the values.
std::optional<GdbPoint> GdbSession::touched_point() const {
    Step const* const found = code_->step_at(core_->pc);
    std::uint64_t const bytes = found != nullptr ? accessed_bytes(found->operation) : 0;
    if (watched_.empty() || bytes == 0) {
        return std::nullopt;
    }
    Step const& step = *found;
    std::uint32_t const base = step.rs1 == 0 ? 0 : core_->x[step.rs1 % core_->x.size()];
    std::uint32_t const address = base + static_cast<std::uint32_t>(step.immediate);
    for (Watched const& watched : watched_) {
        GdbPoint const& point = watched.point;
        bool const is_meant =
            point.kind == GdbPointKind::access || (point.kind == GdbPointKind::read && !is_store(step.operation));
        if (is_meant && address < std::uint64_t{point.address} + point.bytes && point.address < address + bytes) {
            return GdbPoint{point.kind, std::max(address, point.address), point.bytes};
        }
    }
    return std::nullopt;
}

/// A watchpoint for writing whose bytes are others than when the robot last went on.
std::optional<GdbPoint> GdbSession::changed_point() const {
    for (Watched const& watched : watched_) {
        std::vector<std::byte> now(watched.before.size());
        bool const is_read = memory_->read(watched.point.address, now).fault == AccessFault::none;
        if (watched.point.kind != GdbPointKind::read && is_read && now != watched.before) {
            return watched.point;
        }
    }
    return std::nullopt;
}

void GdbSession::renew_watched() {
    for (Watched& watched : watched_) {
        watched.before.resize(watched.point.bytes);
        if (memory_->read(watched.point.address, watched.before).fault != AccessFault::none) {
            watched.before.clear();  // which never change
        }
    }
}

/// Made anew after each change: gdb takes its breakpoints away while the robot stands still.
Code const& GdbSession::code_with_breakpoints() {
    if (breakpoints_.empty()) {
        return *code_;
    }
    if (!code_with_breakpoints_) {
        code_with_breakpoints_ = *code_;
        for (GdbPoint const& point : breakpoints_) {
            intercept(*code_with_breakpoints_, point.address);
        }
    }
    return *code_with_breakpoints_;
}

// ---- The connection

void GdbSession::wait_for_peer() {
    log().info("robot #{}: waiting for gdb on port {}: riscv64-unknown-elf-gdb {} -ex 'target remote :{}'", robot_.id,
               port(), escaped(robot_.firmware), port());
    flush_logs();
    while (!server_.has_peer() && !robot_.interrupted()) {
        server_.wait(kWaitMs);
    }
    if (server_.has_peer()) {
        welcome_peer();
    }
}

/// Does not wait for anything, unless gdb has stopped the robot.
void GdbSession::look_at_peer() {
    bool const had_peer = server_.has_peer();
    server_.wait(0);
    if (!had_peer && server_.has_peer()) {
        welcome_peer();
        return;
    }
    take(server_.receive());
    if (had_peer && !server_.has_peer()) {
        forget_peer();
    } else if (std::exchange(is_interrupt_pending_, false)) {
        show({.signal = GdbSignal::interrupt});
    }
}

/// A robot stands still when gdb connects.
void GdbSession::welcome_peer() {
    protocol_.emplace(static_cast<GdbTarget&>(*this));
    reader_ = {};
    owes_reply_ = false;
    is_interrupt_pending_ = false;
    show({});
}

void GdbSession::forget_peer() {
    breakpoints_.clear();
    watched_.clear();
    code_with_breakpoints_.reset();
    how_ = {};
    is_stopped_ = false;
    if (!ends_run_ && !robot_.interrupted()) {
        log().info("robot #{}: gdb has left, and the run goes on; it may connect again", robot_.id);
    }
}

/// Bytes of gdb. While the robot runs, only Ctrl-C is expected.
void GdbSession::take(std::string_view bytes) {
    for (char const byte : bytes) {
        GdbReader::Event const event = reader_.take(byte);
        if (is_stopped_) {
            server_.send(protocol_->answer(event));
        } else if (event.kind == GdbReader::Kind::interrupt) {
            is_interrupt_pending_ = true;
        }
        if (std::exchange(is_leaving_, false)) {
            server_.close_peer();
            return;
        }
    }
}

/// Tells gdb, and does what it asks for until the robot may go on.
void GdbSession::show(GdbStop const& stop) {
    if (!server_.has_peer()) {
        return;
    }
    std::uint32_t const pc = core_->pc;
    stop_ = stop;
    how_ = {};
    is_stopped_ = true;
    touched_.reset();
    if (std::exchange(owes_reply_, false)) {
        server_.send(protocol_->stop_reply());
    }
    while (is_stopped_ && server_.has_peer()) {
        server_.wait(kWaitMs);
        take(server_.receive());
        if (robot_.interrupted()) {
            server_.close_peer();
        }
    }
    passed_ = core_->pc == pc ? std::optional(pc) : std::nullopt;
    if (!server_.has_peer()) {
        forget_peer();
    }
    renew_watched();
}

// ---- What gdb sees and does

std::uint32_t GdbSession::read_register(std::size_t number) const {
    return number == kGdbProgramCounter ? core_->pc : number == 0 ? 0 : core_->x[number];
}

void GdbSession::write_register(std::size_t number, std::uint32_t value) {
    (number == kGdbProgramCounter ? core_->pc : core_->x[number]) = value;
}

std::size_t GdbSession::read_memory(std::uint32_t address, std::span<std::byte> bytes) const {
    Memory::Copied const copied = memory_->read(address, bytes);
    if (copied.fault != AccessFault::none) {
        bytes = bytes.first(std::min<std::size_t>(copied.address - address, bytes.size()));
        if (memory_->read(address, bytes).fault != AccessFault::none) {
            return 0;
        }
    }
    show_library_as_returns(address, bytes);
    return bytes.size();
}

/// For RISC-V, gdb makes a step by a breakpoint at the instruction that comes next, for which it decodes the one at pc.
/// What it must find at a function of the library is what becomes of the robot there: it returns.
void GdbSession::show_library_as_returns(std::uint32_t address, std::span<std::byte> bytes) const {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::uint32_t const offset = address + static_cast<std::uint32_t>(i) - code_->address;
        bool const is_library = offset < code_->bytes() &&
                                code_->steps[offset / 4].operation == Operation::intercepted &&
                                intercepted_number(*code_, code_->address + offset / 4 * 4) != kEndlessLoop;
        if (is_library) {
            bytes[i] = static_cast<std::byte>(kReturn >> (8 * (offset % 4)));
        }
    }
}

/// Not to code, which has been decoded: what gdb would see there is not what runs.
bool GdbSession::write_memory(std::uint32_t address, std::span<std::byte const> bytes) {
    return !code_->overlaps(address, bytes.size()) && memory_->write(address, bytes).fault == AccessFault::none;
}

bool GdbSession::insert(GdbPoint const& point) {
    if (point.is_breakpoint()) {
        if (std::ranges::find(breakpoints_, point) != breakpoints_.end()) {
            return true;
        }
        code_with_breakpoints_.reset();
        bool const fits = breakpoints_.size() < kMostBreakpoints;
        if (fits) {
            breakpoints_.push_back(point);
        }
        return fits;
    }
    if (std::ranges::find(watched_, point, &Watched::point) != watched_.end()) {
        return true;
    }
    bool const fits = watched_.size() < kMostWatchpoints;
    if (fits) {
        watched_.push_back({point});
    }
    return fits;
}

void GdbSession::remove(GdbPoint const& point) {
    std::erase(breakpoints_, point);
    std::erase_if(watched_, [&](Watched const& watched) { return watched.point == point; });
    code_with_breakpoints_.reset();
}

void GdbSession::resume(GdbResume const& how) {
    how_ = how;
    is_stopped_ = false;
    owes_reply_ = true;
}

void GdbSession::detach() {
    is_leaving_ = true;
}

void GdbSession::kill() {
    is_leaving_ = ends_run_ = true;
    robot_.end_run();
}

std::string GdbSession::monitor(std::string_view command) const {
    std::string_view const word = trimmed(command);
    if (word == "help") {
        return "monitor help: these lines\n"
               "monitor robot: which robot this is\n"
               "monitor time: its simulated time, the tick, and the cycles of its processor\n";
    }
    if (word == "robot") {
        return fmt::format("robot #{} of category '{}', firmware {}\n", robot_.id, escaped(robot_.category),
                           escaped(robot_.firmware));
    }
    if (word == "time") {
        return fmt::format("{}, {} cycles\n", robot_.time(), core_->cycles);
    }
    return "";
}

}  // namespace pogosim
