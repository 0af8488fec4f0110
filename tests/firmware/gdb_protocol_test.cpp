#include "firmware/gdb_protocol.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace pogosim;
using Kind = GdbReader::Kind;

constexpr std::uint32_t kFirst = 0x1000;  // address of the memory
constexpr std::uint32_t kBytes = 256;

/// A robot that only notes what it is asked for.
struct NotingTarget final : GdbTarget {
    std::array<std::uint32_t, kGdbRegisters> registers{};
    std::array<std::byte, kBytes> memory{};
    std::vector<GdbPoint> points;
    std::vector<GdbResume> resumed;
    GdbStop stop;
    bool has_left = false;
    bool is_killed = false;

    std::uint32_t read_register(std::size_t number) const override { return registers.at(number); }
    void write_register(std::size_t number, std::uint32_t value) override { registers.at(number) = value; }
    std::size_t read_memory(std::uint32_t address, std::span<std::byte> bytes) const override {
        if (address < kFirst || address >= kFirst + kBytes) {
            return 0;
        }
        std::size_t const count = std::min<std::size_t>(bytes.size(), kFirst + kBytes - address);
        std::copy_n(memory.begin() + (address - kFirst), count, bytes.begin());
        return count;
    }
    bool write_memory(std::uint32_t address, std::span<std::byte const> bytes) override {
        if (address < kFirst || std::uint64_t{address} + bytes.size() > kFirst + kBytes) {
            return false;
        }
        std::ranges::copy(bytes, memory.begin() + (address - kFirst));
        return true;
    }
    bool insert(GdbPoint const& point) override {
        points.push_back(point);
        return points.size() < 100;
    }
    void remove(GdbPoint const& point) override { std::erase(points, point); }
    GdbStop stopped() const override { return stop; }
    void resume(GdbResume const& how) override { resumed.push_back(how); }
    void detach() override { has_left = true; }
    void kill() override { is_killed = true; }
    std::string monitor(std::string_view command) const override { return command == "time" ? "t = 1 s\n" : ""; }
};

/// A connection in which gdb no longer acknowledges.
struct Connection {
    NotingTarget target;
    GdbReader reader;
    GdbProtocol protocol{target};

    Connection() { send(gdb_packet("QStartNoAckMode")); }

    std::string send(std::string_view bytes) {
        std::string answers;
        for (char const byte : bytes) {
            answers += protocol.answer(reader.take(byte));
        }
        return answers;
    }
    /// The contents of the answer; "(none)": there is none.
    std::string ask(std::string_view contents) {
        std::string const answer = send(gdb_packet(contents));
        return answer.empty() ? "(none)" : answer.substr(1, answer.size() - 4);
    }
};

std::vector<GdbReader::Event> read(std::string_view bytes) {
    GdbReader reader;
    std::vector<GdbReader::Event> events;
    for (char const byte : bytes) {
        GdbReader::Event event = reader.take(byte);
        if (event.kind != Kind::none) {
            events.push_back(std::move(event));
        }
    }
    return events;
}

TEST(GdbProtocol, ChecksumIsTheSumOfTheBytes) {
    EXPECT_EQ(gdb_packet(""), "$#00");
    EXPECT_EQ(gdb_packet("OK"), "$OK#9a");
    EXPECT_EQ(gdb_packet("vMustReplyEmpty"), "$vMustReplyEmpty#3a");
}

TEST(GdbProtocol, EscapedBytesComeBack) {
    EXPECT_EQ(gdb_escaped("a#$}*"), "a}\x03}\x04}]}\x0a");
    std::string all;
    for (int byte = 0; byte < 256; ++byte) {
        all += static_cast<char>(byte);
    }
    EXPECT_EQ(gdb_unescaped(gdb_escaped(all)), all);
    EXPECT_EQ(gdb_unescaped("a}"), "a");
}

TEST(GdbProtocol, PacketsAreFoundBetweenOtherBytes) {
    auto const events = read("+x$g#67-\x03$m0,4#fd$OK#00");
    ASSERT_EQ(events.size(), 6U);
    EXPECT_EQ(events[0].kind, Kind::acknowledged);
    EXPECT_EQ(events[1].contents, "g");
    EXPECT_EQ(events[2].kind, Kind::repeat);
    EXPECT_EQ(events[3].kind, Kind::interrupt);
    EXPECT_EQ(events[4].contents, "m0,4");
    EXPECT_EQ(events[5].kind, Kind::broken);
}

