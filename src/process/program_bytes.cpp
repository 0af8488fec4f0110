#include "process/program_bytes.hpp"

namespace pogosim {

POGOSIM_SEES_ALL_BYTES void copy_program_bytes(std::byte* to, std::byte const* from, std::size_t count) {
    auto volatile* const target = to;  // else compilers call memcpy(), which a sanitizer replaces with its own
    for (std::size_t i = 0; i < count; ++i) {
        target[i] = from[i];
    }
}

}  // namespace pogosim
