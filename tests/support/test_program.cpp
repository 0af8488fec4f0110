#include "support/test_program.hpp"

extern "C" {
REGISTER_USERDATA(TestData)
}

namespace pogosim::testing {

std::function<void()> program_main;

}  // namespace pogosim::testing

extern "C" int robot_main() {
    // Callbacks of an earlier test must not live on.
    callback_global_setup = callback_create_data_schema = callback_global_step = nullptr;
    if (pogosim::testing::program_main) {
        pogosim::testing::program_main();
    }
    return 0;
}
