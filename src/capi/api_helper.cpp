// pogolib/helper.h, and what the program's part of the simulator (src/program) makes of functions of the C library:
// rand() and srand() draw from the robot's own stream, as they do on real robots, and exit() ends the run so
// that its data file is complete.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "device/battery.hpp"
#include "device/chips.hpp"
#include "device/random_seeds.hpp"
#include "pogosim/program.h"
#include "process/crash_handler.hpp"
#include "process/crash_message.hpp"
#include "process/process.hpp"
#include "robot/call_checks.hpp"
#include "robot/context.hpp"

using pogosim::context;
using pogosim::require_robot;

namespace {

/// The stream for calls outside user code, from a library that calls rand().
pogosim::RandomStream& outside_stream() {
    static thread_local pogosim::RandomStream stream = pogosim::stream_of_seed(1);
    return stream;
}

pogosim::RandomStream& current_stream() {
    return context.controller != nullptr ? context.controller->random : outside_stream();
}

}  // namespace

int pogosim_rand() {
    static_assert(RAND_MAX == 0x7fffffff);
    return pogosim::random_number(current_stream());
}

void pogosim_srand(unsigned seed) {
    current_stream() = pogosim::stream_of_seed(seed);
    if (context.controller != nullptr) {
        context.controller->program.seed = seed;
    }
}

void pogosim_exit(int status) {
    constexpr int kCallees = 1;  // exit() in program.c
    char what[32];
    std::snprintf(what, sizeof(what), "called exit(%d)", status);
    auto const code = static_cast<pogosim::ExitCode>(status & 0xFF);
    if (pogosim::is_forked_child()) {
        pogosim::end_forked_child(status);
    }
    if (pogosim::inside_user_code()) {
        pogosim::leave_user_code(what, code, kCallees);
    }
    if (pogosim::is_other_thread_of_run()) {
        pogosim::end_run_from_thread(what, code, nullptr, kCallees);
    }
    if (pogosim::run_stage() == pogosim::RunStage::before_main) {
        std::fprintf(stderr, "pogosim: the user program %s before main(). The run did not start.\n", what);
    }
    std::exit(status);
}

void pogobot_init() {
    if (context.controller == nullptr) {
        return;  // before main(), in a static constructor
    }
    pogosim::Program& program = context.controller->program;
    if (program.registered && context.phase == pogosim::Phase::main) {
        context.services->warn_once(
            "pogobot_init() is called after pogobot_start(), which never returns on a real robot: call it first");
    }
    program.prepared = true;
}

uint16_t pogobot_helper_getid() {
    require_robot(__func__);
    return context.has_robot() ? pogosim::id_on_air(context.world->robots.id[context.robot]) : uint16_t{0};
}

int16_t pogobot_helper_getRandSeed() {
    require_robot(__func__);
    return context.controller->seeds.next();
}

void pogobot_helper_print_version() {
    pogosim_printf(" Pogolib Version : %s\n", POGOLIB_RELEASE_VERSION);
}

int16_t pogobot_battery_voltage_read() {
    if (!context.has_robot()) {
        return pogosim::voltmeter_mv(pogosim::kFullBatteryMv, pogosim::SensorModel::ideal);
    }
    return pogosim::battery_voltage_mv(*context.world, context.robot);
}
