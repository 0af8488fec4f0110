// User errors, each with one message. Thrown while a run is being set up; nothing is thrown through C code.
#pragma once

#include <stdexcept>
#include <string>

namespace pogosim {

/// A mistake in a configuration, an arena file or the command line: what, where, what was expected, what to do.
/// The program ends with exit code 2.
class ConfigError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The data file (or another output) cannot be written. The program ends with exit code 2.
class OutputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace pogosim
