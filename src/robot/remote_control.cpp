#include "robot/remote_control.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "interface/pogobase_inside.hpp"

namespace pogosim {

namespace {

using namespace std::string_view_literals;

constexpr std::array<std::pair<std::string_view, PacketKind>, 3> kCommands{
    {{"DEADCAFE"sv, PacketKind::mute}, {"BASECAFE"sv, PacketKind::unmute}, {"DEADBEEF"sv, PacketKind::restart}}};

}  // namespace

PacketKind kind_of_packet(FrameHeader const& header, std::span<std::byte const> payload) {
    if (header.packet_type != ir_t_cmd) {
        return PacketKind::message;
    }
    std::string_view const text(reinterpret_cast<char const*>(payload.data()), payload.size());
    for (auto const& [command, kind] : kCommands) {
        if (text.starts_with(command)) {
            return kind;
        }
    }
    return PacketKind::message;
}

bool obey_commands(Mailboxes& mailboxes, std::size_t robot, InfraredState& state) {
    Mailboxes::Commands const commands = mailboxes.take_commands(robot);
    if (commands.is_muted) {
        state.is_muted = *commands.is_muted ? 1 : 0;
    }
    return commands.restart;
}

void initialise_infrared(Mailboxes& mailboxes, std::size_t robot, InfraredState& state) {
    mailboxes.clear(robot);
    state.is_muted = 0;
    state.dropped_before = mailboxes.dropped(robot);
    state.malformed_before = mailboxes.malformed(robot);
}

std::uint32_t drops_since_start(Mailboxes const& mailboxes, std::size_t robot, InfraredState const& state) {
    return static_cast<std::uint32_t>(mailboxes.dropped(robot) - state.dropped_before);
}

std::uint32_t malformed_since_start(Mailboxes const& mailboxes, std::size_t robot, InfraredState const& state) {
    return static_cast<std::uint32_t>(mailboxes.malformed(robot) - state.malformed_before);
}

}  // namespace pogosim