TEST(GdbProtocol, PacketWithoutAnEndIsLostAndTheNextIsFound) {
    auto const events = read("$m0,$g#67");
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].contents, "g");
}

TEST(GdbProtocol, LongestPacketIsReadAndALongerOneIsBroken) {
    std::string const longest(kGdbPacketBytes, 'a');
    EXPECT_EQ(read(gdb_packet(longest)).at(0).contents, longest);
    auto const events = read(gdb_packet(longest + "a") + "$g#67");
    EXPECT_EQ(events.at(0).kind, Kind::broken);
    EXPECT_EQ(events.at(1).contents, "g");
}

TEST(GdbProtocol, PacketsAreAcknowledgedUntilGdbSaysOtherwise) {
    NotingTarget target;
    GdbProtocol protocol(target);
    EXPECT_EQ(protocol.answer({Kind::packet, "qC"}), "+$QC1#c5");
    EXPECT_EQ(protocol.answer({Kind::repeat}), "$QC1#c5");
    EXPECT_EQ(protocol.answer({Kind::broken}), "-");
    EXPECT_EQ(protocol.answer({Kind::acknowledged}), "");
    EXPECT_EQ(protocol.answer({Kind::packet, "QStartNoAckMode"}), "+$OK#9a");
    EXPECT_EQ(protocol.answer({Kind::packet, "qC"}), "$QC1#c5");
    EXPECT_EQ(protocol.answer({Kind::broken}), "");
}

TEST(GdbProtocol, RegistersAreLittleEndianAndPcIsTheLast) {
    Connection gdb;
    gdb.target.registers[1] = 0x12345678;
    gdb.target.registers[kGdbProgramCounter] = 0xa0;
    std::string const all = gdb.ask("g");
    ASSERT_EQ(all.size(), 8 * kGdbRegisters);
    EXPECT_EQ(all.substr(8, 8), "78563412");
    EXPECT_EQ(all.substr(8 * kGdbProgramCounter), "a0000000");
    EXPECT_EQ(gdb.ask("p20"), "a0000000");
    EXPECT_EQ(gdb.ask("p21"), "E16");
    EXPECT_EQ(gdb.ask("P2=01020304"), "OK");
    EXPECT_EQ(gdb.target.registers[2], 0x04030201U);
    EXPECT_EQ(gdb.ask("P2=0102030"), "E16");
    EXPECT_EQ(gdb.ask("P21=01020304"), "E16");
    EXPECT_EQ(gdb.ask("G" + std::string(8 * kGdbRegisters, '1')), "OK");
    EXPECT_EQ(gdb.target.registers[31], 0x11111111U);
    EXPECT_EQ(gdb.ask("G1111"), "E16");
}

TEST(GdbProtocol, MemoryIsReadAsFarAsThereIsAny) {
    Connection gdb;
    gdb.target.memory[0] = std::byte{0xab};
    EXPECT_EQ(gdb.ask("m1000,2"), "ab00");
    EXPECT_EQ(gdb.ask("m10fe,10"), "0000");
    EXPECT_EQ(gdb.ask("m1100,1"), "E01");
    EXPECT_EQ(gdb.ask("m0,ffffffff"), "E01");
    EXPECT_EQ(gdb.ask("mffffffff,2"), "E16");
    EXPECT_EQ(gdb.ask("m1000"), "E16");
    EXPECT_EQ(gdb.ask("m1000,"), "E16");
    EXPECT_EQ(gdb.ask("m-1,1"), "E16");
    EXPECT_EQ(gdb.ask("m123456789,1"), "E16");
}

TEST(GdbProtocol, MemoryIsWrittenInHexadecimalAndInBytes) {
    Connection gdb;
    EXPECT_EQ(gdb.ask("M1001,2:0aff"), "OK");
    EXPECT_EQ(gdb.ask("m1000,4"), "000aff00");
    EXPECT_EQ(gdb.ask("X1000,3:" + gdb_escaped("a#}")), "OK");
    EXPECT_EQ(gdb.ask("m1000,4"), "61237d00");
    EXPECT_EQ(gdb.ask("X1000,0:"), "OK");  // by which gdb finds out that X is known
    EXPECT_EQ(gdb.ask("M10ff,2:0000"), "E0e");
    EXPECT_EQ(gdb.ask("M1000,2:00"), "E16");
    EXPECT_EQ(gdb.ask("M1000,1:0g"), "E16");
    EXPECT_EQ(gdb.ask("M1000,1"), "E16");
}

