// What a firmware calls to start, and to know which robot it is on.
#include <array>
#include <cstdint>
#include <string>

#include "firmware/firmware_call.hpp"
#include "interface/pogobase_inside.hpp"

namespace pogosim {

namespace {

CallOutcome get_id(FirmwareCall& call) {
    call.give(id_on_air(call.world.robots.id[call.robot]));
    return CallOutcome::returns;
}

CallOutcome get_random_seed(FirmwareCall& call) {
    call.give_signed(call.self.seeds.next());
    return CallOutcome::returns;
}

CallOutcome print_version(FirmwareCall& call) {
    call.out.said.push_back(
        {.robot = call.robot, .text = call.self.printed + " Pogolib Version : " POGOLIB_RELEASE_VERSION});
    call.self.printed.clear();
    return CallOutcome::returns;
}

CallOutcome draw(FirmwareCall& call) {
    call.give_signed(random_number(call.self.random));
    return CallOutcome::returns;
}

CallOutcome set_seed(FirmwareCall& call) {
    call.self.random = stream_of_seed(call.argument(0));
    return CallOutcome::returns;
}

CallOutcome end(FirmwareCall& /*call*/) {
    return CallOutcome::ends;
}

}  // namespace

std::span<LibraryFunction const> helper_functions() {
    static std::array const functions{
        LibraryFunction{"pogobot_init", do_nothing},
        LibraryFunction{"pogobot_helper_getid", get_id},
        LibraryFunction{"pogobot_helper_getRandSeed", get_random_seed},
        LibraryFunction{"pogobot_helper_print_version", print_version},
        LibraryFunction{.name = "rand", .call = draw, .is_random = true},
        LibraryFunction{.name = "srand", .call = set_seed, .is_random = true},
        LibraryFunction{"_exit", end},
    };
    return functions;
}

}  // namespace pogosim
