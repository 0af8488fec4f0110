// Large allocations: when one fails, the message says what it was for and how large it was.
#pragma once

#include <new>
#include <optional>
#include <stdexcept>
#include <string>

namespace pogosim {

/// Not enough memory; the message names the purpose and the size. The program ends with exit code 2.
class OutOfMemory : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Throws OutOfMemory: "not enough memory for the light map: 10000 x 10000 cells of 2 bytes, 190.7 MiB; ...".
[[noreturn]] void fail_for_memory(std::string const& purpose, std::optional<double> bytes);

/// Bytes that this process has allocated and not freed, also on other threads; 0 if the C library does not say.
std::size_t allocated_bytes();

/// The message if it is unknown which allocation failed.
inline constexpr auto kOutOfMemory =
    "not enough memory; free some, or raise this run's memory limit (ulimit -v, or the batch system's)";

/// Returns allocate(). If there is not enough memory for it, throws OutOfMemory with purpose(), a string such as "the
/// light map: 10000 x 10000 cells of 2 bytes", and with the size, if known.
template <class Purpose, class Allocate>
decltype(auto) allocate_for(Purpose const& purpose, std::optional<double> bytes, Allocate const& allocate) {
    try {
        return allocate();
    } catch (std::bad_alloc const&) {
        fail_for_memory(purpose(), bytes);
    } catch (std::length_error const&) {  // more than any machine has
        fail_for_memory(purpose(), bytes);
    }
}

}  // namespace pogosim
