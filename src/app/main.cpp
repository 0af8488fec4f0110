// The program's real main(). The user's main(), renamed robot_main, is called once for each robot.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <utility>

#include "app/command_line.hpp"
#include "base/error.hpp"
#include "base/escaped.hpp"
#include "base/log.hpp"
#include "base/memory.hpp"
#include "config/scenario.hpp"
#include "robot/forked_child.hpp"
#include "robot/last_words.hpp"
#include "sim/interrupt.hpp"
#include "sim/simulation.hpp"
#include "sim/used_files.hpp"

namespace {

using namespace pogosim;

ExitCode simulate(CommandLine const& options) {
    ignore_broken_outputs();
    // Until the configuration is read, the console follows the command line.
    LogOptions logging;
    logging.verbose = options.verbose;
    logging.quiet = options.quiet;
    logging.show_robot_lines = !options.hide_robot_lines;
    start_logging(logging);

    Scenario scenario = load_scenario(options.config, {.overrides = options.overrides, .strict = options.strict});
    if (options.seed) {
        scenario.seed = options.seed;
    }
    check_used_files(scenario, options.config);
    logging.minimal = scenario.output.log_format == LogFormat::minimal;
    if (scenario.output.enable_console_logging) {
        logging.file = scenario.output.console_filename;
    }
    start_logging(logging);

    if (scenario.view.gui && !options.no_gui) {
        log().info("this version has no window yet; running without one");
    }
    if (scenario.view.save_video_period_s > 0.0) {
        log().info("this version does not draw frames yet (save_video_period)");
    }

    Simulation simulation(std::move(scenario), {.progress_bar = options.progress_bar, .strict = options.strict});
    return simulation.run();
}

/// Prints an error. Returns the exit code of a run that would otherwise have ended with `code`.
ExitCode report(char const* error, ExitCode code) {
    flush_logs();
    std::fprintf(stderr, "Error: %s\n", error);
    return code == ExitCode::done ? ExitCode::usage : code;
}

/// Destructors of libraries may crash when memory is short.
[[noreturn]] void end_short_of_memory(char const* error) {
    ExitCode const code = report(error, ExitCode::usage);
    std::fflush(nullptr);
    std::_Exit(static_cast<int>(code));
}

}  // namespace

/// Before the constructors of the program, which may take for ever, or set handlers of their own.
__attribute__((constructor)) static void catch_interrupts_from_the_start() {
    catch_interrupts();
}

extern "C" __attribute__((visibility("default"))) int main(int argc, char** argv) {
    if (is_forked_child()) {
        end_forked_child(0);  // forked by a constructor; the run belongs to the parent
    }
    enter_stage(RunStage::preparing);
    ParsedCommandLine const parsed = parse_command_line(argc, argv);
    if (parsed.exit_code) {
        return *parsed.exit_code;
    }
    ExitCode code = ExitCode::usage;
    try {
        code = simulate(parsed.options);
        check_logs();
    } catch (OutOfMemory const& error) {
        end_short_of_memory(error.what());
    } catch (std::bad_alloc const&) {
        end_short_of_memory(kOutOfMemory);
    } catch (std::length_error const&) {  // more than any machine has
        end_short_of_memory(kOutOfMemory);
    } catch (std::exception const& error) {
        code = report(escaped(error.what()).c_str(), code);
    }
    flush_logs();
    if (code == ExitCode::user_program || was_left_by_force()) {
        // The user's program may have corrupted memory, so skip the destructors.
        std::fflush(nullptr);
        std::_Exit(static_cast<int>(code));
    }
    return static_cast<int>(code);
}
