#include "firmware/library.hpp"

#include <vector>

namespace pogosim {

CallOutcome do_nothing(FirmwareCall& /*call*/) {
    return CallOutcome::returns;
}

std::span<LibraryFunction const> library_functions() {
    static std::vector<LibraryFunction> const all = [] {
        std::vector<LibraryFunction> joined;
        for (auto const part : {clock_functions(), console_functions(), device_functions(), flash_functions(),
                                helper_functions(), infrared_functions()}) {
            joined.insert(joined.end(), part.begin(), part.end());
        }
        return joined;
    }();
    return all;
}

}  // namespace pogosim
