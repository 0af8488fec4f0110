// The socket on which gdb connects to a robot: of this machine only (127.0.0.1), for one debugger at a time.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pogosim {

class GdbServer {
public:
    /// Listens on a port from 0 to 65535; 0 is one that is free. Throws ConfigError, which begins with "--gdb", for
    /// other numbers, and if the port is in use or not allowed.
    explicit GdbServer(int port);
    ~GdbServer();
    GdbServer(GdbServer const&) = delete;
    GdbServer& operator=(GdbServer const&) = delete;

    std::uint16_t port() const { return port_; }
    bool has_peer() const { return peer_ >= 0; }

    /// Waits up to so many milliseconds for a debugger to connect, if there is none, else for bytes of it. While one
    /// is connected, others are turned away. May return earlier, such as at a signal.
    void wait(int milliseconds);

    /// The bytes that have come, a few KiB at most; does not wait. A peer that has gone is none any more.
    std::string receive();

    /// Sends all, or loses the peer: it has gone, or has taken nothing for some seconds.
    void send(std::string_view bytes);

    void close_peer();

    /// Sends the last bytes of the run, and gives the peer a moment to read them.
    void send_last(std::string_view bytes);

private:
    void accept_peer();

    int listener_ = -1;
    int peer_ = -1;
    std::uint16_t port_ = 0;
};

}  // namespace pogosim
