#include "app/process_copies.hpp"

#include <filesystem>
#include <iterator>
#include <system_error>

namespace pogosim {

std::ptrdiff_t count_entries(char const* folder) {
    std::error_code error;
    auto const entries = std::filesystem::directory_iterator(folder, error);
    return error ? 0 : std::distance(begin(entries), end(entries));
}

}  // namespace pogosim
