// ffmpeg as a child process that is fed through its standard input.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace pogosim {

class FilmProcess {
public:
    /// Starts ffmpeg, found in PATH, with these arguments, in a process group of its own: Ctrl-C in the terminal does
    /// not reach it, so that it can end the film well. Throws FileError if it cannot be started.
    explicit FilmProcess(std::vector<std::string> const& arguments);

    /// Ends it as finish() does.
    ~FilmProcess();

    FilmProcess(FilmProcess const&) = delete;
    FilmProcess& operator=(FilmProcess const&) = delete;

    /// Waits until ffmpeg has taken the bytes. False if it no longer reads, or has taken none for 20 s.
    bool write(std::span<std::byte const> bytes);

    /// Closes its input and waits for its end. True if it ended well. Further calls do nothing.
    bool finish();

    /// What it has printed so far, or why it was stopped.
    std::string output() const;

private:
    void spawn(std::vector<std::string> const& arguments, int input);
    void close_input();
    void stop(char const* why);

    pid_t process_ = -1;
    int input_ = -1;   // our end of the pipe
    int output_ = -1;  // a file without a name
    bool has_succeeded_ = false;
    std::string reason_;  // why it was stopped
};

}  // namespace pogosim
