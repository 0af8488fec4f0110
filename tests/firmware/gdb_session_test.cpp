#include "firmware/gdb_session.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "base/error.hpp"
#include "riscv/robot.hpp"

namespace {

using namespace pogosim;
using namespace pogosim::testing;
using enum Operation;

constexpr std::uint32_t kSum = 1024;       // address of a variable
constexpr std::uint32_t kLibrary = 24;     // address of a function of the library
constexpr std::uint64_t kPieceCycles = 7;  // of a robot's run, as between two steps

/// Adds 10 + 9 + ... + 1 up in memory; calls the library after each addition.
std::vector<std::uint32_t> program() {
    return {
        encode(addi, {.rd = 5, .immediate = 10}),
        encode(add, {.rd = 6, .rs1 = 6, .rs2 = 5}),          // 4
        encode(sw, {.rs2 = 6, .immediate = kSum}),           // 8
        encode(jal, {.rd = 1, .immediate = 12}),             // 12: calls kLibrary
        encode(addi, {.rd = 5, .rs1 = 5, .immediate = -1}),  // 16
        encode(bne, {.rs1 = 5, .immediate = -16}),           // 20
        encode(lw, {.rd = 7, .immediate = kSum}),            // 24: of the library
        encode(ebreak),
    };
}

/// A robot whose library returns at the second try, and ends when x5 is 0.
struct Swarm {
    Robot robot{program()};
    Code code = *robot.code;
    int calls = 0;

    Swarm() {
        intercept(code, kLibrary, 3);
        robot.core.x[1] = 1;
    }

    template <class Run>
    void live(Run const& run) {
        bool repeats = false;
        while (calls < 20) {
            Stop const stop = run(robot.core, robot.memory, code, kPieceCycles);
            if (stop.reason == StopReason::intercepted) {
                ++calls;
                repeats = !repeats;
                if (!repeats) {
                    robot.core.pc = robot.core.x[1];
                }
            } else if (stop.reason != StopReason::budget_used) {
                return;
            }
        }
    }
};

/// gdb's side.
class Peer {
public:
    explicit Peer(std::uint16_t port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        address.sin_port = htons(port);
        EXPECT_EQ(connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    }
    ~Peer() { close(socket_); }
    Peer(Peer const&) = delete;
    Peer& operator=(Peer const&) = delete;

    void send(std::string const& bytes) {
        EXPECT_EQ(::send(socket_, bytes.data(), bytes.size(), 0), std::ssize(bytes));
    }

    /// The contents of the next packet; "(gone)": there is none.
    std::string next() {
        for (char byte = 0; recv(socket_, &byte, 1, 0) == 1;) {
            GdbReader::Event event = reader_.take(byte);
            if (event.kind == GdbReader::Kind::packet) {
                return event.contents;
            }
        }
        return "(gone)";
    }
    std::string ask(std::string const& contents) {
        send(gdb_packet(contents));
        return next();
    }

private:
    int socket_;
    GdbReader reader_;
};

/// A swarm that lives in another thread, with gdb.
struct Debugged {
    Swarm swarm;
    std::unique_ptr<GdbSession> session = std::make_unique<GdbSession>(GdbRobot{.id = 3, .category = "robots"}, 0);
    Peer gdb{session->port()};
    std::thread thread{[this] {
        swarm.live([this](auto&... run) { return session->run(run...); });
        session.reset();
    }};

