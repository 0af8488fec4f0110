#include "device/remote_control.hpp"

#include <array>
#include <string_view>
#include <utility>

namespace pogosim {

namespace {

using namespace std::string_view_literals;

constexpr std::array<std::pair<std::string_view, PacketKind>, 3> kCommands{
    {{"DEADCAFE"sv, PacketKind::mute}, {"BASECAFE"sv, PacketKind::unmute}, {"DEADBEEF"sv, PacketKind::restart}}};

}  // namespace

PacketKind kind_of_command(std::span<std::byte const> payload) {
    std::string_view const text(reinterpret_cast<char const*>(payload.data()), payload.size());
    for (auto const& [command, kind] : kCommands) {
        if (text.starts_with(command)) {
            return kind;
        }
    }
    return PacketKind::message;
}

bool obey_commands(World& world, std::uint32_t robot) {
    Mailboxes::Commands const commands = world.mailboxes.take_commands(robot);
    if (commands.is_muted) {
        world.devices.infrared[robot].is_muted = *commands.is_muted ? 1 : 0;
    }
    return commands.restart;
}

void initialise_infrared(World& world, std::uint32_t robot) {
    InfraredState& state = world.devices.infrared[robot];
    world.mailboxes.clear(robot);
    state.is_muted = 0;
    state.dropped_before = world.mailboxes.dropped(robot);
    state.malformed_before = world.mailboxes.malformed(robot);
}

std::uint32_t drops_since_start(World const& world, std::uint32_t robot) {
    return static_cast<std::uint32_t>(world.mailboxes.dropped(robot) - world.devices.infrared[robot].dropped_before);
}

std::uint32_t malformed_since_start(World const& world, std::uint32_t robot) {
    return static_cast<std::uint32_t>(world.mailboxes.malformed(robot) -
                                      world.devices.infrared[robot].malformed_before);
}

}  // namespace pogosim
