#include "firmware/firmware_robot.hpp"

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace pogosim {

namespace {

/// Calls visit(value) for each value of the state but texts and memory.
template <class Robot, class Visit>
void visit_values(Robot& robot, Visit const& visit) {
    visit(robot.core.x);
    visit(robot.core.pc);
    visit(robot.core.cycles);
    visit(robot.core.cache.held);
    visit(robot.core.cache.misses);
    visit(robot.seeds.first);
    visit(robot.seeds.is_first_taken);
    visit(robot.seeds.later);
    visit(robot.random);
    visit(robot.went_on_us);
    visit(robot.calls);
    visit(robot.tick_step);
    visit(robot.is_starting);
    visit(robot.is_ending_tick);
    visit(robot.is_drift_due);
    visit(robot.was_cut_off);
    visit(robot.timer_resets);
    visit(robot.ends_tick);
    visit(robot.has_noted_call);
    visit(robot.has_ended);
    visit(robot.is_restart_due);
    visit(robot.is_stack_above);
    visit(robot.has_called);
    visit(robot.tick_began_cycles);
    visit(robot.tick_cycles);
    visit(robot.timed_cycles);
    visit(robot.rest_us);
}

/// 0: nothing; 1: false; 2: true.
std::uint8_t code_of(std::optional<bool> value) {
    return value ? static_cast<std::uint8_t>(*value ? 2 : 1) : std::uint8_t{0};
}

void add(std::vector<std::byte>& bytes, std::span<std::byte const> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
}

template <class Value>
void add_value(std::vector<std::byte>& bytes, Value const& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    add(bytes, std::as_bytes(std::span(&value, 1)));
}

std::span<std::byte const> take(std::span<std::byte const>& bytes, std::size_t count) {
    std::span const taken = bytes.first(count);
    bytes = bytes.subspan(count);
    return taken;
}

template <class Value>
void take_value(std::span<std::byte const>& bytes, Value& value) {
    std::memcpy(&value, take(bytes, sizeof(value)).data(), sizeof(value));
}

}  // namespace

void save_robot(FirmwareRobot const& robot, std::vector<std::byte>& bytes) {
    visit_values(robot, [&](auto const& value) { add_value(bytes, value); });
    add_value(bytes, code_of(robot.finds_data));
    add_value(bytes, static_cast<std::uint32_t>(robot.printed.size()));
    add(bytes, std::as_bytes(std::span(robot.printed)));
    add_value(bytes, static_cast<std::uint32_t>(robot.memory.copied_pages()));
    for (std::uint32_t page = 0; page < robot.memory.pages(); ++page) {
        if (std::span const own = robot.memory.own_page(page); !own.empty()) {
            add_value(bytes, page);
            add(bytes, own);
        }
    }
}

void restore_robot(FirmwareRobot& robot, std::span<std::byte const>& bytes) {
    visit_values(robot, [&](auto& value) { take_value(bytes, value); });
    std::uint8_t finds_data = 0;
    take_value(bytes, finds_data);
    robot.finds_data = finds_data == 0 ? std::nullopt : std::optional(finds_data == 2);
    std::uint32_t size = 0;
    take_value(bytes, size);
    std::span const text = take(bytes, size);
    robot.printed.assign(reinterpret_cast<char const*>(text.data()), text.size());
    std::uint32_t pages = 0;
    take_value(bytes, pages);
    for (; pages > 0; --pages) {
        std::uint32_t page = 0;
        take_value(bytes, page);
        robot.memory.write_page(page, bytes);
    }
}

}  // namespace pogosim
