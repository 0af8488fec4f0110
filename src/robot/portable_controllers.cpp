// The state of the user's program on all robots as bytes that another process of the same program can go on from: see
// portable_memory.hpp for its addresses.
#include <fmt/format.h>

#include <algorithm>

#include "process/program_memory.hpp"
#include "robot/controllers.hpp"
#include "robot/portable_memory.hpp"

namespace pogosim {

namespace {

/// The order is that of the file.
template <class Self, class State>
void visit_plain(Self& self, State& state) {
    state(self.went_on_us, self.calls, self.is_restart_due, self.waits, self.call_began_us, self.call_ticks,
          self.longest_call_us, self.send_results, self.random, self.seeds, self.printed, self.rest_us, self.polled_us);
    auto& program = self.program;
    state(program.registered, program.prepared, program.reads_messages, program.decodes_messages, program.returned,
          program.seed);
    auto& loop = self.loop;
    state(loop.loop_hz, loop.max_messages_per_tick, loop.send_percent, loop.error_led, loop.sent, loop.received,
          loop.milliseconds, loop.error_shown_at_ms, loop.global_timer, loop.loop_timer);
}

template <class Self, class Visit>
void visit_callbacks(Self& self, Visit const& visit) {
    visit(self.program.init);
    visit(self.program.step);
    visit(self.program.export_data);
    visit(self.program.end);
    visit(self.program.click);
    visit(self.loop.receive);
    visit(self.loop.send);
}

void append_controller(Controller const& self, StateWriter& state, AddressRegions const& regions) {
    visit_plain(self, state);
    visit_callbacks(self, [&](auto const pointer) { regions.append_pointer(state, pointer); });
}

/// What belongs to the process (stack, user data, thread) stays.
void take_controller(Controller& self, StateReader& state, AddressRegions const& regions) {
    visit_plain(self, state);
    visit_callbacks(self, [&](auto& pointer) { regions.take_pointer(state, pointer); });
    self.fiber = nullptr;
    self.waits_in = Phase::none;
}

void append_bound(std::vector<BoundVariable> const& variables, StateWriter& state, AddressRegions const& regions) {
    state(variables.size());
    for (BoundVariable const& bound : variables) {
        state(bound.name, bound.size, bound.bytes);
        regions.append_pointer(state, bound.read);
        regions.append_pointer(state, bound.variable);
    }
}

std::vector<BoundVariable> take_bound(StateReader& state, AddressRegions const& regions) {
    std::size_t count = 0;
    state(count);
    std::vector<BoundVariable> variables;
    for (std::size_t i = 0; i < count; ++i) {
        BoundVariable& bound = variables.emplace_back();
        state(bound.name, bound.size, bound.bytes);
        regions.take_pointer(state, bound.read);
        regions.take_pointer(state, bound.variable);
    }
    return variables;
}

template <class Self, class State>
void visit_columns(Self& data, State& state) {
    state(data.was_set, data.filled_rows, data.held, data.awaits_step);
}

std::vector<std::byte> bytes_at(std::span<std::byte const> place) {
    std::vector<std::byte> bytes(place.size());
    copy_program_bytes(bytes.data(), place.data(), place.size());
    return bytes;
}

}  // namespace

std::string Controllers::why_state_is_elsewhere() const {
    return why_state_is_not_copied(image_);
}

bool Controllers::is_waiting_in_middle() const {
    return std::ranges::any_of(controllers_, [](Controller const& self) { return self.fiber != nullptr; });
}

std::string Controllers::why_never_portable() const {
    if (image_.main == nullptr || driven_count() == 0) {
        return "";
    }
    if (image_.is_for_sdk) {
        return "its robots wait in the middle of main() (pogobot.h), on stacks that only this process has";
    }
    return "";
}

/// Where the program has its variables: without those of the linker, which are of this process.
std::vector<std::span<std::byte>> Controllers::portable_variables() const {
    std::vector<std::span<std::byte>> pieces = image_.memory_of_robots();
    for (ProgramSymbols::Variable const& variable : image_.symbols().variables) {
        // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system hands out an address
        auto* const place = reinterpret_cast<std::byte*>(image_.load_address + variable.address);
        if (!variable.is_of_thread && !is_in_any(pieces, place)) {
            pieces.emplace_back(place, variable.bytes);  // POGO_SHARED
        }
    }
    std::erase_if(pieces, [this](auto const& piece) { return !is_in_any(image_.variables, piece.data()); });
    return pieces;
}

std::string Controllers::name_at(std::byte const* place) const {
    auto const user_data = services_.user_data;
    if (place >= user_data.data() && place < user_data.data() + user_data.size()) {
        auto const at = static_cast<std::size_t>(place - user_data.data());
        std::size_t const robot = at / user_data_stride();
        return robot < controllers_.size()
                   ? fmt::format("byte {} of USERDATA of robot #{}", at % user_data_stride(), world_.robots.id[robot])
                   : "the user data of the global step";
    }
    for (ProgramSymbols::Variable const& variable : image_.symbols().variables) {
        std::uintptr_t const begin = image_.load_address + variable.address;
        auto const address = reinterpret_cast<std::uintptr_t>(place);
        if (!variable.is_of_thread && address >= begin && address < begin + variable.bytes) {
            return fmt::format("the variable '{}'", name_by_symbol(variable.name));
        }
    }
    return "a variable of the program";
}

void Controllers::append_state(StateWriter& state) {
    if (image_.main == nullptr) {
        return;
    }
    AddressRegions const regions(image_, services_.user_data);
    regions.append_names(state);
    auto const append = [&](std::span<std::byte const> bytes, auto const& place_at) {
        regions.append_memory(state, bytes, [&](std::uint64_t at) { return name_at(place_at(at)); });
    };
    Saved const saved = save();
    for (Controller const& self : saved.controllers) {
        append_controller(self, state, regions);
    }
    append_controller(saved.system, state, regions);
    regions.append_pointer(state, saved.callbacks.global_setup);
    regions.append_pointer(state, saved.callbacks.create_data_schema);
    regions.append_pointer(state, saved.callbacks.global_step);
    append(saved.user_data, [&](std::uint64_t at) { return services_.user_data.data() + at; });
    for (std::span<std::byte> const piece : portable_variables()) {
        append(bytes_at(piece), [&](std::uint64_t at) { return piece.data() + at; });
    }
    if (saved.own_memory) {
        RobotMemory::Saved const& own = *saved.own_memory;
        auto const place = [&](std::uint64_t at) { return own_memory_->place_of(at); };
        append(own.same, place);
        append(own.other, place);
        append(own.copies, [&](std::uint64_t at) {
            constexpr std::size_t block = RobotMemory::kBlockBytes;
            return own_memory_->place_of(own.different[at / block % own.different.size()] * block + at % block);
        });
        state(own.different, own.changed.size());
        for (RobotMemory::ChangedByte const& byte : own.changed) {
            state(own_memory_->offset_of(byte.place), byte.value);
        }
    }
    visit_columns(saved.columns, state);
    append_bound(saved.bound_variables, state, regions);
    state(saved.is_restart_due, saved.gave_user_data, has_waited_.load());
}

void Controllers::take_state(StateReader& state) {
    if (image_.main == nullptr) {
        return;
    }
    AddressRegions regions(image_, services_.user_data);
    regions.take_names(state);
    Saved saved = save();  // what belongs to this process
    saved.fibers.clear();
    for (Controller& self : saved.controllers) {
        take_controller(self, state, regions);
    }
    take_controller(saved.system, state, regions);
    regions.take_pointer(state, saved.callbacks.global_setup);
    regions.take_pointer(state, saved.callbacks.create_data_schema);
    regions.take_pointer(state, saved.callbacks.global_step);
    std::size_t const bytes = saved.user_data.size();
    regions.take_memory(state, saved.user_data);
    if (saved.user_data.size() != bytes) {
        throw ForeignState("its robots have other user data");
    }
    std::vector<std::span<std::byte>> const pieces = portable_variables();
    std::vector<std::vector<std::byte>> variables(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        regions.take_memory(state, variables[i]);
        if (variables[i].size() != pieces[i].size()) {
            throw ForeignState("its program has other variables");
        }
    }
    if (saved.own_memory) {
        RobotMemory::Saved& own = *saved.own_memory;
        std::vector<FoundAddress> addresses;
        regions.take_memory(state, own.same);
        regions.take_memory(state, own.other, &addresses);
        regions.take_memory(state, own.copies);
        std::size_t changes = 0;
        state(own.different, changes);
        if (!own_memory_->fits(own)) {
            throw ForeignState("its robots have other variables");
        }
        own.changed.clear();
        for (std::size_t i = 0; i < changes; ++i) {
            std::size_t offset = 0;
            std::byte value{};
            state(offset, value);
            if (offset >= own.other.size()) {
                throw ForeignState("its robots have other variables");
            }
            // An address has other bytes in this process.
            bool const is_of_address = std::ranges::any_of(addresses, [offset](FoundAddress const& one) {
                return offset >= one.at && offset < one.at + sizeof(std::uint64_t);
            });
            own.changed.push_back(
                {.place = own_memory_->place_of(offset), .value = is_of_address ? own.other[offset] : value});
        }
    }
    std::vector<ColumnSpec> const columns = saved.columns.columns;
    visit_columns(saved.columns, state);
    saved.columns.was_set.resize(columns.size(), true);
    saved.bound_variables = take_bound(state, regions);
    bool has_waited = false;
    state(saved.is_restart_due, saved.gave_user_data, has_waited);
    has_waited_ = has_waited;

    restore(saved);
    set_callbacks_of_thread(saved.callbacks);  // start() is not over
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        copy_program_bytes(pieces[i].data(), variables[i].data(), pieces[i].size());
    }
}

}  // namespace pogosim
