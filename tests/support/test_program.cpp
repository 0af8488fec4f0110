#include "support/test_program.hpp"

extern "C" {
REGISTER_USERDATA(TestData)
}

namespace pogosim::testing {

std::function<void()> program_main;

}  // namespace pogosim::testing

extern "C" int robot_main() {
    if (pogosim::testing::program_main) {
        pogosim::testing::program_main();
    }
    return 0;
}