    ~Debugged() {
        if (thread.joinable()) {
            thread.join();
        }
    }
    void expect_same_end() {
        thread.join();
        Swarm alone;
        alone.live([](auto&... run) { return pogosim::run(run...); });
        EXPECT_EQ(swarm.robot.core, alone.robot.core);
        EXPECT_EQ(swarm.calls, alone.calls);
    }
};

TEST(GdbSession, RobotStopsAtBreakpointsAlsoInTheLibraryAndEndsAsWithoutGdb) {
    Debugged debugged;
    Peer& gdb = debugged.gdb;
    EXPECT_EQ(gdb.ask("?"), "T05thread:1;");
    EXPECT_EQ(gdb.ask("p20"), "00000000");
    EXPECT_EQ(gdb.ask("Z0,8,4"), "OK");
    EXPECT_EQ(gdb.ask("Z1,18,4"), "OK");
    for (int round = 0; round < 3; ++round) {
        EXPECT_EQ(gdb.ask("vCont;c"), "T05thread:1;");
        EXPECT_EQ(gdb.ask("p20"), "08000000");
        EXPECT_EQ(gdb.ask("vCont;c"), "T05thread:1;");
        EXPECT_EQ(gdb.ask("p20"), "18000000");
    }
    EXPECT_EQ(gdb.ask("m400,4"), "1b000000");  // 10 + 9 + 8
    EXPECT_EQ(gdb.ask("z0,8,4"), "OK");
    EXPECT_EQ(gdb.ask("z1,18,4"), "OK");
    EXPECT_EQ(gdb.ask("c"), "W00");
    debugged.expect_same_end();
}

TEST(GdbSession, CallOfTheLibraryIsOneStepThatReturns) {
    Debugged debugged;
    Peer& gdb = debugged.gdb;
    for (std::string const pc : {"04", "08", "0c", "18", "10", "14", "04"}) {
        EXPECT_EQ(gdb.ask("s"), "T05thread:1;");
        EXPECT_EQ(gdb.ask("p20"), pc + "000000");
    }
    EXPECT_EQ(gdb.ask("m18,4"), "67800000");  // ret, by which gdb knows where it goes on
    EXPECT_EQ(gdb.ask("vCont;r0,10:1"), "T05thread:1;");
    EXPECT_EQ(gdb.ask("p20"), "18000000");
    EXPECT_EQ(gdb.ask("c"), "W00");
    debugged.expect_same_end();
}

TEST(GdbSession, WatchpointsSeeWritesAndReads) {
    Debugged debugged;
    Peer& gdb = debugged.gdb;
    EXPECT_EQ(gdb.ask("Z2,400,4"), "OK");
    EXPECT_EQ(gdb.ask("c"), "T05thread:1;watch:400;");
    EXPECT_EQ(gdb.ask("p20"), "0c000000");
    EXPECT_EQ(gdb.ask("m400,4"), "0a000000");
    EXPECT_EQ(gdb.ask("c"), "T05thread:1;watch:400;");
    EXPECT_EQ(gdb.ask("m400,4"), "13000000");
    EXPECT_EQ(gdb.ask("z2,400,4"), "OK");
    EXPECT_EQ(gdb.ask("Z3,400,1"), "OK");  // only written to
    EXPECT_EQ(gdb.ask("Z4,400,2"), "OK");
    EXPECT_EQ(gdb.ask("c"), "T05thread:1;awatch:400;");
    EXPECT_EQ(gdb.ask("p20"), "0c000000");
    EXPECT_EQ(gdb.ask("z4,400,2"), "OK");
    EXPECT_EQ(gdb.ask("c"), "W00");
    debugged.expect_same_end();
}

TEST(GdbSession, InstructionThatAccessesNothingMeetsNoWatchpoint) {
    Debugged debugged;
    Peer& gdb = debugged.gdb;
    EXPECT_EQ(gdb.ask("Z4,800,8"), "OK");
    EXPECT_EQ(gdb.ask("P5=03080000"), "OK");  // the address that addi at 16 computes is watched
    EXPECT_EQ(gdb.ask("P20=10000000"), "OK");
    EXPECT_EQ(gdb.ask("s"), "T05thread:1;");
    EXPECT_EQ(gdb.ask("D"), "OK");
}

TEST(GdbSession, FaultIsShownAndCanBeMended) {
    Debugged debugged;
    Peer& gdb = debugged.gdb;
    EXPECT_EQ(gdb.ask("P20=00000090"), "OK");
    EXPECT_EQ(gdb.ask("c"), "T0bthread:1;");
    EXPECT_EQ(gdb.ask("P20=00000000"), "OK");
    EXPECT_EQ(gdb.ask("s"), "T05thread:1;");
    EXPECT_EQ(gdb.ask("P20=1c000000"), "OK");
    EXPECT_EQ(gdb.ask("c"), "T05thread:1;");  // ebreak
    EXPECT_EQ(gdb.ask("c"), "X05");
}

TEST(GdbSession, CodeIsNotWritten) {
    Debugged debugged;
    Peer& gdb = debugged.gdb;
    EXPECT_EQ(gdb.ask("M0,4:00000000"), "E0e");
    EXPECT_EQ(gdb.ask("M400,4:00000000"), "OK");
    EXPECT_EQ(gdb.ask("c"), "W00");
}

TEST(GdbSession, RunGoesOnWithoutGdb) {
    {
        Debugged debugged;
        EXPECT_EQ(debugged.gdb.ask("Z0,8,4"), "OK");
        EXPECT_EQ(debugged.gdb.ask("D"), "OK");
        EXPECT_EQ(debugged.gdb.next(), "(gone)");
        debugged.expect_same_end();
    }
    Swarm swarm;
    GdbSession session({}, 0);
    auto lost = std::make_unique<Peer>(session.port());
    lost->send("$Z0,8,4#");
    lost.reset();
    swarm.live([&](auto&... run) { return session.run(run...); });
    EXPECT_EQ(swarm.calls, 20);
}

TEST(GdbSession, InterruptEndsTheWait) {
    int looks = 0;
    GdbRobot robot;
    robot.interrupted = [&] { return ++looks > 2; };
    GdbSession session(robot, 0);
    Swarm swarm;
    swarm.live([&](auto&... run) { return session.run(run...); });
    EXPECT_EQ(swarm.calls, 20);
}

TEST(GdbSession, OnlyOneDebuggerConnects) {
    Debugged debugged;
    EXPECT_EQ(debugged.gdb.ask("qC"), "QC1");
    Peer other(debugged.session->port());
    EXPECT_EQ(other.next(), "(gone)");
    EXPECT_EQ(debugged.gdb.ask("k"), "(gone)");
}

TEST(GdbServer, PortsThatCannotBeUsedAreRefused) {
    GdbServer const first(0);
    try {
        GdbServer const second(first.port());
        FAIL();
    } catch (ConfigError const& error) {
        EXPECT_EQ(std::string(error.what()), "--gdb: port " + std::to_string(first.port()) +
                                                 " is in use; choose another one, or 0 for one that is free");
    }
    EXPECT_THROW(GdbServer(65536), ConfigError);
    EXPECT_THROW(GdbServer(-1), ConfigError);
}

}  // namespace
