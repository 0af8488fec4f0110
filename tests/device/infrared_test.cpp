// The infrared port, without any program.
#include "device/infrared.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <vector>

#include "interface/pogobase_inside.hpp"
#include "support/devices.hpp"

namespace pogosim {
namespace {

constexpr std::uint8_t kFront = 1U;
constexpr std::uint8_t kLeft = 8U;

std::span<std::byte const> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text));
}

TEST(Infrared, ListOfPowersHasTwoBitsForEachEmitter) {
    World world = testing::world_with_robot();
    for (std::uint8_t power = 0; power <= kMostIrPower; ++power) {
        set_ir_power(world, 0, power);
        for (std::uint8_t emitters = 0; emitters <= kAllFaces; ++emitters) {
            std::uint8_t const list = power_list(world, 0, emitters);
            for (unsigned face = 0; face < kMostFaces; ++face) {
                unsigned const expected = (emitters >> face & 1U) != 0 ? power : 0U;
                EXPECT_EQ(list >> (2 * face) & 3U, expected);
            }
        }
    }
    for (unsigned list = 0; list <= 0xFF; ++list) {
        unsigned const highest = std::max({list & 3U, list >> 2U & 3U, list >> 4U & 3U, list >> 6U & 3U});
        EXPECT_EQ(highest_power(static_cast<std::uint8_t>(list)), highest);
    }
}

TEST(Infrared, LongMessageSaysWhoSendsAndAtWhatPower) {
    World world = testing::world_with_robot();
    set_ir_power(world, 0, 2);
    std::uint8_t const list = power_list(world, 0, kFront | kLeft);
    EXPECT_EQ(list, 0b10000010);
    EXPECT_EQ(emitters_in(world, 0, list), kFront | kLeft);
    EXPECT_EQ(highest_power(list), 2);
    Packet const packet = long_packet(world, 0, kLeft, list, bytes_of("abc"), ir_t_user);
    EXPECT_TRUE(packet.radiates());
    EXPECT_EQ(packet.header.sender_id, 0);
    EXPECT_EQ(packet.header.sender_ir_index, 3);
    EXPECT_EQ(packet.header.payload_length, 3);
    EXPECT_EQ(packet.header_bytes, 8);
    EXPECT_EQ(long_packet(world, 0, kAllFaces, list, {}, ir_t_user).header.sender_ir_index, ir_all);
}

TEST(Infrared, ShortMessageSaysNeither) {
    World world = testing::world_with_robot();
    Packet const packet = short_packet(world, 0, kAllFaces, bytes_of("a"));
    EXPECT_EQ(packet.header.sender_id, 0xFF);
    EXPECT_EQ(packet.header.sender_ir_index, 0xF);
    EXPECT_EQ(packet.header_bytes, 3);
    EXPECT_EQ(packet.power, kUsualIrPower);
}

TEST(Infrared, PowersBeyondTheMostAreTheMostAndPowerZeroRadiatesNothing) {
    World world = testing::world_with_robot();
    set_ir_power(world, 0, 200);
    EXPECT_EQ(world.devices.ir_power[0], kMostIrPower);
    set_ir_power(world, 0, 0);
    EXPECT_FALSE(short_packet(world, 0, kAllFaces, {}).radiates());
    EXPECT_EQ(ir_range_mm(world, 0), 0.0F);
}

TEST(Infrared, TransmissionIsOnTheAirWithItsBytesAndCounted) {
    World world = testing::world_with_robot();
    transmit(world, 0, world.air, short_packet(world, 0, kFront, bytes_of("hello")), 0.25F);
    ASSERT_EQ(world.air.transmissions.size(), 1U);
    Transmission const& transmission = world.air.transmissions[0];
    EXPECT_EQ(transmission.emitters, kFront);
    EXPECT_EQ(transmission.message_bytes, 3 + 5);
    EXPECT_EQ(transmission.send_probability, 0.25F);
    EXPECT_EQ(transmission.range_mm, world.spec_of(0).ir.range_mm);
    EXPECT_EQ(std::memcmp(world.air.payload_of(transmission).data(), "hello", 5), 0);
    EXPECT_EQ(world.devices.messages_sent[0], 1U);
}

TEST(Infrared, MutedRobotCountsWhatItDoesNotSend) {
    World world = testing::world_with_robot();
    EXPECT_FALSE(is_muted_for_message(world, 0));
    world.devices.infrared[0].is_muted = 1;
    EXPECT_TRUE(is_muted_for_message(world, 0));
    EXPECT_TRUE(is_muted_for_message(world, 0));
    EXPECT_EQ(world.devices.infrared[0].muted_messages, 2U);
}

TEST(Infrared, ReceivedMessagesAreTheOldestFirstAndCounted) {
    World world = testing::world_with_robot();
    for (std::string_view const text : {"one", "two"}) {
        world.mailboxes.push(0, {.payload_length = 3}, bytes_of(text));
    }
    for (std::string_view const text : {"one", "two"}) {
        auto const message = receive(world, 0);
        ASSERT_TRUE(message);
        EXPECT_TRUE(std::ranges::equal(message->payload, bytes_of(text)));
    }
    EXPECT_FALSE(receive(world, 0));
    EXPECT_EQ(world.devices.messages_received[0], 2U);
}

TEST(Infrared, PacketThatDoesNotHaveTheLengthItSaysIsMalformed) {
    World world = testing::world_with_robot();
    message_short_header_t header = {};
    header._packet_type = ir_t_short;
    header.payload_length = 2;
    std::vector<std::byte> bytes(sizeof(header) + 2);
    std::memcpy(bytes.data(), &header, sizeof(header));
    EXPECT_EQ(composed_packet(world, 0, bytes, -1).kind, PacketKind::message);
    EXPECT_EQ(composed_packet(world, 0, bytes, 1).kind, PacketKind::malformed);
    bytes.pop_back();
    EXPECT_EQ(composed_packet(world, 0, bytes, -1).kind, PacketKind::malformed);
}

TEST(Infrared, RobotThatSendsAtEveryTickHasAChanceOfOne) {
    World world = testing::world_with_robot();
    float chance = 0.0F;
    for (int tick = 0; tick < 200; ++tick) {
        world.devices.clock_us[0] = 16000 * tick;
        chance = watched_send_probability(world, 0);
    }
    EXPECT_FLOAT_EQ(chance, 1.0F);
    for (int tick = 200; tick < 600; tick += 4) {
        world.devices.clock_us[0] = 16000 * tick;
        chance = watched_send_probability(world, 0);
    }
    EXPECT_NEAR(chance, 0.25F, 0.02F);
}

}  // namespace
}  // namespace pogosim
