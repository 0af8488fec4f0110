// Commands of the remote control, without any program.
#include "device/infrared.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <string_view>

#include "interface/pogobase_inside.hpp"
#include "support/devices.hpp"

namespace pogosim {
namespace {

constexpr unsigned kOneFace = 1;
constexpr unsigned kTwoFaces = 3;

std::span<std::byte const> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text));
}

PacketKind kind_of(std::uint8_t type, std::string_view text) {
    return kind_of_packet({.packet_type = type}, bytes_of(text));
}

struct Robot {
    World world = testing::world_with_queue(2);
    Mailboxes& mailboxes = world.mailboxes;
    InfraredState& state = world.devices.infrared[0];

    void hears(std::string_view text, PacketKind kind, unsigned faces = kOneFace) {
        FrameHeader const header{.packet_type = ir_t_cmd, .payload_length = static_cast<std::uint16_t>(text.size())};
        mailboxes.deliver(0, header, bytes_of(text), kind, faces);
    }
    bool obeys() { return mailboxes.has_commands(0) && obey_commands(world, 0); }
};

TEST(RemoteControl, CommandIsTheBeginningOfAPacketOfItsType) {
    EXPECT_EQ(kind_of(ir_t_cmd, "DEADCAFE"), PacketKind::mute);
    EXPECT_EQ(kind_of(ir_t_cmd, "BASECAFE and more"), PacketKind::unmute);
    EXPECT_EQ(kind_of(ir_t_cmd, "DEADBEEF"), PacketKind::restart);
    EXPECT_EQ(kind_of(ir_t_cmd, "DEADBEE"), PacketKind::message);
    EXPECT_EQ(kind_of(ir_t_cmd, ""), PacketKind::message);
    EXPECT_EQ(kind_of(ir_t_user, "DEADBEEF"), PacketKind::message);
}

TEST(RemoteControl, LastOfSeveralCommandsCounts) {
    Robot robot;
    EXPECT_FALSE(robot.obeys());
    robot.hears("BASECAFE", PacketKind::unmute);
    robot.hears("DEADCAFE", PacketKind::mute);
    EXPECT_EQ(robot.state.is_muted, 0) << "it obeys when its program decodes messages";
    EXPECT_FALSE(robot.obeys());
    EXPECT_EQ(robot.state.is_muted, 1);
    robot.hears("DEADCAFE", PacketKind::mute);
    robot.hears("BASECAFE", PacketKind::unmute);
    EXPECT_FALSE(robot.obeys());
    EXPECT_EQ(robot.state.is_muted, 0);
    EXPECT_FALSE(robot.mailboxes.has_commands(0));
}

TEST(RemoteControl, CommandIsObeyedAndCountedAsLostWhenTheQueueIsFull) {
    Robot robot;
    robot.hears("a", PacketKind::message, kTwoFaces);
    robot.hears("DEADBEEF", PacketKind::restart, kTwoFaces);
    EXPECT_EQ(robot.mailboxes.size(0), 2);
    EXPECT_EQ(drops_since_start(robot.world, 0), 2);
    EXPECT_TRUE(robot.obeys());
    EXPECT_FALSE(robot.obeys());
}

TEST(RemoteControl, MalformedPacketIsCountedForEachFaceAndNotPassedOn) {
    Robot robot;
    robot.hears("abc", PacketKind::malformed, kTwoFaces);
    EXPECT_TRUE(robot.mailboxes.empty(0));
    EXPECT_EQ(malformed_since_start(robot.world, 0), 2);
    EXPECT_EQ(drops_since_start(robot.world, 0), 0);
}

TEST(RemoteControl, InitialisingUnmutesEmptiesTheQueueAndSetsCountersToZero) {
    Robot robot;
    robot.hears("a", PacketKind::message, kTwoFaces);
    robot.hears("DEADCAFE", PacketKind::mute);
    robot.hears("b", PacketKind::malformed);
    robot.obeys();
    robot.state.muted_messages = 7;
    initialise_infrared(robot.world, 0);
    EXPECT_EQ(robot.state.is_muted, 0);
    EXPECT_TRUE(robot.mailboxes.empty(0));
    EXPECT_EQ(drops_since_start(robot.world, 0), 0);
    EXPECT_EQ(malformed_since_start(robot.world, 0), 0);
    EXPECT_EQ(robot.state.muted_messages, 7) << "of the whole run";
    robot.hears("b", PacketKind::malformed);
    EXPECT_EQ(malformed_since_start(robot.world, 0), 1);
}

}  // namespace
}  // namespace pogosim