TEST(GdbProtocol, PointsOfEachKindComeAndGo) {
    Connection gdb;
    EXPECT_EQ(gdb.ask("Z0,1000,4"), "OK");
    EXPECT_EQ(gdb.ask("Z1,1004,4"), "OK");
    EXPECT_EQ(gdb.ask("Z2,1008,8"), "OK");
    EXPECT_EQ(gdb.ask("Z3,1008,1"), "OK");
    EXPECT_EQ(gdb.ask("Z4,1008,1"), "OK");
    ASSERT_EQ(gdb.target.points.size(), 5U);
    EXPECT_EQ(gdb.target.points[2], (GdbPoint{GdbPointKind::write, 0x1008, 8}));
    EXPECT_EQ(gdb.ask("z0,1000,4"), "OK");
    EXPECT_EQ(gdb.target.points.size(), 4U);
    EXPECT_EQ(gdb.ask("Z5,1000,4"), "");
    EXPECT_EQ(gdb.ask("Z2,1000,0"), "E16");
    EXPECT_EQ(gdb.ask("Z2,1000,ffffff"), "E16");
    EXPECT_EQ(gdb.ask("Z0"), "E16");
    EXPECT_EQ(gdb.ask("Z0,,"), "E16");
}

TEST(GdbProtocol, RobotGoesOnAndTheAnswerComesWhenItStops) {
    Connection gdb;
    EXPECT_EQ(gdb.ask("?"), "T05thread:1;");
    EXPECT_EQ(gdb.ask("c"), "(none)");
    EXPECT_EQ(gdb.ask("s"), "(none)");
    EXPECT_EQ(gdb.ask("vCont;c"), "(none)");
    EXPECT_EQ(gdb.ask("vCont;s:1;c"), "(none)");
    EXPECT_EQ(gdb.ask("vCont;S05:1"), "(none)");
    EXPECT_EQ(gdb.ask("vCont;r100,110:1;c"), "(none)");
    GdbResume const go_on{};
    GdbResume const step{.is_step = true};
    GdbResume const range{.is_step = true, .first = 0x100, .last = 0x110};
    EXPECT_EQ(gdb.target.resumed, (std::vector{go_on, step, go_on, step, step, range}));
    EXPECT_EQ(gdb.ask("c1234"), "(none)");
    EXPECT_EQ(gdb.target.registers[kGdbProgramCounter], 0x1234U);
    EXPECT_EQ(gdb.ask("S05;1238"), "(none)");
    EXPECT_EQ(gdb.target.registers[kGdbProgramCounter], 0x1238U);
    for (char const* wrong : {"cxy", "C", "vCont;", "vCont;x", "vCont;cc", "vCont;r1", "vCont;C"}) {
        EXPECT_EQ(gdb.ask(wrong), "E16") << wrong;
    }
    gdb.target.stop = {GdbSignal::trap, GdbPoint{GdbPointKind::write, 0x1008, 4}};
    EXPECT_EQ(gdb.protocol.stop_reply(), gdb_packet("T05thread:1;watch:1008;"));
    gdb.target.stop = {GdbSignal::segmentation};
    EXPECT_EQ(gdb.protocol.stop_reply(), gdb_packet("T0bthread:1;"));
    EXPECT_EQ(gdb.protocol.exit_reply({}), gdb_packet("W00"));
    EXPECT_EQ(gdb.protocol.exit_reply(GdbSignal::segmentation), gdb_packet("X0b"));
}

TEST(GdbProtocol, DescriptionOfRegistersComesInParts) {
    Connection gdb;
    EXPECT_NE(gdb.ask("qSupported:swbreak+;xmlRegisters=i386").find("qXfer:features:read+"), std::string::npos);
    std::string description;
    for (std::string part = "m"; part[0] == 'm';) {
        part = gdb.ask("qXfer:features:read:target.xml:" + [&] {
            std::array<char, 20> text{};
            std::snprintf(text.data(), text.size(), "%zx,100", description.size());
            return std::string(text.data());
        }());
        ASSERT_FALSE(part.empty());
        description += gdb_unescaped(part).substr(1);
    }
    EXPECT_NE(description.find("<architecture>riscv:rv32</architecture>"), std::string::npos);
    EXPECT_NE(description.find("<reg name=\"x31\" bitsize=\"32\""), std::string::npos);
    EXPECT_TRUE(description.ends_with("</target>\n"));
    EXPECT_EQ(gdb.ask("qXfer:features:read:other.xml:0,100"), "E00");
    EXPECT_EQ(gdb.ask("qXfer:features:read:target.xml:ffffff,1"), "E16");
    EXPECT_EQ(gdb.ask("qXfer:features:read:target.xml"), "E16");
}

