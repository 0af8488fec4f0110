#include "firmware/gdb_server.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string>

#include "base/error.hpp"

namespace pogosim {

namespace {

constexpr int kHighestPort = 65535;
constexpr int kLongestSendMs = 5000;
constexpr int kLongestEndMs = 250;
constexpr int kWaitMs = 50;

#ifdef MSG_NOSIGNAL
constexpr int kSendFlags = MSG_NOSIGNAL;
#else
constexpr int kSendFlags = 0;  // the run ignores SIGPIPE
#endif

/// Not for programs that this process starts; and reading and writing do not wait.
void set_up(int socket) {
    fcntl(socket, F_SETFD, FD_CLOEXEC);
    fcntl(socket, F_SETFL, fcntl(socket, F_GETFL) | O_NONBLOCK);
}

bool would_block(int error) {
    return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

std::string text_of(int error, int port) {
    if (error == EADDRINUSE) {
        return fmt::format("--gdb: port {} is in use; choose another one, or 0 for one that is free", port);
    }
    return fmt::format("--gdb: cannot listen on port {}: {}; choose another one, or 0 for one that is free", port,
                       std::strerror(error));
}

}  // namespace

GdbServer::GdbServer(int port) {
    if (port < 0 || port > kHighestPort) {
        throw ConfigError(fmt::format("--gdb: expected a port from 0 to {}, found {}", kHighestPort, port));
    }
    listener_ = socket(AF_INET, SOCK_STREAM, 0);
    int const yes = 1;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    socklen_t length = sizeof(address);
    bool const listens = listener_ >= 0 &&
                         // The port of a run that has just ended can be used again.
                         setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes)) == 0 &&
                         bind(listener_, reinterpret_cast<sockaddr*>(&address), length) == 0 &&
                         listen(listener_, 1) == 0 &&
                         getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &length) == 0;
    if (!listens) {
        int const error = errno;
        if (listener_ >= 0) {
            close(listener_);
        }
        throw ConfigError(text_of(error, port));
    }
    set_up(listener_);
    port_ = ntohs(address.sin_port);
}

GdbServer::~GdbServer() {
    close_peer();
    close(listener_);
}

void GdbServer::close_peer() {
    if (peer_ >= 0) {
        close(peer_);
        peer_ = -1;
    }
}

void GdbServer::accept_peer() {
    int const socket = accept(listener_, nullptr, nullptr);
    if (socket < 0) {
        return;
    }
    if (has_peer()) {
        close(socket);
        return;
    }
    set_up(socket);
    // Packets are small, and each waits for an answer.
    int const yes = 1;
    setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
    peer_ = socket;
}

void GdbServer::wait(int milliseconds) {
    std::array<pollfd, 2> sockets{pollfd{listener_, POLLIN, 0}, pollfd{peer_, POLLIN, 0}};
    if (poll(sockets.data(), sockets.size(), milliseconds) > 0 && sockets[0].revents != 0) {
        accept_peer();
    }
}

std::string GdbServer::receive() {
    std::array<char, 4096> bytes;
    if (!has_peer()) {
        return "";
    }
    ssize_t const count = recv(peer_, bytes.data(), bytes.size(), 0);
    if (count > 0) {
        return {bytes.data(), static_cast<std::size_t>(count)};
    }
    if (count == 0 || !would_block(errno)) {
        close_peer();
    }
    return "";
}

void GdbServer::send(std::string_view bytes) {
    while (has_peer() && !bytes.empty()) {
        ssize_t const count = ::send(peer_, bytes.data(), bytes.size(), kSendFlags);
        if (count >= 0) {
            bytes.remove_prefix(static_cast<std::size_t>(count));
            continue;
        }
        pollfd writable{peer_, POLLOUT, 0};
        if (!would_block(errno) || poll(&writable, 1, kLongestSendMs) == 0) {
            close_peer();
        }
    }
}

void GdbServer::send_last(std::string_view bytes) {
    send(bytes);
    if (has_peer()) {
        shutdown(peer_, SHUT_WR);
    }
    // Closing a socket with bytes that were not read could cost the peer what it has not read.
    for (int waited_ms = 0; waited_ms < kLongestEndMs && has_peer(); waited_ms += kWaitMs) {
        pollfd readable{peer_, POLLIN, 0};
        poll(&readable, 1, kWaitMs);
        receive();
    }
    close_peer();
}

}  // namespace pogosim