TEST(GdbProtocol, ThereIsOneThread) {
    Connection gdb;
    EXPECT_EQ(gdb.ask("qfThreadInfo"), "m1");
    EXPECT_EQ(gdb.ask("qsThreadInfo"), "l");
    EXPECT_EQ(gdb.ask("qC"), "QC1");
    EXPECT_EQ(gdb.ask("Hg0"), "OK");
    EXPECT_EQ(gdb.ask("T1"), "OK");
    EXPECT_EQ(gdb.ask("qAttached:1"), "1");
    EXPECT_EQ(gdb.ask("vCont?"), "vCont;c;C;s;S;r");
}

TEST(GdbProtocol, MonitorCommandsAnswerInText) {
    Connection gdb;
    EXPECT_EQ(gdb.ask("qRcmd,74696d65"), "74203d203120730a");  // "time", "t = 1 s\n"
    EXPECT_EQ(gdb.ask("qRcmd,7"), "E16");
    EXPECT_TRUE(gdb.ask("qRcmd,78").starts_with("5468657265206973206e6f"));  // "There is no"
}

TEST(GdbProtocol, GdbLeavesOrEndsTheRun) {
    Connection gdb;
    EXPECT_EQ(gdb.ask("D;1"), "OK");
    EXPECT_TRUE(gdb.target.has_left);
    EXPECT_EQ(gdb.ask("k"), "(none)");
    EXPECT_TRUE(gdb.target.is_killed);
}

TEST(GdbProtocol, UnknownPacketsGetTheEmptyAnswer) {
    Connection gdb;
    for (char const* unknown : {"", "!", "vMustReplyEmpty", "qOffsets", "qSymbol::", "R00", "x1000,4", "QNonStop:0"}) {
        EXPECT_EQ(gdb.ask(unknown), "") << unknown;
    }
}

// Random packets, and valid ones with bytes changed, inserted and left out. What is looked at is that the answer is
// well-formed and not too long; sanitizers see the rest.
TEST(GdbProtocol, AnyBytesAreAnsweredOrIgnored) {
    std::array<std::string, 22> const valid{"qSupported:swbreak+",
                                            "g",
                                            "p20",
                                            "P2=01020304",
                                            "m1000,20",
                                            "M1001,2:0aff",
                                            "X1000,3:abc",
                                            "Z0,1000,4",
                                            "z0,1000,4",
                                            "Z2,1008,8",
                                            "c1000",
                                            "S05;1238",
                                            "vCont?",
                                            "vCont;s:1;c",
                                            "vCont;r100,110:1",
                                            "Hg0",
                                            "qXfer:features:read:target.xml:0,100",
                                            "qRcmd,74696d65",
                                            "D;1",
                                            "k",
                                            "?",
                                            "G" + std::string(264, '1')};
    std::mt19937 random(1);
    auto const below = [&](std::size_t count) { return static_cast<std::size_t>(random()) % count; };
    auto const any_byte = [&] { return static_cast<char>(random() & 0xffU); };
    Connection gdb;
    std::size_t answered = 0;
    for (int i = 0; i < 100'000; ++i) {
        std::string contents;
        if (i % 3 == 0) {
            contents.resize(below(40));
            std::ranges::generate(contents, any_byte);
        } else {
            contents = valid[below(valid.size())];
            for (std::size_t changes = below(4); changes > 0; --changes) {
                std::size_t const at = below(contents.size() + 1);
                switch (below(3)) {
                    case 0:
                        contents.insert(at, 1, any_byte());
                        break;
                    case 1:
                        contents.erase(at, 1 + below(3));
                        break;
                    default:
                        if (at < contents.size()) {
                            contents[at] = any_byte();
                        }
                }
            }
        }
        std::string bytes = gdb_packet(contents);
        if (i % 10 == 0) {
            bytes[below(bytes.size())] = any_byte();
        }
        std::string const answers = gdb.send(bytes);
        for (GdbReader::Event const& event : read(answers)) {
            ASSERT_EQ(event.kind, Kind::packet) << answers;
            ASSERT_LE(event.contents.size(), kGdbPacketBytes);
            ++answered;
        }
        gdb.target.points.resize(std::min<std::size_t>(gdb.target.points.size(), 50));
        gdb.target.resumed.clear();
    }
    EXPECT_GT(answered, 50'000U);
    gdb.send("#00#00");  // whatever was begun
    EXPECT_EQ(gdb.ask("qC"), "QC1");
}

}  // namespace
